# SPDX-License-Identifier: BSD-3-Clause
"""Sews a scanned head onto a dinosaur, tubes with reliefs that fade into each other, and a ball
between four tubes; takes the coating off a scan and puts it on again.
The first is like the figures of Fu, Au and Tai, Effective Derivation of Similarity Transformations for
Implicit Laplacian Mesh Editing (2007), section 5. Run by Utilities/demo.sh --merge in
pvpython; the argument is the build folder. merge.png, a sheet of all, appears in its
folder demo; what was measured is printed."""
import os
import sys
import time

import numpy
from vtkcartan import vtkBoundaryLoops, vtkCoatingTransfer, vtkMeshMerge
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_ID_TYPE, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPlane, vtkPolyData
from vtkmodules.vtkFiltersCore import (vtkAppendPolyData, vtkCleanPolyData, vtkClipPolyData,
                                       vtkPolyDataConnectivityFilter, vtkTriangleFilter)
from vtkmodules.vtkFiltersSources import vtkTessellatedBoxSource

from pictures import (Panel, camera_for, draw, heading, one_below_the_other, side_by_side,
                      write_sheet)
import cartan_testing

SIZE, HEADING = (700, 620), 60

# Points of the head's neck and of the dinosaur's that belong together.
KEYS = (((.7024, -4.0345, -15), (-.0057, -.3284, 1.1572)),
        ((8.7036, 6.0022, -15), (.1425, -.1198, 1.2511)),
        ((-.8888, 14.6942, -15), (-.0046, -.0464, 1.2841)),
        ((-9.1506, 7.1219, -15), (-.1465, -.12, 1.251)))


def points_of(surface):
    return vtk_to_numpy(surface.GetPoints().GetData())


def with_handles(surface, values=None):
    """A copy with the array Handle, which colors panels: zeros by default."""
    result = vtkPolyData()
    result.DeepCopy(surface)
    if values is None:
        values = numpy.zeros(surface.GetNumberOfPoints())
    handles = numpy_to_vtk(numpy.ascontiguousarray(values, dtype=numpy.int32), deep=True)
    handles.SetName("Handle")
    result.GetPointData().AddArray(handles)
    return result


def cut(surface, origin, normal):
    """What lies on the normal's side of a plane, in one piece."""
    # Points next to the plane go onto it: cuts close beside a point make needles.
    snapped = vtkPolyData()
    snapped.DeepCopy(surface)
    points = points_of(snapped)
    triangles = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    edges = numpy.linalg.norm(points[triangles] - points[numpy.roll(triangles, 1, axis=1)], axis=2)
    unit = numpy.array(normal) / numpy.linalg.norm(normal)
    heights = (points - numpy.array(origin)) @ unit
    heights[abs(heights) > 0.2 * edges.mean()] = 0.0
    points -= heights[:, None] * unit
    plane = vtkPlane()
    plane.SetOrigin(origin)
    plane.SetNormal(normal)
    clip = vtkClipPolyData()
    clip.SetInputData(snapped)
    clip.SetClipFunction(plane)
    triangles = vtkTriangleFilter()
    triangles.SetInputConnection(clip.GetOutputPort())
    largest = vtkPolyDataConnectivityFilter()
    largest.SetInputConnection(triangles.GetOutputPort())
    largest.SetExtractionModeToLargestRegion()
    clean = vtkCleanPolyData()
    clean.SetInputConnection(largest.GetOutputPort())
    clean.SetTolerance(1e-6)
    clean.Update()
    return clean.GetOutput()


def set_keys(surface, places):
    """Numbers the boundary points that are closest to places from 1."""
    keys = numpy.zeros(surface.GetNumberOfPoints(), dtype=numpy.int32)
    boundary = boundary_points(surface)
    points = points_of(surface)[boundary]
    for number, place in enumerate(places, 1):
        keys[boundary[numpy.linalg.norm(points - numpy.array(place), axis=1).argmin()]] = number
    array = numpy_to_vtk(keys, deep=True)
    array.SetName("BoundaryKey")
    surface.GetPointData().AddArray(array)


def boundary_points(surface):
    loops = vtkBoundaryLoops()
    loops.SetInputData(surface)
    loops.Update()
    return vtk_to_numpy(loops.GetOutput().GetPointData().GetArray("OriginalPointIds"))


def merged(title, target, source, **values):
    """A panel of two surfaces that are sewn together, and a line of the table."""
    merge = vtkMeshMerge()
    merge.SetInputData(target)
    merge.SetSourceData(source)
    for name, value in values.items():
        getattr(merge, "Set" + name)(value)
    start = time.process_time()
    merge.Update()
    seconds = time.process_time() - start
    output = merge.GetOutput()
    angles = "seam %.1f degrees, %.1f at most" % (
        merge.GetSeamAngleMean(), merge.GetSeamAngleMaximum())
    print("  %-44s%9d points   %s   %.2f s" % (title, output.GetNumberOfPoints(), angles, seconds))
    origins = vtk_to_numpy(output.GetPointData().GetArray("MergeOrigin"))
    return Panel(title, angles, with_handles(output, numpy.where(origins == 1, 2, 0)))


def row(title, panels, view_from, view_up, focus=None):
    """The panels under a heading; `focus` are the points that the picture shows."""
    cameras = [camera_for(view_from, view_up, points_of(p.surface) if focus is None else focus,
                          SIZE, 0.1, 0.1) for p in panels]
    pictures = [draw(p, camera, SIZE) for p, camera in zip(panels, cameras)]
    return one_below_the_other(
        [heading(title, (len(panels) * SIZE[0], HEADING)), side_by_side(pictures)])


def head_on_dinosaur():
    head = cut(cartan_testing.read_off("mannequin-devil"), (0, 0, -15), (0, 0, 1))
    dinosaur = cut(cartan_testing.read_off("dino"), (0, -.9, .9), (0, .45, -1))
    set_keys(head, [key[0] for key in KEYS])
    set_keys(dinosaur, [key[1] for key in KEYS])
    print("A head on a dinosaur")
    whole = merged("sewn together", dinosaur, head)
    faired = merged("the seam and two rings made smooth", dinosaur, head, SeamFairing=2)
    faded = merged("transplanted: a transition of .1", dinosaur, head, TransitionWidth=0.1)
    parts = [Panel("target", f"{dinosaur.GetNumberOfPoints():,} points", with_handles(dinosaur)),
             Panel("source", f"{head.GetNumberOfPoints():,} points",
                   with_handles(head, numpy.full(head.GetNumberOfPoints(), 2)))]
    return row("A head on a dinosaur, wherever it comes from", [parts[0], whole, faired, faded],
               (1, -0.4, 0.35), (0, 0, 1))


def surface_of(points, triangles):
    surface = vtkPolyData()
    locations = vtkPoints()
    locations.SetData(numpy_to_vtk(numpy.ascontiguousarray(points), deep=True))
    cells = vtkCellArray()
    cells.SetData(3, numpy_to_vtk(numpy.ascontiguousarray(triangles, dtype=numpy.int64).ravel(),
                                  deep=True, array_type=VTK_ID_TYPE))
    surface.SetPoints(locations)
    surface.SetPolys(cells)
    return surface


def tube(around, along, place):
    """A tube whose points are place(angle, part of the length)."""
    angles, parts = numpy.meshgrid(2 * numpy.pi * numpy.arange(around) / around,
                                   numpy.linspace(0, 1, along))
    first = around * numpy.arange(along - 1)[:, None] + numpy.arange(around)
    right = around * numpy.arange(along - 1)[:, None] + numpy.roll(numpy.arange(around), -1)
    triangles = numpy.stack([numpy.stack([first, right, right + around], axis=-1),
                             numpy.stack([first, right + around, first + around], axis=-1)])
    return surface_of(place(angles.ravel(), parts.ravel()), triangles.reshape(-1, 3))


def relief(around, along, from_height, waves, threads):
    """A tube of length 4 with waves around it, threads > 0 along it as well."""
    def place(angle, part):
        radius = 1 + 0.06 * numpy.cos(waves * angle + threads * part)
        return numpy.column_stack([radius * numpy.cos(angle), radius * numpy.sin(angle),
                                   from_height + 4 * part])
    return tube(around, along, place)


def number_point(surface, point):
    """Gives one point the key 1."""
    keys = numpy.zeros(surface.GetNumberOfPoints(), dtype=numpy.int32)
    keys[point] = 1
    array = numpy_to_vtk(keys, deep=True)
    array.SetName("BoundaryKey")
    surface.GetPointData().AddArray(array)


def transition():
    """Two reliefs that fade into each other."""
    target = relief(160, 120, 0, 12, 0)
    source = relief(140, 110, 5, 5, 40)
    number_point(target, 160 * 119)
    number_point(source, 0)
    print("Two reliefs")
    panels = [Panel("target", "", with_handles(target)),
              Panel("source", "", with_handles(source, numpy.full(140 * 110, 2))),
              merged("sewn at their loops", target, source),
              merged("with a transition of 2", target, source, TransitionWidth=2)]
    return row("Details fade across a transition", panels, (1, -1.2, 0.2), (0, 0, 1))


def ball_with_openings(count):
    """A ball of radius 1.3 with round openings to the four sides of x and y."""
    box = vtkTessellatedBoxSource()
    box.SetBounds(-1, 1, -1, 1, -1, 1)
    box.SetLevel(count)
    box.QuadsOff()
    clean = vtkCleanPolyData()
    clean.SetInputConnection(box.GetOutputPort())
    clean.Update()
    points = points_of(clean.GetOutput()).astype(float)
    triangles = vtk_to_numpy(clean.GetOutput().GetPolys().GetConnectivityArray()).reshape(-1, 3)
    # Squares around the middle of a side become rings around it, and the innermost ones go.
    inside = numpy.zeros(len(points), dtype=bool)
    for axis in (0, 1):
        side = abs(abs(points[:, axis]) - 1) < 1e-6
        others = [k for k in range(3) if k != axis]
        flat = points[side][:, others]
        size = abs(flat).max(axis=1)
        inside[numpy.flatnonzero(side)[size < 0.55]] = True
        blend = numpy.clip(2 - 2 * size, 0, 1)[:, None]
        round_ = flat * (size / numpy.maximum(numpy.linalg.norm(flat, axis=1), 1e-9))[:, None]
        points[numpy.ix_(side, others)] = blend * round_ + (1 - blend) * flat
    points *= (1.3 / numpy.linalg.norm(points, axis=1))[:, None]
    kept = triangles[~inside[triangles].any(axis=1)]
    used, numbers = numpy.unique(kept, return_inverse=True)
    return surface_of(points[used], numbers.reshape(-1, 3))


def branches():
    """A ball with four openings between four tubes of different sizes."""
    source = ball_with_openings(16)
    targets = vtkAppendPolyData()
    for angle, radius in ((0, 0.9), (90, 0.5), (180, 0.7), (270, 0.4)):
        out = numpy.array([numpy.cos(numpy.radians(angle)), numpy.sin(numpy.radians(angle)), 0])
        side = numpy.cross((0, 0, 1), out)

        def place(turn, part, out=out, side=side, radius=radius):
            return ((3.6 - 1.8 * part)[:, None] * out +
                    radius * (numpy.cos(turn)[:, None] * side -
                              numpy.sin(turn)[:, None] * numpy.array([0, 0, 1])))
        targets.AddInputData(tube(40, 24, place))
    targets.Update()
    target = targets.GetOutput()
    # The outer ends stay open: the inner ones have keys, and so have the ball's.
    print("Four pairs of loops")
    centers = [1.05 * numpy.array([numpy.cos(a), numpy.sin(a), 0])
               for a in numpy.radians((0, 90, 180, 270))]
    set_keys(source, [center + (0, 0, 1) for center in centers])
    set_keys(target, [1.8 * center / 1.05 + (0, 0, 1) for center in centers])
    panels = [Panel("target", "four tubes", with_handles(target)),
              Panel("source", "", with_handles(source,
                                               numpy.full(source.GetNumberOfPoints(), 2))),
              merged("sewn at four pairs of loops", target, source),
              merged("with a transition of .6", target, source, TransitionWidth=0.6)]
    return row("Several pairs of boundaries", panels, (0.4, -0.6, 1), (0, 1, 0))


def coating():
    """The base of a scan, with its coating once, twice and three times as high."""
    source = cartan_testing.read_off("armadillo")
    transfer = vtkCoatingTransfer()
    transfer.SetInputData(source)
    transfer.SetSourceData(source)
    transfer.SetCorrespondenceToPointId()
    transfer.SetSmoothing(16.0)
    transfer.Update()
    base = vtkPolyData()
    base.DeepCopy(transfer.GetBase())
    transfer.SetInputData(base)
    transfer.SetSmoothSourceData(base)
    panels = [Panel("the base", f"{source.GetNumberOfPoints():,} points", with_handles(base))]
    for strength, title in ((1.0, "coated"), (2.0, "twice as high"), (3.0, "three times")):
        transfer.SetStrength(strength)
        transfer.Update()
        panels.append(Panel(title, "", with_handles(transfer.GetOutput())))
    print("The coating of the armadillo: %.2g high (root mean square)" % transfer.GetCoatingRMS())
    return row("The armadillo's coating", panels, (0.3, 0.15, -1), (0, 1, 0))


def main(build):
    folder = os.path.join(build, "demo")
    os.makedirs(folder, exist_ok=True)
    write_sheet(one_below_the_other([head_on_dinosaur(), transition(), branches(), coating()]),
                folder, "merge")


if __name__ == "__main__":
    main(sys.argv[1])
