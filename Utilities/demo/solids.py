# SPDX-License-Identifier: BSD-3-Clause
"""A mesh of tetrahedra that follows its skin, and the strain of a morph: rows of the sheet that
examples.py draws."""
import numpy
from vtkcartan import vtkHandleMotion, vtkSurfaceMorph, vtkVolumeChange, vtkVolumetricDeformation
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkCellArray, vtkPolyData, vtkUnstructuredGrid
from vtkmodules.vtkFiltersCore import vtkDelaunay2D

import cartan_testing
from pictures import Panel
from tableone import points_of

ARMS, RINGS, LAYERS = 5, 30, 5
STRAIN = 0.5
X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)


def disk():
    """Points in the unit disk, evenly on rings, and their triangles."""
    points = [(0.0, 0.0, 0.0)]
    for ring in range(1, RINGS + 1):
        count = 6 * ring
        for angle in 2 * numpy.pi * (numpy.arange(count) + 0.5 * (ring % 2)) / count:
            points.append((ring / RINGS * numpy.cos(angle), ring / RINGS * numpy.sin(angle), 0.0))
    cloud = vtkPolyData()
    places = vtkPoints()
    places.SetData(numpy_to_vtk(numpy.array(points), deep=True))
    cloud.SetPoints(places)
    delaunay = vtkDelaunay2D()
    delaunay.SetInputData(cloud)
    delaunay.Update()
    corners = vtk_to_numpy(delaunay.GetOutput().GetPolys().GetConnectivityArray())
    return numpy.array(points), corners.reshape(-1, 3)


def starfish():
    """The points of a starfish in layers, and tetrahedra: each triangle of the disk is the base
    of a prism from layer to layer, which is cut the same way as its neighbors."""
    flat, triangles = disk()
    radius = numpy.hypot(flat[:, 0], flat[:, 1])
    angle = numpy.arctan2(flat[:, 1], flat[:, 0])
    reach = 0.38 + 0.62 * (0.5 + 0.5 * numpy.cos(ARMS * angle)) ** 1.6
    # Round in the middle, where prisms between arms would be needles.
    plane = flat[:, :2] * (0.6 + numpy.sqrt(radius) * (reach - 0.6))[:, None]
    arm = numpy.cos(ARMS * angle)
    height = 0.025 + 0.16 * numpy.sqrt(numpy.clip(1 - radius ** 2, 0, 1)) * (
        1 - 0.45 * radius * (1 - 0.5 * arm))
    layers = numpy.linspace(-0.35, 1, LAYERS + 1)
    points = numpy.concatenate([numpy.column_stack([plane, layer * height]) for layer in layers])
    tetrahedra = []
    ordered = numpy.sort(triangles, axis=1)
    for layer in range(LAYERS):
        low, high = ordered + layer * len(flat), ordered + (layer + 1) * len(flat)
        a, b, c = low.T
        d, e, f = high.T
        tetrahedra += [numpy.stack(corners, axis=1)
                       for corners in ((a, b, c, f), (a, b, e, f), (a, d, e, f))]
    tetrahedra = numpy.concatenate(tetrahedra)
    # All of positive volume.
    edges = points[tetrahedra[:, 1:]] - points[tetrahedra[:, :1]]
    negative = numpy.linalg.det(edges) < 0
    tetrahedra[negative] = tetrahedra[negative][:, [0, 2, 1, 3]]
    return points, tetrahedra


def sides(tetrahedra):
    """The triangles of tetrahedra that belong to one only, seen from outside."""
    faces = tetrahedra[:, [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]].reshape(-1, 3)
    _, first, counts = numpy.unique(numpy.sort(faces, axis=1), axis=0, return_index=True,
                                    return_counts=True)
    return faces[first[counts == 1]]


def grid(points, tetrahedra):
    result = vtkUnstructuredGrid()
    places = vtkPoints()
    places.SetData(numpy_to_vtk(numpy.ascontiguousarray(points), deep=True))
    result.SetPoints(places)
    cells = vtkCellArray()
    offsets = numpy.arange(0, 4 * len(tetrahedra) + 1, 4, dtype=numpy.int64)
    cells.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True),
                  numpy_to_vtkIdTypeArray(tetrahedra.ravel().astype(numpy.int64), deep=True))
    result.SetCells(VTK_TETRA, cells)
    return result


def skin(points, faces):
    """A surface with the points of the skin alone."""
    used, corners = numpy.unique(faces, return_inverse=True)
    return cartan_testing.surface(points[used], corners.reshape(-1, 3)), used


def with_handles(surface, handles):
    array = numpy_to_vtk(numpy.ascontiguousarray(handles, dtype=numpy.int32), deep=True)
    array.SetName("Handle")
    surface.GetPointData().AddArray(array)
    return surface


def opened(points, tetrahedra, kept):
    """The skin of those tetrahedra that are kept. Where others are missing one sees the inside,
    whose triangles have points of their own, so that they look flat."""
    faces = sides(tetrahedra[kept])
    outside = {tuple(face) for face in numpy.sort(sides(tetrahedra), axis=1)}
    inside = numpy.array([tuple(face) not in outside for face in numpy.sort(faces, axis=1)])
    own = points[faces[inside]].reshape(-1, 3)
    corners = numpy.concatenate([faces[~inside],
                                 len(points) + numpy.arange(len(own)).reshape(-1, 3)])
    used, renumbered = numpy.unique(corners, return_inverse=True)
    surface = cartan_testing.surface(numpy.concatenate([points, own])[used],
                                     renumbered.reshape(-1, 3))
    return with_handles(surface, numpy.where(used < len(points), 0, 2))


def turn(axis, angle, center):
    motion = vtkHandleMotion()
    motion.SetAxis(*axis)
    motion.SetAngle(angle)
    motion.SetCenter(*center)
    return motion


def volume_of(points, tetrahedra):
    edges = points[tetrahedra[:, 1:]] - points[tetrahedra[:, :1]]
    return numpy.linalg.det(edges).sum() / 6


def solids():
    """The skin is deformed by three handles, and the tetrahedra follow."""
    points, tetrahedra = starfish()
    surface, used = skin(points, sides(tetrahedra))
    places = points[used]
    angle = numpy.arctan2(places[:, 1], places[:, 0])
    radius = numpy.hypot(places[:, 0], places[:, 1])
    arm = numpy.round(angle / (2 * numpy.pi / ARMS)).astype(int) % ARMS
    handles = numpy.where(radius < 0.2, 1, numpy.where(radius > 0.82, 2 + arm, 0))
    with_handles(surface, handles)
    deform = vtkVolumetricDeformation()
    deform.SetInputData(surface)
    deform.SetVolumeMeshData(grid(points, tetrahedra))
    # Each arm rolls up or down as a length of it from the middle on becomes an arc.
    start, length = 0.2, 0.65
    for number, degrees in enumerate((-60, 32, -50, 36, -50)):
        out = 2 * numpy.pi * number / ARMS
        bend = numpy.radians(degrees)
        end = start + length
        arc = start + length * numpy.sin(bend) / bend, length * (1 - numpy.cos(bend)) / -bend
        motion = turn((-numpy.sin(out), numpy.cos(out), 0), degrees,
                      (end * numpy.cos(out), end * numpy.sin(out), 0.03))
        motion.SetTranslation((arc[0] - end) * numpy.cos(out), (arc[0] - end) * numpy.sin(out),
                              arc[1])
        deform.SetHandleMotion(2 + number, motion)
    deform.Update()
    moved = points_of(deform.GetVolumeMesh())
    inverted = deform.GetNumberOfInvertedCells()
    change = volume_of(moved, tetrahedra) / volume_of(points, tetrahedra) - 1
    print("A starfish of %d tetrahedra: %d inverted, volume %+.1f %%" %
          (len(tetrahedra), inverted, 100 * change))
    middles = points[tetrahedra].mean(axis=1)
    kept = middles[:, 1] > 0
    clamped = with_handles(surface, numpy.minimum(handles, 2))
    result = with_handles(deform.GetOutput(), numpy.minimum(handles, 2))
    return [Panel("a skin with handles", f"{surface.GetNumberOfPoints():,} points", clamped),
            Panel("cut open", f"{len(tetrahedra):,} tetrahedra", opened(points, tetrahedra, kept)),
            Panel("the skin deformed", "", result),
            Panel("its tetrahedra follow",
                  "%d inverted, volume %+.1f %%" % (inverted, 100 * change),
                  opened(moved, tetrahedra, kept))]


def strained(surface, rest, title, note):
    """A panel with the larger of the principal Hencky strains, the logarithms of stretches."""
    change = vtkVolumeChange()
    change.SetInputData(surface)
    change.SetReferenceData(rest)
    change.ComputeLocalVolumeOff()
    change.SetStrainMeasureToHencky()
    change.Update()
    output = change.GetOutput()
    larger, smaller = (vtk_to_numpy(output.GetPointData().GetArray(f"HenckyStrain{number}"))
                       for number in (1, 2))
    strain = numpy.where(abs(larger) > abs(smaller), larger, smaller)
    shown = with_handles(output, numpy.zeros(output.GetNumberOfPoints()))
    array = numpy_to_vtk(numpy.ascontiguousarray(strain), deep=True)
    array.SetName("Strain")
    shown.GetPointData().AddArray(array)
    rms = numpy.sqrt(numpy.mean(strain ** 2))
    print("  %-44s strains of %.3f (root mean square)" % (title, rms))
    return Panel(title, note or "strains of %.3f, rms" % rms, shown, "Strain", STRAIN)


def morphed(first, last, method, part):
    morph = vtkSurfaceMorph()
    morph.AddInputData(first)
    morph.AddInputData(last)
    getattr(morph, "SetMethodTo" + method)()
    morph.FollowTimeOff()
    morph.SetParameter(part)
    morph.Update()
    return morph.GetOutput()


def strains(first, last):
    """How a morph strains the surface on its way."""
    print("Strain of a morph")
    return [strained(first, first, "a surface",
                     "strains from %g (blue) to %g (red)" % (-STRAIN, STRAIN)),
            strained(morphed(first, last, "Linear", 0.5), first, "halfway, point by point", ""),
            strained(morphed(first, last, "DiscreteForms", 0.5), first,
                     "halfway, Discrete Forms", ""),
            strained(last, first, "another pose", "")]
