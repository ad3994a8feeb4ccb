# SPDX-License-Identifier: BSD-3-Clause
"""Sews a scanned head onto a dinosaur, wherever it comes from and where it is placed, tubes with
reliefs that fade into each other, and a ball between four tubes; takes the coating off a scan, and
puts it on again and on another one.
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
                                       vtkMassProperties, vtkPolyDataConnectivityFilter,
                                       vtkTriangleFilter)
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


def triangles_of(surface):
    return vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def above(surface, height):
    """The points above a height, for cameras that look at these."""
    points = points_of(surface)
    return points[points[:, 2] > height]


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
    triangles = triangles_of(surface)
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


def edge_change(source, output):
    """Root mean square change of the source's edges in the output beside their mean: of those
    whose ends are not on the seam."""
    data = output.GetPointData()
    kept = vtk_to_numpy(data.GetArray("MergeOrigin")) == 1
    places = numpy.full((source.GetNumberOfPoints(), 3), numpy.nan)
    places[vtk_to_numpy(data.GetArray("OriginalPointIds"))[kept]] = points_of(output)[kept]
    corners = triangles_of(source)
    edges = numpy.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    before, after = (numpy.linalg.norm(p[edges[:, 1]] - p[edges[:, 0]], axis=1)
                     for p in (points_of(source), places))
    ratios = (after / before)[~numpy.isnan(after)]
    return numpy.sqrt(numpy.mean((ratios / ratios.mean() - 1) ** 2))


def volume(surface):
    """As text; "open" where a surface encloses none."""
    if len(boundary_points(surface)):
        return "open"
    measures = vtkMassProperties()
    measures.SetInputData(surface)
    return "%.3g" % measures.GetVolume()


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
    print("  | %s | %s | %.1f | %.1f | %.3f | %s | %.2f |" % (
        title, format(output.GetNumberOfPoints(), ","), merge.GetSeamAngleMean(),
        merge.GetSeamAngleMaximum(), edge_change(source, output), volume(output), seconds))
    origins = vtk_to_numpy(output.GetPointData().GetArray("MergeOrigin"))
    return Panel(title, angles, with_handles(output, numpy.where(origins == 1, 2, 0)))


def row(title, panels, view_from, view_up, focus=None):
    """The panels under a heading; `focus` are the points that the picture shows."""
    cameras = [camera_for(view_from, view_up, points_of(p.surface) if focus is None else focus,
                          SIZE, 0.1, 0.1) for p in panels]
    pictures = [draw(p, camera, SIZE) for p, camera in zip(panels, cameras)]
    return one_below_the_other(
        [heading(title, (len(panels) * SIZE[0], HEADING)), side_by_side(pictures)])


def head_and_dinosaur():
    """Both with their keys."""
    head = cut(cartan_testing.read_off("mannequin-devil"), (0, 0, -15), (0, 0, 1))
    dinosaur = cut(cartan_testing.read_off("dino"), (0, -.9, .9), (0, .45, -1))
    set_keys(head, [key[0] for key in KEYS])
    set_keys(dinosaur, [key[1] for key in KEYS])
    return head, dinosaur


def head_on_dinosaur():
    head, dinosaur = head_and_dinosaur()
    whole = merged("sewn together", dinosaur, head)
    faired = merged("seam and two rings smooth", dinosaur, head, SeamFairing=2)
    blended = merged("details blended, two rings", dinosaur, head, SeamFairing=2,
                     FairingMethod=vtkMeshMerge.DELTA_BLEND)
    faded = merged("transplanted: a transition of .1", dinosaur, head, TransitionWidth=0.1)
    return row("A head on a dinosaur, wherever it comes from", [whole, faired, blended, faded],
               (1, -0.4, 0.35), (0, 0, 1), above(whole.surface, 0.85))


def similarity(before, after):
    """Scale, rotation and shift that take points closest to others."""
    middle, goal = before.mean(axis=0), after.mean(axis=0)
    left, stretches, right = numpy.linalg.svd((after - goal).T @ (before - middle))
    signs = numpy.array([1, 1, numpy.sign(numpy.linalg.det(left @ right))])
    scale = (stretches * signs).sum() / ((before - middle) ** 2).sum()
    rotation = left @ numpy.diag(signs) @ right
    return scale, rotation, goal - scale * rotation @ middle


def placed_head(head, dinosaur):
    """The head where it fits on the dinosaur, but larger, turned to the side and lifted, its
    upper part marked as a handle."""
    merge = vtkMeshMerge()
    merge.SetInputData(dinosaur)
    merge.SetSourceData(head)
    merge.Update()
    data = merge.GetOutput().GetPointData()
    kept = vtk_to_numpy(data.GetArray("MergeOrigin")) == 1
    ids = vtk_to_numpy(data.GetArray("OriginalPointIds"))[kept]
    scale, rotation, shift = similarity(points_of(head)[ids], points_of(merge.GetOutput())[kept])
    fitted = scale * points_of(head) @ rotation.T + shift
    loop = fitted[boundary_points(head)].mean(axis=0)
    up = rotation[:, 2]
    angle = numpy.radians(35)
    cross = numpy.cross(up, numpy.eye(3)).T
    turn = numpy.eye(3) + numpy.sin(angle) * cross + (1 - numpy.cos(angle)) * cross @ cross
    result = with_handles(head, numpy.where(points_of(head)[:, 2] > -4, 1, 0))
    places = vtkPoints()
    places.SetData(numpy_to_vtk(
        loop + 1.35 * (fitted - loop) @ turn.T + 0.12 * up, deep=True))
    result.SetPoints(places)
    return result


def configurations():
    """The same head and place, which counts or not."""
    head, dinosaur = head_and_dinosaur()
    placed = placed_head(head, dinosaur)
    count = dinosaur.GetNumberOfPoints()
    together = surface_of(
        numpy.concatenate([points_of(dinosaur), points_of(placed)]),
        numpy.concatenate([triangles_of(dinosaur), count + triangles_of(placed)]))
    together = with_handles(
        together, numpy.where(numpy.arange(together.GetNumberOfPoints()) < count, 0, 2))
    dependent = {"Configuration": vtkMeshMerge.DEPENDENT}
    panels = [Panel("before", "larger, turned, lifted", together),
              merged("independent", dinosaur, placed),
              merged("dependent: the face is held", dinosaur, placed, **dependent),
              merged("dependent, and smooth", dinosaur, placed, SeamFairing=2, **dependent)]
    return row("Whether the place of the source counts", panels, (1, -0.4, 0.35), (0, 0, 1),
               above(together, 0.85))


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
    triangles = triangles_of(clean.GetOutput())
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


def coating_of_another():
    """The armadillo's coating on a bear of another shape, size and connectivity."""
    source, target = cartan_testing.read_off("armadillo"), cartan_testing.read_off("bear")
    transfer = vtkCoatingTransfer()
    transfer.SetInputData(target)
    transfer.SetSourceData(source)
    transfer.SetSmoothing(16.0)
    panels = [Panel("source", f"{source.GetNumberOfPoints():,} points", with_handles(source)),
              Panel("target", f"{target.GetNumberOfPoints():,} points", with_handles(target))]
    for strength, title in ((1.0, "coated"), (2.0, "twice as high")):
        transfer.SetStrength(strength)
        transfer.Update()
        panels.append(Panel(title, "", with_handles(transfer.GetOutput())))
    return row("The armadillo's coating on a bear", panels, (0.3, 0.15, 1), (0, 1, 0))


def main(build):
    folder = os.path.join(build, "demo")
    os.makedirs(folder, exist_ok=True)
    print("  | | points | seam, mean | seam, largest | edges | volume | seconds |")
    write_sheet(one_below_the_other([head_on_dinosaur(), configurations(), transition(),
                                     branches(), coating(), coating_of_another()]),
                folder, "merge")


if __name__ == "__main__":
    main(sys.argv[1])
