# SPDX-License-Identifier: BSD-3-Clause
"""vtkPrepareSurface and vtkRestoreSurface as a script meets them."""
import unittest

import numpy
from vtkcartan import (vtkHandleMotion, vtkPoissonDeformation, vtkPrepareSurface,
                       vtkRestoreSurface, vtkVolumeChange)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkFiltersSources import vtkCubeSource

import cartan_testing


def points_of(surface):
    return vtk_to_numpy(surface.GetPoints().GetData()).astype(float)


def soup(surface):
    """Each triangle with points of its own."""
    triangles = vtk_to_numpy(surface.GetPolys().GetConnectivityArray())
    return cartan_testing.surface(points_of(surface)[triangles],
                                  numpy.arange(len(triangles)).reshape(-1, 3))


def prepared(surface, **settings):
    prepare = vtkPrepareSurface()
    for name, value in settings.items():
        getattr(prepare, "Set" + name)(value)
    prepare.SetInputData(surface)
    prepare.Update()
    return prepare


def count(surface, name):
    return surface.GetFieldData().GetArray(name).GetValue(0)


def volume(surface):
    measure = vtkVolumeChange()
    measure.SetInputData(surface)
    measure.SetReferenceData(surface)
    measure.Update()
    table = measure.GetChangeTable()
    return next(table.GetValueByName(row, "Current").ToDouble()
                for row in range(table.GetNumberOfRows())
                if table.GetValueByName(row, "Quantity").ToString() == "Volume")


class PrepareSurface(unittest.TestCase):

    def test_a_cube_of_split_faces_is_closed(self):
        cube = vtkCubeSource()
        cube.Update()
        prepare = prepared(cube.GetOutput())
        self.assertEqual(prepare.GetOutput().GetNumberOfPoints(), 8)
        self.assertEqual(count(prepare.GetOutput(), "MergedPoints"), 16)
        self.assertIn("16 points merged", prepare.GetReport())
        self.assertAlmostEqual(volume(prepare.GetOutput()), 1.0)

    def test_a_scan_as_soup_is_the_scan_again(self):
        scan = cartan_testing.read_off("bunny00")
        output = prepared(soup(scan)).GetOutput()
        self.assertEqual(output.GetNumberOfPoints(), scan.GetNumberOfPoints())
        self.assertEqual(output.GetNumberOfCells(), scan.GetNumberOfCells())

    def test_soup_bends_without_cracks_and_comes_back_as_soup(self):
        bar = soup(cartan_testing.bar(2, 2, 12, 1.0, 1.0, 6.0))
        surface = prepared(bar).GetOutput()
        z = points_of(surface)[:, 2]
        handles = numpy_to_vtk(numpy.where(z < 0.6, 1, numpy.where(z > 5.4, 2, 0)).astype(
            numpy.int32), deep=True)
        handles.SetName("Handle")
        surface.GetPointData().AddArray(handles)
        motion = vtkHandleMotion()
        motion.SetAxis(1.0, 0.0, 0.0)
        motion.SetAngle(40.0)
        deform = vtkPoissonDeformation()
        deform.SetInputData(surface)
        deform.SetHandleMotion(2, motion)
        restore = vtkRestoreSurface()
        messages = []
        for event in (vtkCommand.ErrorEvent, vtkCommand.WarningEvent):
            restore.AddObserver(event, lambda *_: messages.append("said something"))
        restore.SetInputConnection(deform.GetOutputPort())
        restore.SetOriginalData(bar)
        restore.Update()
        self.assertEqual(messages, [])
        result = points_of(restore.GetOutput())
        self.assertEqual(len(result), bar.GetNumberOfPoints())
        _, place = numpy.unique(points_of(bar), axis=0, return_inverse=True)
        place = place.ravel()
        for p in range(place.max() + 1):
            self.assertEqual(numpy.ptp(result[place == p], axis=0).max(), 0.0)
        self.assertGreater(numpy.abs(result - points_of(bar)).max(), 1.0)

    def test_a_missing_patch_is_filled_on_request(self):
        bar = cartan_testing.bar(4, 4, 4, 1.0, 1.0, 1.0)
        triangles = vtk_to_numpy(bar.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        inner = numpy.flatnonzero((points_of(bar) == [0.5, 0.5, 1.0]).all(1))[0]
        open_bar = cartan_testing.surface(points_of(bar), triangles[(triangles != inner).all(1)])
        self.assertTrue(numpy.isnan(volume(prepared(open_bar).GetOutput())))
        closed = prepared(open_bar, MaximumHoleEdges=12).GetOutput()
        self.assertEqual(count(closed, "FilledHoles"), 1)
        self.assertAlmostEqual(volume(closed), 1.0)


if __name__ == "__main__":
    unittest.main()
