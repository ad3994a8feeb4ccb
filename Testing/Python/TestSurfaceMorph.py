# SPDX-License-Identifier: BSD-3-Clause
"""vtkSurfaceMorph as a script meets it."""
import math
import unittest

import numpy
from vtkcartan import vtkSurfaceMorph, vtkVolumeChange
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

import cartan_testing

METHODS = ("DiscreteForms", "Isometric", "DeformationGradient", "PyramidCoordinates", "Linear")


def points_of(surface):
    return vtk_to_numpy(surface.GetPoints().GetData()).astype(float)


def moved(surface, points):
    triangles = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return cartan_testing.surface(points, triangles)


def ribbon(triangles):
    """A flat strip along x, and the same wound to a spiral of two full turns."""
    count = triangles // 2 + 1
    along = numpy.repeat(numpy.linspace(0, 20, count), 2)
    across = numpy.tile([0.0, 1.0], count)
    faces = []
    for i in range(count - 1):
        faces += [[2 * i, 2 * i + 2, 2 * i + 1], [2 * i + 1, 2 * i + 2, 2 * i + 3]]
    flat = numpy.column_stack([along, across, numpy.zeros_like(along)])
    angle = 4 * math.pi * along / 20
    radius = 1 + along / 20
    wound = numpy.column_stack([radius * numpy.cos(angle), across, radius * numpy.sin(angle)])
    return cartan_testing.surface(flat, faces), cartan_testing.surface(wound, faces)


def edge_lengths(surface):
    triangles = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    edges = numpy.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    points = points_of(surface)
    return numpy.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)


def morph_of(*surfaces):
    morph = vtkSurfaceMorph()
    for surface in surfaces:
        morph.AddInputData(surface)
    return morph


def at(morph, parameter):
    morph.SetParameter(parameter)
    morph.Update()
    return morph.GetOutput()


class SurfaceMorph(unittest.TestCase):
    def test_winds_a_ribbon_with_all_lengths_kept(self):
        flat, wound = ribbon(400)
        morph = morph_of(flat, wound)
        morph.SetMethodToIsometric()
        for parameter in (0.25, 0.5, 0.75, 1.25):
            expected = (1 - parameter) * edge_lengths(flat) + parameter * edge_lengths(wound)
            numpy.testing.assert_allclose(edge_lengths(at(morph, parameter)), expected, rtol=1e-11)

    def test_gives_key_frames_back_with_every_method(self):
        bar = cartan_testing.bar(12, 3, 3, 4, 1, 1)
        points = points_of(bar)
        poses = [points, 1.5 * points + [1, 2, 3], points * [1, 1.2, 0.8]]
        morph = morph_of(*(moved(bar, pose) for pose in poses))
        for method in METHODS:
            getattr(morph, "SetMethodTo" + method)()
            for number, pose in enumerate(poses):
                with self.subTest(method=method, key=number):
                    found = points_of(at(morph, number / 2))
                    numpy.testing.assert_array_equal(found, pose)

    def test_turns_where_linear_interpolation_shrinks(self):
        bar = cartan_testing.bar(12, 3, 3, 4, 1, 1)
        half_turn = points_of(bar) * [-1, -1, 1]
        morph = morph_of(bar, moved(bar, half_turn))
        for method in METHODS:
            getattr(morph, "SetMethodTo" + method)()
            change = vtkVolumeChange()
            change.SetInputConnection(morph.GetOutputPort())
            change.SetReferenceData(bar)
            morph.SetParameter(0.5)
            change.Update()
            expected = -1.0 if method == "Linear" else 0.0
            self.assertAlmostEqual(change.GetRelativeVolumeChange(), expected, places=9)

    def test_has_time_steps(self):
        bar = cartan_testing.bar(12, 3, 3, 4, 1, 1)
        morph = morph_of(bar, moved(bar, 2 * points_of(bar)))
        morph.SetStepsBetweenKeyFrames(4)
        morph.UpdateInformation()
        steps = morph.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
        self.assertEqual(list(steps), [0, .25, .5, .75, 1])
        morph.UpdateTimeStep(0.5)
        numpy.testing.assert_allclose(
            points_of(morph.GetOutput()), 1.5 * points_of(bar), atol=1e-9)

    def test_refuses_surfaces_that_differ(self):
        errors = []
        morph = morph_of(cartan_testing.bar(12, 3, 3, 4, 1, 1),
                         cartan_testing.bar(11, 3, 3, 4, 1, 1))
        morph.AddObserver(vtkCommand.ErrorEvent, lambda *_: errors.append(1))
        morph.GetExecutive().AddObserver(vtkCommand.ErrorEvent, lambda *_: None)
        morph.Update()
        self.assertEqual(len(errors), 1)
        self.assertEqual(morph.GetOutput().GetNumberOfPoints(), 0)


if __name__ == "__main__":
    unittest.main()
