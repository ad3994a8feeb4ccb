# SPDX-License-Identifier: BSD-3-Clause
"""deform(), morph() and measure() for arrays of numpy: laws, and the refusals of bad input."""
import ast
import inspect
import math
import pathlib
import unittest
import warnings

import numpy
import vtkcartan
import vtkcartan.accessor
from vtkcartan import deform, measure, morph, vtkHandleMotion, vtkMarkHandle
from vtkmodules.util.numpy_support import vtk_to_numpy

import cartan_testing


def bar():
    """Points and triangles of a bar along x, and its two ends as handles."""
    surface = cartan_testing.bar(20, 4, 4, 5.0, 1.0, 1.0)
    points = vtk_to_numpy(surface.GetPoints().GetData()).copy()
    triangles = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3).copy()
    return points, triangles, {1: numpy.flatnonzero(points[:, 0] > 4.4), 2: points[:, 0] < 0.6}


def rigid(degrees, translation=(0, 0, 0)):
    """A turn about y, then a translation, as a 4 x 4 matrix."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    matrix = numpy.eye(4)
    matrix[:3, :3] = [[c, 0, s], [0, 1, 0], [-s, 0, c]]
    matrix[:3, 3] = translation
    return matrix


def apply(matrix, points):
    return points @ matrix[:3, :3].T + matrix[:3, 3]


class Deform(unittest.TestCase):
    def setUp(self):
        self.points, self.triangles, self.handles = bar()

    def test_every_method_takes_the_surface_with_a_common_motion(self):
        matrix = rigid(40, (1, 2, 3))
        expected = apply(matrix, self.points)
        for method in ("ShapePreserving", "RotationInvariant", "Similarity", "AsRigidAsPossible",
                       "Pyramid", "Laplacian", "Poisson", "Multiresolution"):
            moved = deform(self.points, self.triangles, self.handles, {1: matrix, 2: matrix},
                           method=method)
            self.assertLess(abs(moved - expected).max(), 1e-9, method)

    def test_thirty_landmarks_in_two_lines(self):
        landmarks = numpy.arange(0, 360, 12)[:30] % len(self.points)
        targets = apply(rigid(25), self.points[landmarks])
        moved = deform(self.points, self.triangles, {1: landmarks}, targets={1: targets},
                       method="AsRigidAsPossible")
        self.assertLess(abs(moved[landmarks] - targets).max(), 1e-12)
        # Landmarks that turn together take the surface with them.
        self.assertLess(abs(moved - apply(rigid(25), self.points)).max(), 1e-3)
        for method, properties in (("Similarity", {"ConstrainHandleTransforms": False}),
                                   ("Pyramid", {})):
            moved = deform(self.points, self.triangles, {1: landmarks}, targets={1: targets},
                           method=method, **properties)
            self.assertLess(abs(moved - apply(rigid(25), self.points)).max(), 1e-9, method)

    def test_targets_keep_the_order_of_the_ids(self):
        ids = numpy.array([7, 3, 300])
        targets = self.points[ids] + [[0, 0, .1], [0, .1, 0], [.1, 0, 0]]
        moved = deform(self.points, self.triangles, {5: ids}, targets={5: targets},
                       method="AsRigidAsPossible")
        self.assertLess(abs(moved[ids] - targets).max(), 1e-12)

    def test_ways_to_say_the_same(self):
        motion = vtkHandleMotion()
        motion.SetAxis(0, 1, 0)
        motion.SetAngle(30)
        by_motion = deform(self.points, self.triangles, self.handles, {1: motion})
        array = numpy.zeros(len(self.points), int)
        array[self.handles[1]] = 1
        array[self.handles[2]] = 2
        others = [
            deform(self.points, self.triangles, self.handles, motions={1: rigid(30)}),
            deform(self.points.tolist(), self.triangles.tolist(), array, {1: motion}),
            deform(self.points, self.triangles.astype("int32"), self.handles, {1: motion})]
        for other in others:
            self.assertLess(abs(other - by_motion).max(), 1e-9)
        by_filter = self.with_a_pipeline(motion)
        self.assertEqual(abs(by_motion - by_filter).max(), 0)

    def with_a_pipeline(self, motion):
        """The same without this layer."""
        surface = cartan_testing.surface(self.points, self.triangles)
        for handle, ids in ((1, self.handles[1]), (2, numpy.flatnonzero(self.handles[2]))):
            marking = vtkMarkHandle()
            marking.SetHandleId(handle)
            for i, point in enumerate(ids):
                marking.SetPointId(i, int(point))
            marking.SetInputData(surface)
            marking.Update()
            surface = marking.GetOutput()
        algorithm = vtkcartan.vtkShapePreservingDeformation()
        algorithm.SetInputData(surface)
        algorithm.SetHandleMotion(1, motion)
        algorithm.Update()
        return vtk_to_numpy(algorithm.GetOutput().GetPoints().GetData())

    def test_precision_and_input_stay(self):
        single = self.points.astype("float32")
        before = single.copy()
        moved = deform(single, self.triangles, self.handles, {1: rigid(30)})
        self.assertEqual(moved.dtype, numpy.float32)
        self.assertTrue((single == before).all())
        self.assertEqual(deform(self.points, self.triangles, self.handles).dtype, numpy.float64)

    def test_properties(self):
        results = [deform(self.points, self.triangles, self.handles, {1: rigid(60)}, **properties)
                   for properties in ({}, {"VolumeCorrection": "None"}, {"VolumeCorrection": 0},
                                      {"LaplacianWeights": "Uniform", "CloseVolume": True})]
        self.assertTrue((results[1] == results[2]).all())
        self.assertFalse((results[0] == results[1]).all())
        self.assertFalse((results[0] == results[3]).all())

    def test_a_deformer_factorizes_once(self):
        deformer = vtkcartan.Deformer(self.points, self.triangles, self.handles)
        first = deformer({1: rigid(10)})
        count = deformer.filter.GetNumberOfFactorizations()
        second = deformer({1: rigid(20)})
        self.assertEqual(deformer.filter.GetNumberOfFactorizations(), count)
        self.assertTrue((deformer({1: rigid(10)}) == first).all())
        self.assertFalse((second == first).all())
        self.assertTrue((deformer() == self.points).all())

    def refused(self, *words, points=None, triangles=None, handles=None, **rest):
        with self.assertRaises(ValueError) as raised:
            deform(self.points if points is None else points,
                   self.triangles if triangles is None else triangles,
                   self.handles if handles is None else handles, **rest)
        for word in words:
            self.assertIn(word, str(raised.exception))
        return str(raised.exception)

    def test_refuses_with_the_filters_own_text(self):
        bad = self.points.copy()
        bad[17, 1] = numpy.nan
        text = self.refused("NaN or infinite", "id 17", points=bad, motions={1: rigid(5)})
        self.assertNotIn("ERROR", text)
        self.assertNotIn("0x", text)
        self.refused("Handle 9 has a motion", "1, 2", motions={9: rigid(5)})
        wrong = rigid(5)
        wrong[3, 0] = 1
        self.refused("0 0 0 1", motions={1: wrong})
        fin = numpy.vstack([self.triangles, [self.triangles[0, 0], self.triangles[0, 1], 300]])
        self.refused("edge", triangles=fin, motions={1: rigid(5)})

    def test_refuses_what_no_filter_sees(self):
        self.refused("n x 3", points=self.points[:, :2])
        self.refused("m x 3", triangles=self.triangles.ravel())
        self.refused("point ids", triangles=self.triangles * 0.5)
        self.refused("name no point", triangles=self.triangles + 10)
        self.refused("do not exist", handles={1: [5, 100000]})
        self.refused("do not exist", handles={1: [-1]})
        self.refused("another handle", handles={1: [5, 6], 2: [6]})
        self.refused(">= 1", handles={0: [5]})
        self.refused("point ids", handles={1: [0.5]})
        self.refused("handles has the shape", handles=[1, 2, 3])
        self.refused("a motion and targets", motions={1: rigid(5)}, targets={1: self.points})
        self.refused("targets", targets={1: self.points[:2]})
        self.refused("no points", targets={7: self.points[:2]})
        self.refused("4 x 4", motions={1: numpy.eye(3)})
        self.refused("There is no method", "ShapePreserving", method="Magic")
        self.refused("has no property", "LaplacianWeights", LaplacianWeight="Uniform")
        self.refused("one of", "Cotangent", LaplacianWeights="Fancy")
        self.refused("cannot be", CloseVolume="off")
        self.refused("cannot be", HandleArrayName=3)

    def test_warnings_are_pythons(self):
        points = numpy.vstack([self.points, self.points[:1]])
        triangles = numpy.vstack([self.triangles, [0, 0, 1]])
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            deform(points, triangles, self.handles, {1: rigid(5)})
        self.assertEqual(len(caught), 1, [str(warning.message) for warning in caught])
        self.assertIn("twice", str(caught[0].message))
        self.assertEqual(caught[0].filename, __file__)


class MorphAndMeasure(unittest.TestCase):
    def setUp(self):
        self.points, self.triangles, _ = bar()
        self.turned = apply(rigid(120), self.points)

    def test_a_rigid_motion_stays_rigid(self):
        half = morph([self.points, self.turned], self.triangles, 0.5)
        changes = measure(half, self.triangles, self.points)
        for name in ("RelativeVolumeChange", "EdgeLengthMax", "ShapeDistance"):
            self.assertLess(abs(changes.totals[name]), 1e-6, name)
        linear = morph([self.points, self.turned], self.triangles, 0.5, method="Linear")
        self.assertLess(abs(linear - (self.points + self.turned) / 2).max(), 1e-12)

    def test_many_parameters(self):
        frames = morph([self.points, self.turned], self.triangles, [0, 0.25, 1])
        self.assertEqual(frames.shape, (3,) + self.points.shape)
        self.assertTrue((frames[0] == self.points).all() and (frames[2] == self.turned).all())

    def test_measures_of_a_scaled_bar(self):
        found = measure(2 * self.points, self.triangles, self.points)
        self.assertAlmostEqual(found.totals["RelativeVolumeChange"], 7, 9)
        self.assertAlmostEqual(found.totals["RelativeAreaChange"], 3, 9)
        self.assertAlmostEqual(found.totals["EdgeLengthRMS"], 1, 9)
        self.assertLess(abs(found.point_data["EdgeLengthRatio"] - 2).max(), 1e-9)
        self.assertIn("MeanCurvatureError", found.point_data)

    def test_refusals(self):
        for arguments in (([self.points], self.triangles, 0.5),
                          ([self.points, self.points[1:]], self.triangles[:5], 0.5)):
            with self.assertRaises(ValueError) as raised:
                morph(*arguments)
            self.assertIn("key frame", str(raised.exception))
        with self.assertRaises(ValueError) as raised:
            morph([self.points, self.turned], self.triangles, 0.5, method="Magic")
        self.assertIn("DiscreteForms", str(raised.exception))
        with self.assertRaises(ValueError):
            measure(self.points, self.triangles, self.points[:, :2])


class Stubs(unittest.TestCase):
    """The stubs declare what there is, with the parameters that it has."""

    def test_stubs_agree(self):
        package = pathlib.Path(vtkcartan.__file__).parent
        self.assertTrue((package / "py.typed").exists())
        for module in (vtkcartan.arrays, vtkcartan.accessor):
            stub = pathlib.Path(module.__file__).with_suffix(".pyi").read_text(encoding="utf-8")
            tree = ast.parse(stub)
            declared = {node.name: node for node in tree.body
                        if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
            public = {name for name, value in vars(module).items()
                      if getattr(value, "__module__", "") == module.__name__ and name[0] != "_"}
            self.assertEqual(set(declared), public)
            for name, node in declared.items():
                functions = ([node] if isinstance(node, ast.FunctionDef) else
                             [n for n in node.body if isinstance(n, ast.FunctionDef)])
                for function in functions:
                    owner = getattr(module, name)
                    real = owner if function is node else getattr(owner, function.name)
                    arguments = [argument.arg for argument in function.args.args]
                    arguments += [function.args.kwarg.arg] if function.args.kwarg else []
                    self.assertEqual(arguments, list(inspect.signature(real).parameters))


if __name__ == "__main__":
    unittest.main()
