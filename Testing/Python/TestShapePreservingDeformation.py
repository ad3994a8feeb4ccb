# SPDX-License-Identifier: BSD-3-Clause
"""vtkShapePreservingDeformation as a script meets it, and Table I of its paper."""
import math
import os
import sys
import unittest

import numpy
from vtkcartan import (vtkHandleMotion, vtkMarkHandle, vtkRotationInvariantDeformation,
                    vtkShapePreservingDeformation, vtkVolumeChange)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPlane

import cartan_testing

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)),
                                "..", "..", "Utilities", "demo"))
import tableone


def turn(degrees, axis=(0, 1, 0)):
    motion = vtkHandleMotion()
    motion.SetAxis(*axis)
    motion.SetAngle(degrees)
    return motion


def small_bar():
    return tableone.mark_ends(cartan_testing.bar(4, 4, 20, 1, 1, 5), 2, .16, .84)


def array(surface, name):
    return vtk_to_numpy(surface.GetPointData().GetArray(name))


class TableOne(unittest.TestCase):
    # What a reference implementation of the neutral offset left over.
    OFFSET = {"bar": (.006, .022, .058, .083), "armadillo": (.0078, .018, .043, .066)}

    def test_reproduces_the_published_changes_of_volume(self):
        rows = list(tableone.rows())
        self.assertEqual(len(rows), 8)
        for i, row in enumerate(rows):
            with self.subTest(model=row["model"], angle=row["angle"]):
                if row["model"] == "bar":
                    self.assertAlmostEqual(-row["none"], row["paper none"],
                                           delta=.15 * row["paper none"])
                elif row["angle"] <= 1:
                    self.assertLessEqual(abs(row["scaling"]), row["paper corrected"])
                self.assertLessEqual(abs(row["offset"]), 1.15 * self.OFFSET[row["model"]][i % 4])
                self.assertLessEqual(abs(row["closed"]), 1e-6)
                self.assertLess(abs(row["offset"]), abs(row["none"]))


class FromAScript(unittest.TestCase):
    def test_deforms_what_mark_handle_marks(self):
        bar = cartan_testing.bar(4, 4, 20, 1, 1, 5)
        source = bar
        filters = []
        for handle, height, normal in ((1, .8, 1), (2, 4.2, -1)):
            plane = vtkPlane()
            plane.SetOrigin(0, 0, height)
            plane.SetNormal(0, 0, normal)
            mark = vtkMarkHandle()
            mark.SetHandleId(handle)
            mark.SetRegion(plane)
            if filters:
                mark.SetInputConnection(filters[-1].GetOutputPort())
            else:
                mark.SetInputData(source)
            filters.append(mark)
        bend = vtkShapePreservingDeformation()
        bend.SetInputConnection(filters[-1].GetOutputPort())
        bend.SetHandleMotion(2, turn(480, (0, 0, 1)))
        bend.GenerateRotationVectorOn()
        bend.GenerateShapeDistanceOn()
        bend.Update()
        self.assertTrue(bend.GetSharedAxis())
        self.assertTrue(bend.GetConverged())
        self.assertEqual(bend.GetNumberOfFactorizations(), 1)
        self.assertGreater(
            bend.GetOutput().GetFieldData().GetArray("ShapeDistance").GetValue(0), 1)
        # The far end has turned by a full turn and a third, which is a third.
        top = tableone.points_of(bar)[:, 2] > 4.2
        numpy.testing.assert_allclose(array(bend.GetOutput(), "RotationVector")[top],
                                      [[0, 0, 2 * math.pi / 3]] * top.sum(), atol=1e-12)

    def test_rotation_vectors_of_points_are_those_of_a_motion(self):
        bar = small_bar()
        bend = vtkShapePreservingDeformation()
        bend.SetInputData(bar)
        bend.SetHandleMotion(2, turn(480))
        bend.ConstrainHandlePositionsOff()
        bend.Update()
        expected = tableone.points_of(bend.GetOutput())

        vectors = numpy.zeros((bar.GetNumberOfPoints(), 3))
        vectors[array(bar, "Handle") == 2, 1] = math.radians(480)
        turns = numpy_to_vtk(vectors, deep=True)
        turns.SetName("Turns")
        bar.GetPointData().AddArray(turns)
        bend.RemoveHandleMotion(2)
        bend.SetRotationVectorArrayName("Turns")
        bend.Update()
        self.assertTrue(bend.GetSharedAxis())
        numpy.testing.assert_allclose(tableone.points_of(bend.GetOutput()), expected, atol=1e-10)

    def test_local_volumes_and_the_measuring_filter_agree_with_the_volume(self):
        bar = small_bar()
        bend = vtkRotationInvariantDeformation()
        bend.SetInputData(bar)
        bend.SetHandleMotion(2, turn(100))
        bend.SetVolumeCorrectionToNeutralOffset()
        bend.CloseVolumeOn()
        bend.GenerateVolumeArraysOn()
        bend.Update()
        self.assertAlmostEqual(array(bend.GetOutput(), "LocalVolume").sum(), 5, places=9)
        change = vtkVolumeChange()
        change.SetInputData(0, bend.GetOutput())
        change.SetInputData(1, bar)
        change.Update()
        table = change.GetOutputDataObject(1)
        quantities = table.GetColumnByName("Quantity")
        row = [quantities.GetValue(i) for i in range(table.GetNumberOfRows())].index("Volume")
        self.assertAlmostEqual(table.GetColumnByName("Current").GetValue(row), 5, places=9)

    def test_enumerations_have_setters_of_their_own(self):
        bend = vtkShapePreservingDeformation()
        self.assertEqual(bend.GetVolumeCorrection(), bend.NEUTRAL_OFFSET)
        bend.SetVolumeCorrectionToFrameScaling()
        self.assertEqual(bend.GetVolumeCorrection(), bend.FRAME_SCALING)
        bend.SetVolumeCorrectionToNone()
        self.assertEqual(bend.GetVolumeCorrection(), bend.NO_CORRECTION)
        for name in ("Uniform", "Cotangent", "MeanValue", "LikeFrames"):
            getattr(bend, "SetPositionWeightsTo" + name)()
        self.assertEqual(bend.GetPositionWeights(), bend.LIKE_FRAMES)


if __name__ == "__main__":
    unittest.main()
