# SPDX-License-Identifier: BSD-3-Clause
"""The surfaces of the gallery that a formula makes."""
import os
import sys

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersModeling import vtkLoopSubdivisionFilter

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)),
                                "..", "..", "Testing", "Python"))
import cartan_testing


def tube(centers, tangents, radii, sides):
    """A closed tube of circles: n x 3 centers in the plane z = 0, the n x 3 unit
    tangents there, n radii. Its ends are closed by a point each."""
    angles = numpy.linspace(0, 2 * numpy.pi, sides, endpoint=False)
    up = numpy.array([0.0, 0.0, 1.0])
    sideways = numpy.cross(up, tangents)
    circles = (numpy.cos(angles)[:, None] * sideways[:, None, :]
               + numpy.sin(angles)[:, None] * up)
    rings = centers[:, None, :] + radii[:, None, None] * circles
    points = numpy.concatenate([rings.reshape(-1, 3), centers[[0, -1]]])
    around = numpy.arange(sides)
    following = (around + 1) % sides
    ring = sides * numpy.arange(len(centers) - 1)[:, None]
    a, b, c, d = ring + around, ring + following, ring + sides + following, ring + sides + around
    last, first_point = sides * (len(centers) - 1), sides * len(centers)
    # Seen along the tangent, the circles turn with the clock.
    triangles = numpy.concatenate([
        numpy.stack([a, b, c], -1).reshape(-1, 3), numpy.stack([a, c, d], -1).reshape(-1, 3),
        numpy.stack([0 * around + first_point, following, around], -1),
        numpy.stack([0 * around + first_point + 1, last + around, last + following], -1)])
    return cartan_testing.surface(points, triangles)


def trunk():
    """A wrinkled, tapered tube, slightly curved, hollow at its tip, and the part of
    its length, 0 to 1, at which each point is. 21,378 points."""
    length, rings, sides = 12.0, 300, 64
    part = numpy.linspace(0, 1, rings)
    # Wrinkles grow closer toward the tip, like the thickness they are a part of.
    radius = 1.05 - 0.78 * part**0.85
    phase = 2 * numpy.pi * 34 * part**0.9
    radius = radius * (1 + 0.045 * (numpy.abs(numpy.sin(phase / 2))**0.6 - 0.7))
    # A lip at the tip, and a hollow inside; a dome at the other end.
    tip = numpy.linspace(0, 1, 24)[1:]
    lip = numpy.concatenate([0.06 * numpy.sin(numpy.pi * tip[:11]), -0.9 * tip[11:] + 0.45])
    inner = radius[-1] * numpy.concatenate([1 - 0.3 * tip[:11], 0.86 - 0.42 * tip[11:]])
    dome = numpy.linspace(0, numpy.pi / 2, 12)[:-1]
    along = numpy.concatenate([-0.5 * numpy.cos(dome), length * part, length + lip])
    radius = numpy.concatenate([radius[0] * numpy.maximum(numpy.sin(dome), 0.02), radius, inner])
    bend = 0.5 * numpy.sin(1.4 * numpy.pi * numpy.clip(along / length, 0, 1) + 0.2)
    tangents = numpy.stack([numpy.cos(bend), numpy.sin(bend), 0 * bend], -1)
    steps = numpy.diff(along)[:, None] * (tangents[1:] + tangents[:-1]) / 2
    centers = numpy.concatenate([numpy.zeros((1, 3)), numpy.cumsum(steps, 0)])
    parts = numpy.concatenate([numpy.repeat(along / length, sides), [0, 1]])
    return tube(centers, tangents, radius, sides), parts


def dome(distance, radius):
    """A smooth bump: 1 at the distance 0, 0 from the radius on."""
    return (1 - numpy.minimum(distance / radius, 1)**2)**2


def studded_bar(length, per_unit):
    """A bar of 1 x 1 x length with a row of domes on each side, and the part of its
    length at which each point is."""
    count = round(length * per_unit)
    bar = cartan_testing.bar(per_unit, per_unit, count, 1, 1, length)
    points = vtk_to_numpy(bar.GetPoints().GetData())
    points[:, :2] -= 0.5
    parts = points[:, 2] / length
    for axis in (0, 1):
        # A dome per unit of length, those of neighboring sides in turn.
        shift = 0.5 * axis
        nearest = numpy.round(points[:, 2] - 0.5 - shift) + 0.5 + shift
        distance = numpy.hypot(points[:, 1 - axis], points[:, 2] - nearest)
        whole = (nearest > 0.4) & (nearest < length - 0.4)
        side = numpy.abs(points[:, axis]) > 0.5 - 1e-9
        height = numpy.where(side & whole, 0.2 * dome(distance, 0.38), 0)
        points[:, axis] += numpy.sign(points[:, axis]) * height
    return bar, parts


def cylinder(length, rings, sides):
    """A closed cylinder of diameter 1 along x, from 0 to the length, and the part of
    its length at which each point is."""
    part = numpy.linspace(0, 1, rings)
    centers = length * part[:, None] * (1.0, 0.0, 0.0)
    tangents = numpy.broadcast_to((1.0, 0.0, 0.0), centers.shape)
    surface = tube(centers, tangents, numpy.full(rings, 0.5), sides)
    return surface, numpy.concatenate([numpy.repeat(part, sides), [0, 1]])


def bumpy_plane(count):
    """A square of side 4 around the origin with count x count points and domes on it,
    and how far each point is from its middle: 0 there, 1 at the border."""
    side = numpy.linspace(-2, 2, count)
    x, y = (grid.ravel() for grid in numpy.meshgrid(side, side))
    # A dome around every odd tenth.
    nearest = [0.2 * (2 * numpy.floor(grid / 0.4) + 1) for grid in (x, y)]
    height = 0.12 * dome(numpy.hypot(x - nearest[0], y - nearest[1]), 0.18)
    first = (numpy.arange(count - 1)[:, None] * count + numpy.arange(count - 1)).ravel()
    right, above, across = first + 1, first + count, first + count + 1
    triangles = numpy.concatenate([numpy.stack([first, right, across], -1),
                                   numpy.stack([first, across, above], -1)])
    surface = cartan_testing.surface(numpy.stack([x, y, height], -1), triangles)
    return surface, numpy.maximum(abs(x), abs(y)) / 2


def cactus():
    """The scanned cactus, its triangles divided in 64 by Loop's scheme, and the part
    of its height at which each point is."""
    refine = vtkLoopSubdivisionFilter()
    refine.SetInputData(cartan_testing.read_off("cactus"))
    refine.SetNumberOfSubdivisions(3)
    refine.Update()
    height = vtk_to_numpy(refine.GetOutput().GetPoints().GetData())[:, 1]
    return refine.GetOutput(), (height - height.min()) / (height.max() - height.min())
