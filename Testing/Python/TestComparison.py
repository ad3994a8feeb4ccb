# SPDX-License-Identifier: BSD-3-Clause
"""The surfaces and measures of the comparison of methods, Utilities/demo/compare.py."""
import math
import os
import sys
import unittest

import numpy
from vtkcartan import vtkHandleMotion
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonMath import vtkMatrix4x4

import cartan_testing

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)),
                                "..", "..", "Utilities", "demo"))
import compare
import shapes
from measures import adjacent_triangles, measure, roughness
from tableone import points_of, triangles_of, volume


def turn(degrees):
    """About (1, 1, 1), by Rodrigues' formula."""
    cross = numpy.array([[0, -1, 1], [1, 0, -1], [-1, 1, 0]]) / math.sqrt(3)
    angle = math.radians(degrees)
    return numpy.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def mapped(surface, matrix):
    return cartan_testing.surface(points_of(surface) @ matrix.T + (3, -2, 1),
                                  triangles_of(surface))


class Roughness(unittest.TestCase):
    def test_vanishes_for_similarities(self):
        rest, _ = shapes.studded_bar(3, 8)
        for matrix in (turn(100), 2.5 * turn(-30)):
            self.assertLess(roughness(rest, mapped(rest, matrix)), 1e-6)

    def test_does_not_see_how_surfaces_lie(self):
        rest = cartan_testing.bar(3, 3, 12, 1, 1, 4)
        points = points_of(rest)
        bent = points + 0.1 * numpy.sin(points[:, [1, 2, 0]])
        bent = cartan_testing.surface(bent, triangles_of(rest))
        expected = roughness(rest, bent)
        self.assertGreater(expected, 0.5)
        self.assertAlmostEqual(roughness(mapped(rest, turn(70)), mapped(bent, turn(-120))),
                               expected, places=9)

    def test_is_the_angle_of_a_hinge(self):
        triangles = [(0, 1, 2), (1, 0, 3)]
        flat = cartan_testing.surface([(0, 0, 0), (1, 0, 0), (0.4, 1, 0), (0.6, -1, 0)], triangles)
        for degrees in (1, 60, 170):
            angle = math.radians(degrees)
            folded = cartan_testing.surface(
                [(0, 0, 0), (1, 0, 0), (0.4, 1, 0),
                 (0.6, -math.cos(angle), -math.sin(angle))], triangles)
            self.assertAlmostEqual(roughness(flat, folded), degrees, places=9)

    def test_compares_each_pair_of_neighbors_once(self):
        for surface in (shapes.cylinder(2, 9, 12)[0], cartan_testing.bar(2, 3, 4, 1, 1, 1)):
            triangles = triangles_of(surface)
            pairs = adjacent_triangles(triangles)
            self.assertEqual(len(pairs), 3 * len(triangles) // 2)
            for one, other in pairs:
                self.assertEqual(len(set(triangles[one]) & set(triangles[other])), 2)


class Shapes(unittest.TestCase):
    def test_tubes_are_closed_and_oriented_outwards(self):
        cylinder, _ = shapes.cylinder(5, 75, 64)
        # The prism over the polygon of 64 sides in a circle of diameter 1.
        self.assertAlmostEqual(volume(cylinder), 5 * 8 * math.sin(2 * math.pi / 64), places=9)
        for surface, _ in (shapes.trunk(), shapes.studded_bar(4, 12), shapes.cactus()):
            unchanged = measure(surface, surface)
            self.assertEqual(unchanged.volume, 0)
            self.assertGreater(volume(surface), 0)

    def test_the_plane_has_a_border(self):
        plane, distances = shapes.bumpy_plane(31)
        triangles = triangles_of(plane)
        self.assertEqual(len(adjacent_triangles(triangles)), (3 * len(triangles) - 4 * 30) // 2)
        self.assertEqual((distances == 1).sum(), 4 * 30)
        self.assertTrue(math.isnan(measure(plane, plane).volume))

    def test_exact_deformations_do_what_the_handles_do(self):
        for make in (compare.twisted_bar, compare.bent_cylinder):
            case = make()
            handles = vtk_to_numpy(case.rest.GetPointData().GetArray("Handle"))
            rest, moved = points_of(case.rest), points_of(compare.moved(case))
            motion = vtkHandleMotion()
            case.move(motion, 1)
            transform = vtkMatrix4x4()
            motion.GetTransform(transform)
            matrix = numpy.array([[transform.GetElement(i, j) for j in range(4)]
                                  for i in range(3)])
            self.assertGreater((handles == 0).sum(), 1000)
            numpy.testing.assert_allclose(moved[handles == 1], rest[handles == 1], atol=1e-12)
            numpy.testing.assert_allclose(
                moved[handles == 2], rest[handles == 2] @ matrix[:, :3].T + matrix[:, 3],
                atol=1e-12)


if __name__ == "__main__":
    unittest.main()
