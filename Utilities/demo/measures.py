# SPDX-License-Identifier: BSD-3-Clause
"""What a deformation did to a surface, in a few numbers."""
import math
from dataclasses import dataclass

import numpy
from vtkcartan import vtkCurvatureError, vtkVolumeChange

from tableone import points_of, triangles_of


@dataclass
class Measures:
    """Relative changes of volume (NaN if open) and area, of edge lengths as root
    mean square and largest; root mean square of the change of mean curvature, in
    1 / length; the surface with the point array MeanCurvatureError."""
    volume: float
    area: float
    edges: float
    longest: float
    curvature: float
    surface: object


def measure(rest, deformed):
    curvature = vtkCurvatureError()
    curvature.SetInputData(0, deformed)
    curvature.SetInputData(1, rest)
    curvature.Update()
    change = vtkVolumeChange()
    change.SetInputData(0, deformed)
    change.SetInputData(1, rest)
    change.ComputeLocalVolumeOff()
    change.Update()
    return Measures(change.GetRelativeVolumeChange(), change.GetRelativeAreaChange(),
                    change.GetEdgeLengthRMS(), change.GetEdgeLengthMax(),
                    curvature.GetMeanCurvatureErrorRMS(), curvature.GetOutput())


def adjacent_triangles(triangles):
    """The pairs of triangles that share an edge, k x 2."""
    edges = numpy.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    order = numpy.lexsort(edges.T)
    same = (edges[order[1:]] == edges[order[:-1]]).all(axis=1)
    return numpy.stack([order[:-1][same], order[1:][same]], axis=1) // 3


def triangle_frames(points, triangles):
    """Two edges and the unit normal of each triangle, as the columns of m matrices."""
    a, b, c = numpy.moveaxis(points[triangles], 1, 0)
    normals = numpy.cross(b - a, c - a)
    normals /= numpy.linalg.norm(normals, axis=1)[:, None]
    return numpy.stack([b - a, c - a, normals], axis=2)


def roughness(rest, deformed):
    """How much the turn of the surface changes from triangle to triangle: the root
    mean square, over all edges between two triangles, of the angle in degrees from
    the rotation of the one to that of the other. A triangle's rotation is the one
    closest to the map that takes it, and its unit normal, to its new place."""
    triangles = triangles_of(rest)
    maps = triangle_frames(points_of(deformed), triangles) @ numpy.linalg.inv(
        triangle_frames(points_of(rest), triangles))
    # The determinant is positive, since normals go to normals.
    u, _, v = numpy.linalg.svd(maps)
    rotations = u @ v
    one, other = rotations[adjacent_triangles(triangles)].swapaxes(0, 1)
    # |R - S| = sqrt(8) sin(angle / 2)
    half = numpy.arcsin(numpy.minimum(numpy.linalg.norm(one - other, axis=(1, 2))
                                      / math.sqrt(8), 1))
    return math.degrees(2 * math.sqrt((half**2).mean()))
