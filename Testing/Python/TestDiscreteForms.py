# SPDX-License-Identifier: BSD-3-Clause
"""vtkDiscreteForms and vtkFrameReconstruction as a script meets them."""
import os
import unittest

import numpy
from vtkcartan import vtkDiscreteForms, vtkFrameReconstruction
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkIOXML import vtkXMLTableReader, vtkXMLTableWriter

import cartan_testing


def points_of(surface):
    return vtk_to_numpy(surface.GetPoints().GetData()).astype(float)


def triangles_of(surface):
    return vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def moved(surface, points):
    return cartan_testing.surface(points, triangles_of(surface))


def random_rotation(seed):
    rotation, _ = numpy.linalg.qr(numpy.random.RandomState(seed).normal(size=(3, 3)))
    return rotation * numpy.linalg.det(rotation)


def columns(table):
    return {table.GetColumnName(c): vtk_to_numpy(table.GetColumn(c))
            for c in range(table.GetNumberOfColumns())}


def forms(surface):
    filter = vtkDiscreteForms()
    filter.SetInputData(surface)
    filter.Update()
    return filter


def distance_up_to_rigid_motion(points, expected):
    """The largest distance after the best rigid motion, over the bounding diagonal."""
    a = points - points.mean(0)
    b = expected - expected.mean(0)
    u, _, vt = numpy.linalg.svd(a.T @ b)
    turn = u @ numpy.diag([1, 1, numpy.linalg.det(u @ vt)]) @ vt
    return numpy.linalg.norm(a @ turn - b, axis=1).max() / numpy.linalg.norm(numpy.ptp(b, axis=0))


class Forms(unittest.TestCase):
    def test_a_rigid_motion_changes_nothing(self):
        elephant = cartan_testing.read_off("elephant")
        before = columns(forms(elephant).GetFormsTable())
        turned = points_of(elephant) @ random_rotation(1).T + [3, -1, 2]
        after = columns(forms(moved(elephant, turned)).GetFormsTable())
        self.assertEqual(list(before),
                         ["Vertex", "Neighbor", "Length", "Angle", "Height", "Orientation"])
        for name in ("Vertex", "Neighbor", "Orientation"):
            numpy.testing.assert_array_equal(before[name], after[name])
        for name in ("Length", "Height"):
            numpy.testing.assert_allclose(before[name], after[name], rtol=0, atol=1e-12)
        turn = numpy.angle(numpy.exp(1j * (before["Angle"] - after["Angle"])))
        self.assertLess(numpy.nanmax(abs(turn)), 1e-9)

    def test_lengths_and_heights_are_those_of_the_edges(self):
        surface = forms(cartan_testing.read_off("elephant"))
        table = columns(surface.GetFormsTable())
        points = points_of(surface.GetOutput())
        edges = points[table["Neighbor"]] - points[table["Vertex"]]
        numpy.testing.assert_allclose(table["Length"]**2 + table["Height"]**2,
                                      (edges**2).sum(1), rtol=1e-12)
        normals = vtk_to_numpy(surface.GetOutput().GetPointData().GetArray("FrameNormal"))
        numpy.testing.assert_allclose(table["Height"], (edges * normals[table["Vertex"]]).sum(1),
                                      rtol=0, atol=1e-14)

    def test_the_table_on_disk_is_the_surface(self):
        elephant = cartan_testing.read_off("elephant")
        path = cartan_testing.output_path("TestDiscreteForms.vtt")
        source = forms(elephant)
        writer = vtkXMLTableWriter()
        writer.SetInputConnection(source.GetOutputPort(1))
        writer.SetFileName(path)
        # Text would round, and VTK 9.2 cannot read a large table in appended mode.
        writer.SetDataModeToBinary()
        writer.Write()
        reader = vtkXMLTableReader()
        reader.SetFileName(path)
        rebuild = vtkFrameReconstruction()
        noise = numpy.random.RandomState(2).normal(size=(elephant.GetNumberOfPoints(), 3))
        rebuild.SetInputData(moved(elephant, noise))
        rebuild.SetFormsConnection(reader.GetOutputPort())
        rebuild.Update()
        error = distance_up_to_rigid_motion(points_of(rebuild.GetOutput()), points_of(elephant))
        self.assertLess(error, 1e-9)
        os.remove(path)

    def test_the_seed_is_where_it_is_asked(self):
        bar = cartan_testing.bar(2, 2, 6, 1, 1, 3)
        surface = forms(bar)
        rebuild = vtkFrameReconstruction()
        rebuild.SetInputData(moved(bar, numpy.zeros((bar.GetNumberOfPoints(), 3))))
        rebuild.SetFormsData(surface.GetFormsTable())
        arrays = surface.GetOutput().GetPointData()
        rebuild.SetSeedPoint(9)
        rebuild.SetSeedPosition(bar.GetPoint(9))
        rebuild.SetSeedFrame(sum((arrays.GetArray(name).GetTuple(9) for name in
                                  ("FrameTangent1", "FrameTangent2", "FrameNormal")), ()))
        for name in ("OrientationBits", "Procrustes"):
            getattr(rebuild, "SetTransitionMethodTo" + name)()
            rebuild.Update()
            numpy.testing.assert_allclose(points_of(rebuild.GetOutput()), points_of(bar),
                                          rtol=0, atol=1e-12)

    def test_an_error_says_what_is_wrong(self):
        messages = []

        def note(caller, event, text):
            messages.append(text)
        note.CallDataType = "string0"
        surface = cartan_testing.surface(numpy.full((3, 3), numpy.nan), [[0, 1, 2]])
        filter = vtkDiscreteForms()
        filter.AddObserver(vtkCommand.ErrorEvent, note)
        filter.GetExecutive().AddObserver(vtkCommand.ErrorEvent, lambda *_: None)
        filter.SetInputData(surface)
        filter.Update()
        self.assertEqual(len(messages), 1)
        self.assertIn("3 points (ids 0, 1, 2) with a NaN", messages[0])
        self.assertEqual(filter.GetOutput().GetNumberOfPoints(), 0)
        self.assertEqual(filter.GetFormsTable().GetNumberOfRows(), 0)


if __name__ == "__main__":
    unittest.main()
