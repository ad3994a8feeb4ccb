# SPDX-License-Identifier: BSD-3-Clause
"""The deformation methods beside the frame-based ones, as a script meets them."""
import math
import unittest

import numpy
from vtkcartan import (vtkAsRigidAsPossibleDeformation, vtkHandleMotion, vtkLaplacianDeformation,
                    vtkMultiresolutionDeformation, vtkPoissonDeformation,
                    vtkSimilarityDeformation)
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_STRING

import cartan_testing

METHODS = (vtkAsRigidAsPossibleDeformation, vtkLaplacianDeformation,
           vtkMultiresolutionDeformation, vtkPoissonDeformation, vtkSimilarityDeformation)

# Every value of what decides how a method works, by the setters of the enumerations.
CHOICES = {
    vtkAsRigidAsPossibleDeformation: ("Energy", ("Spokes", "SpokesAndRims",
                                                 "SmoothedRotations")),
    vtkLaplacianDeformation: ("Rotations", ("None", "Estimated", "Implicit")),
    vtkPoissonDeformation: ("Propagation", ("Harmonic", "Geodesic")),
    vtkSimilarityDeformation: ("Reconstruction", ("Affine", "LeastSquares", "EdgeForm")),
}


def variants(method):
    """The filter with each value of its enumeration, or of its smoothness."""
    if method is vtkMultiresolutionDeformation:
        for smoothness in (1, 2, 3):
            deformation = method()
            deformation.SetSmoothness(smoothness)
            yield "smoothness %d" % smoothness, deformation
        return
    name, values = CHOICES[method]
    for value in values:
        deformation = method()
        getattr(deformation, "Set%sTo%s" % (name, value))()
        yield value, deformation


def marked_bar(scale=1.0):
    """A bar of 1 x 1 x 5 with uneven sides; its ends are handles 1 and 2."""
    bar = cartan_testing.bar(4, 4, 20, 1, 1, 5)
    points = points_of(bar)
    points += .05 * numpy.sin(5 * points[:, [1, 2, 0]])
    height = points[:, 2]
    ids = numpy.where(height < .8, 1, numpy.where(height > 4.2, 2, 0)).astype(numpy.int32)
    handle = numpy_to_vtk(ids, deep=True)
    handle.SetName("Handle")
    bar.GetPointData().AddArray(handle)
    points *= scale
    return bar


def points_of(surface):
    return vtk_to_numpy(surface.GetPoints().GetData())


def array(surface, name):
    return vtk_to_numpy(surface.GetPointData().GetArray(name))


def motion(degrees=0.0, translation=(0, 0, 0), scale=1.0, axis=(1, 2, 3)):
    result = vtkHandleMotion()
    result.SetScale(scale, scale, scale)
    result.SetAxis(*axis)
    result.SetAngle(degrees)
    result.SetTranslation(*translation)
    return result


def moved(points, degrees=0.0, translation=(0, 0, 0), scale=1.0, axis=(1, 2, 3)):
    """What such a motion makes of points, by Rodrigues' formula."""
    unit = numpy.array(axis) / numpy.linalg.norm(axis)
    angle = math.radians(degrees)
    along = numpy.outer(points @ unit, unit)
    turned = (along + math.cos(angle) * (points - along)
              + math.sin(angle) * numpy.cross(unit, points))
    return scale * turned + translation


def errors_of(deformation):
    """Updates the filter; its errors, which are not printed then."""
    texts = []

    @calldata_type(VTK_STRING)
    def collect(_caller, _event, text):
        texts.append(text)

    deformation.AddObserver("ErrorEvent", collect)
    # The executive reports on its own that the algorithm has failed.
    deformation.GetExecutive().AddObserver("ErrorEvent", lambda *_: None)
    deformation.Update()
    return texts


class EveryMethod(unittest.TestCase):
    def each(self):
        for method in METHODS:
            for name, deformation in variants(method):
                with self.subTest(method=method.__name__, variant=name):
                    yield name, deformation

    def test_follows_a_rigid_motion_of_all_handles(self):
        bar = marked_bar()
        for name, deformation in self.each():
            # Differential coordinates without exact rotations follow translations.
            degrees = 0 if isinstance(deformation, vtkLaplacianDeformation) else 40
            where = {"degrees": degrees, "translation": (1, -2, .5)}
            deformation.SetInputData(bar)
            for handle in (1, 2):
                deformation.SetHandleMotion(handle, motion(**where))
            deformation.Update()
            numpy.testing.assert_allclose(points_of(deformation.GetOutput()),
                                          moved(points_of(bar), **where), atol=1e-9)

    def test_does_not_depend_on_the_unit_of_length(self):
        for name, deformation in self.each():
            results = []
            for unit in (1, 1e-3, 1e3):
                deformation.SetInputData(marked_bar(unit))
                deformation.SetHandleMotion(2, motion(30, (.5 * unit, unit, 0)))
                deformation.Update()
                results.append(points_of(deformation.GetOutput()) / unit)
            numpy.testing.assert_allclose(results[1], results[0], atol=1e-8)
            numpy.testing.assert_allclose(results[2], results[0], atol=1e-8)

    def test_holds_the_handles_and_factorizes_once_for_all_motions(self):
        bar = marked_bar()
        rest, handle = points_of(bar), array(bar, "Handle")
        for name, deformation in self.each():
            deformation.SetInputData(bar)
            counts = []
            for degrees in (10, 35):
                where = {"degrees": degrees, "translation": (0, 1, 0), "axis": (0, 1, 0)}
                deformation.SetHandleMotion(2, motion(**where))
                deformation.Update()
                result = points_of(deformation.GetOutput())
                self.assertTrue(numpy.isfinite(result).all())
                numpy.testing.assert_allclose(result[handle == 1], rest[handle == 1], atol=1e-12)
                numpy.testing.assert_allclose(
                    result[handle == 2], moved(rest, **where)[handle == 2], atol=1e-12)
                counts.append(deformation.GetNumberOfFactorizations())
            self.assertGreater(counts[0], 0)
            self.assertEqual(counts[1], counts[0])

    def test_refuses_bad_input_with_one_error(self):
        for name, deformation in self.each():
            bar = marked_bar()
            deformation.SetInputData(bar)
            deformation.SetHandleMotion(7, motion(10))
            texts = errors_of(deformation)
            self.assertEqual(len(texts), 1, texts)
            self.assertIn("7", texts[0])
            self.assertEqual(deformation.GetOutput().GetNumberOfPoints(), 0)
            # A mistake can be mended.
            deformation.RemoveHandleMotion(7)
            deformation.SetHandleMotion(2, motion(10))
            deformation.Update()
            self.assertEqual(deformation.GetOutput().GetNumberOfPoints(),
                             bar.GetNumberOfPoints())

            points_of(bar)[5, 1] = math.nan
            bar.GetPoints().Modified()
            bar.Modified()
            texts.clear()
            deformation.Update()
            self.assertEqual(len(texts), 1, texts)
            self.assertIn("5", texts[0])


class Methods(unittest.TestCase):
    def test_similarity_scales_features_along(self):
        bar = marked_bar()
        where = {"degrees": 70, "translation": (1, 2, 3), "scale": 1.7}
        for name, deformation in variants(vtkSimilarityDeformation):
            with self.subTest(reconstruction=name):
                deformation.SetInputData(bar)
                deformation.ScaleFeaturesOn()
                deformation.GenerateScaleFactorOn()
                for handle in (1, 2):
                    deformation.SetHandleMotion(handle, motion(**where))
                deformation.Update()
                numpy.testing.assert_allclose(points_of(deformation.GetOutput()),
                                              moved(points_of(bar), **where), atol=1e-9)
                numpy.testing.assert_allclose(array(deformation.GetOutput(), "ScaleFactor"), 1.7,
                                              atol=1e-9)

    def test_refits_bring_similarity_toward_as_rigid_as_possible(self):
        bar = marked_bar()
        rigid = vtkAsRigidAsPossibleDeformation()
        rigid.SetInitialGuessToRestShape()
        rigid.SetMaximumIterations(3000)
        rigid.SetTolerance(1e-9)
        similarity = vtkSimilarityDeformation()
        for deformation in (rigid, similarity):
            deformation.SetInputData(bar)
            deformation.SetHandleMotion(2, motion(translation=(2, 0, 0)))
        rigid.Update()
        self.assertTrue(rigid.GetConverged())
        distances = []
        for refits in (0, 1, 3):
            similarity.SetRefits(refits)
            similarity.Update()
            distances.append(numpy.linalg.norm(
                points_of(similarity.GetOutput()) - points_of(rigid.GetOutput())))
        self.assertEqual(distances, sorted(distances, reverse=True))
        self.assertLess(distances[-1], .4 * distances[0])

    def test_as_rigid_as_possible_lowers_its_energy(self):
        bar = marked_bar()
        for name, deformation in variants(vtkAsRigidAsPossibleDeformation):
            with self.subTest(energy=name):
                deformation.SetInputData(bar)
                deformation.SetHandleMotion(2, motion(60, (0, 1, 0)))
                deformation.GenerateRigidityEnergyOn()
                finals = []
                for iterations in (0, 5, 50):
                    deformation.SetMaximumIterations(iterations)
                    deformation.Update()
                    finals.append(deformation.GetFinalEnergy())
                    if iterations == 0:
                        self.assertEqual(finals[0], deformation.GetInitialEnergy())
                    self.assertLessEqual(deformation.GetNumberOfIterations(), iterations)
                    self.assertAlmostEqual(
                        array(deformation.GetOutput(), "RigidityEnergy").sum(), finals[-1],
                        delta=1e-9 * finals[-1])
                self.assertGreater(finals[0], finals[1])
                self.assertGreaterEqual(finals[1], finals[2])

    def test_every_initial_guess_ends_at_the_same_surface(self):
        bar = marked_bar()
        results = []
        for guess in ("RestShape", "RotationInvariant", "ShapePreserving", "PreviousResult"):
            deformation = vtkAsRigidAsPossibleDeformation()
            getattr(deformation, "SetInitialGuessTo" + guess)()
            deformation.SetMaximumIterations(3000)
            deformation.SetTolerance(1e-12)
            deformation.SetInputData(bar)
            deformation.SetHandleMotion(2, motion(30))
            deformation.Update()
            results.append(points_of(deformation.GetOutput()).copy())
        for result in results[1:]:
            numpy.testing.assert_allclose(result, results[0], atol=1e-3)

    def test_poisson_keeps_laps(self):
        bar = marked_bar()
        deformation = vtkPoissonDeformation()
        deformation.SetInputData(bar)
        deformation.SetHandleMotion(2, motion(360, axis=(0, 0, 1)))
        deformation.GenerateFrameChangeOn()
        deformation.Update()
        # Half way between the ends the surface has turned by half a turn, where
        # the change of a frame, |R - I|, is as large as it can be.
        change = array(deformation.GetOutput(), "FrameChange")
        self.assertAlmostEqual(change.max(), math.sqrt(8), places=1)
        self.assertLess(change[array(bar, "Handle") > 0].max(), 1e-9)

    def test_enumerations_have_setters_of_their_own(self):
        for method, (name, values) in CHOICES.items():
            with self.subTest(method=method.__name__):
                chosen = [getattr(deformation, "Get" + name)()
                          for _, deformation in variants(method)]
                self.assertEqual(chosen, list(range(len(values))))


if __name__ == "__main__":
    unittest.main()
