# SPDX-License-Identifier: BSD-3-Clause
"""vtkRotationInvariantDeformation as a script meets it."""
import math
import unittest

import numpy
from vtkcartan import vtkHandleMotion, vtkRotationInvariantDeformation
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkCommonMath import vtkMatrix4x4

import cartan_testing


def points_of(surface):
    return vtk_to_numpy(surface.GetPoints().GetData()).copy()


def add_array(surface, name, values):
    array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
    array.SetName(name)
    surface.GetPointData().AddArray(array)


def marked(surface, axis, share=.15):
    """Handles 1 and 2 at both ends along an axis."""
    x = points_of(surface)[:, axis]
    part = (x - x.min()) / numpy.ptp(x)
    add_array(surface, "Handle", (part < share) + 2 * (part > 1 - share).astype(numpy.int32))
    return surface


def turn(degrees, axis=(1, 0, 0), center=(0, 0, 0), translation=(0, 0, 0)):
    motion = vtkHandleMotion()
    motion.SetAxis(axis)
    motion.SetAngle(degrees)
    motion.SetCenter(center)
    motion.SetTranslation(translation)
    return motion


def matrix_of(motion):
    matrix = vtkMatrix4x4()
    motion.GetTransform(matrix)
    return numpy.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)])


def deformation(surface, **motions):
    bend = vtkRotationInvariantDeformation()
    bend.SetInputData(surface)
    for name, motion in motions.items():
        bend.SetHandleMotion(int(name.replace("handle", "")), motion)
    return bend


class RotationInvariantDeformation(unittest.TestCase):
    def test_all_handles_moving_rigidly_move_the_surface_rigidly(self):
        camel = marked(cartan_testing.read_off("camel"), 1)
        motion = turn(130, (1, 2, 3), (.1, .2, .3), (1, 0, -1))
        bend = deformation(camel, handle1=motion, handle2=motion)
        bend.Update()
        matrix = matrix_of(motion)
        expected = points_of(camel) @ matrix[:3, :3].T + matrix[:3, 3]
        numpy.testing.assert_allclose(points_of(bend.GetOutput()), expected, rtol=0, atol=1e-10)

    def test_ten_motions_need_one_factorization(self):
        bar = marked(cartan_testing.bar(3, 3, 15, 1, 1, 5), 2)
        motion = turn(0, center=(0, 0, 2.5))
        bend = deformation(bar, handle2=motion)
        previous = None
        for step in range(10):
            motion.SetAngle(10 * step)
            bend.Update()
            points = points_of(bend.GetOutput())
            self.assertFalse(previous is not None and numpy.array_equal(points, previous))
            previous = points
        self.assertEqual(bend.GetNumberOfFactorizations(), 1)

    def test_handles_are_where_their_motions_put_them(self):
        bar = marked(cartan_testing.bar(3, 3, 15, 1, 1, 5), 2)
        motion = turn(60, center=(0, 0, 2.5), translation=(0, .5, .5))
        motion.SetScale(1, 2, 1)
        bend = deformation(bar, handle2=motion)
        bend.Update()
        handle = vtk_to_numpy(bar.GetPointData().GetArray("Handle"))
        matrix = matrix_of(motion)
        rest = points_of(bar)
        result = points_of(bend.GetOutput())
        numpy.testing.assert_array_equal(result[handle == 1], rest[handle == 1])
        numpy.testing.assert_allclose(
            result[handle == 2], rest[handle == 2] @ matrix[:3, :3].T + matrix[:3, 3],
            rtol=0, atol=1e-13)
        self.assertEqual(bend.GetNumberOfFreePoints(), (handle == 0).sum())

    def test_frame_change_is_zero_at_the_pinned_end_and_full_at_the_moved_one(self):
        bar = marked(cartan_testing.bar(3, 3, 15, 1, 1, 5), 2)
        bend = deformation(bar, handle2=turn(70, center=(0, 0, 2.5)))
        bend.GenerateFrameChangeOn()
        bend.GenerateRotationVectorOn()
        bend.Update()
        data = bend.GetOutput().GetPointData()
        change = vtk_to_numpy(data.GetArray("FrameChange"))
        vector = vtk_to_numpy(data.GetArray("RotationVector"))
        handle = vtk_to_numpy(bar.GetPointData().GetArray("Handle"))
        full = math.sqrt(8) * math.sin(math.radians(35))
        numpy.testing.assert_allclose(change[handle == 1], 0, atol=1e-14)
        numpy.testing.assert_allclose(change[handle == 2], full, atol=1e-13)
        self.assertTrue(((change[handle == 0] > 0) & (change[handle == 0] < full)).all())
        numpy.testing.assert_allclose(vector[handle == 2],
                                      [[math.radians(70), 0, 0]] * (handle == 2).sum(), atol=1e-13)

    def test_targets_may_be_given_point_by_point(self):
        bar = marked(cartan_testing.bar(3, 3, 15, 1, 1, 5), 2)
        motion = turn(50, center=(0, 0, 2.5))
        bend = deformation(bar, handle2=motion)
        bend.Update()
        expected = points_of(bend.GetOutput())
        handle = vtk_to_numpy(bar.GetPointData().GetArray("Handle"))
        matrix = matrix_of(motion)
        target = points_of(bar)
        target[handle == 2] = target[handle == 2] @ matrix[:3, :3].T + matrix[:3, 3]
        vector = numpy.zeros_like(target)
        vector[handle == 2] = [math.radians(50), 0, 0]
        add_array(bar, "Target", target)
        add_array(bar, "Turn", vector)
        bend.RemoveHandleMotion(2)
        bend.SetTargetPositionArrayName("Target")
        bend.SetRotationVectorArrayName("Turn")
        bend.Update()
        numpy.testing.assert_allclose(points_of(bend.GetOutput()), expected, rtol=0, atol=1e-12)

    def test_enumerations_have_setters_of_their_own(self):
        bend = vtkRotationInvariantDeformation()
        self.assertEqual(bend.GetFrameProjection(), bend.AUTOMATIC)
        for name, value in (("Rotation", bend.ROTATION), ("None", bend.NONE),
                            ("Automatic", bend.AUTOMATIC)):
            getattr(bend, "SetFrameProjectionTo" + name)()
            self.assertEqual(bend.GetFrameProjection(), value)
        for name, value in (("Uniform", bend.UNIFORM), ("MeanValue", bend.MEAN_VALUE),
                            ("Cotangent", bend.COTANGENT)):
            getattr(bend, "SetLaplacianWeightsTo" + name)()
            self.assertEqual(bend.GetLaplacianWeights(), value)

    def test_an_error_says_what_is_wrong_and_passes(self):
        messages = []

        def note(caller, event, text):
            messages.append(text)
        note.CallDataType = "string0"
        bar = cartan_testing.bar(3, 3, 15, 1, 1, 5)
        bend = deformation(bar, handle2=turn(10))
        bend.AddObserver(vtkCommand.ErrorEvent, note)
        bend.GetExecutive().AddObserver(vtkCommand.ErrorEvent, lambda *_: None)
        bend.Update()
        self.assertEqual(len(messages), 1)
        self.assertIn('no point array "Handle"', messages[0])
        self.assertEqual(bend.GetOutput().GetNumberOfPoints(), 0)
        marked(bar, 2)
        bar.Modified()
        bend.Update()
        self.assertEqual(len(messages), 1)
        self.assertEqual(bend.GetOutput().GetNumberOfPoints(), bar.GetNumberOfPoints())


if __name__ == "__main__":
    unittest.main()
