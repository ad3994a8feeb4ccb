# SPDX-License-Identifier: BSD-3-Clause
"""The accessor for PyVista, with a stand-in that has what the accessor uses of it."""
import sys
import types
import unittest

import numpy
import vtkcartan
from vtkmodules.util.numpy_support import vtk_to_numpy

import cartan_testing


class PolyData:
    """A surface: points, faces as PyVista packs them, and a copy."""

    def __init__(self, points, faces):
        self.points, self.faces = numpy.array(points), numpy.array(faces)

    @property
    def is_all_triangles(self):
        return bool((self.faces[::4] == 3).all())

    def copy(self):
        return PolyData(self.points, self.faces)


def stand_in():
    """PyVista's registration: an accessor is made at its first use and kept with the mesh."""
    pyvista = types.ModuleType("pyvista")
    pyvista.PolyData = PolyData

    def register_dataset_accessor(name, target):
        def register(accessor):
            def get(mesh):
                return mesh.__dict__.setdefault("_" + name, accessor(mesh))
            setattr(target, name, property(get))
            return accessor
        return register

    pyvista.register_dataset_accessor = register_dataset_accessor
    return pyvista


class Accessor(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        sys.modules["pyvista"] = None  # not installed
        import vtkcartan.accessor
        assert not vtkcartan.accessor.register()
        sys.modules["pyvista"] = types.ModuleType("pyvista")  # one without accessors
        assert not vtkcartan.accessor.register()
        sys.modules["pyvista"] = stand_in()
        assert vtkcartan.accessor.register()

    def setUp(self):
        bar = cartan_testing.bar(20, 4, 4, 5.0, 1.0, 1.0)
        self.triangles = vtk_to_numpy(bar.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        faces = numpy.hstack([numpy.full((len(self.triangles), 1), 3), self.triangles]).ravel()
        self.mesh = PolyData(vtk_to_numpy(bar.GetPoints().GetData()), faces)
        x = self.mesh.points[:, 0]
        self.handles = {1: numpy.flatnonzero(x > 4.4), 2: numpy.flatnonzero(x < 0.6)}
        self.motion = vtkcartan.vtkHandleMotion()
        self.motion.SetAngle(30)

    def factorizations(self):
        return self.mesh.cartan._deformer.filter.GetNumberOfFactorizations()

    def test_deforms_a_copy(self):
        before = self.mesh.points.copy()
        for method in ("ShapePreserving", "Pyramid"):
            bent = self.mesh.cartan.deform(self.handles, {1: self.motion}, method=method)
            expected = vtkcartan.deform(before, self.triangles, self.handles, {1: self.motion},
                                        method=method)
            self.assertTrue((bent.points == expected).all(), method)
        self.assertTrue((self.mesh.points == before).all())
        self.assertIsInstance(bent, PolyData)

    def test_keeps_its_filter(self):
        self.mesh.cartan.deform(self.handles, {1: self.motion})
        deformer, count = self.mesh.cartan._deformer, self.factorizations()
        self.motion.SetAngle(60)
        self.mesh.cartan.deform(self.handles, {1: self.motion})
        self.assertIs(self.mesh.cartan._deformer, deformer)
        self.assertEqual(self.factorizations(), count)

    def test_sees_what_changes(self):
        first = self.mesh.cartan.deform(self.handles, {1: self.motion}).points
        self.mesh.points[:, 2] *= 2  # in place
        second = self.mesh.cartan.deform(self.handles, {1: self.motion}).points
        self.assertTrue((second == vtkcartan.deform(
            self.mesh.points, self.triangles, self.handles, {1: self.motion})).all())
        self.assertFalse((first == second).all())
        self.handles[2] = self.handles[2][:5]
        third = self.mesh.cartan.deform(self.handles, {1: self.motion}).points
        self.assertFalse((third == second).all())
        fourth = self.mesh.cartan.deform(self.handles, {1: self.motion}, CloseVolume=True).points
        self.assertFalse((third == fourth).all())

    def test_morphs_and_measures(self):
        other = self.mesh.copy()
        other.points = other.points + [1.0, 0, 0]
        half = self.mesh.cartan.morph(other, 0.5)
        self.assertLess(abs(half.points - self.mesh.points - [0.5, 0, 0]).max(), 1e-9)
        self.assertLess(half.cartan.measure(self.mesh).totals["EdgeLengthMax"], 1e-9)

    def test_refuses_other_cells(self):
        quad = PolyData([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [4, 0, 1, 2, 3])
        with self.assertRaises(ValueError) as raised:
            quad.cartan.deform({1: [0]})
        self.assertIn("triangulate", str(raised.exception))


if __name__ == "__main__":
    unittest.main()
