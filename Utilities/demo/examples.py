# SPDX-License-Identifier: BSD-3-Clause
"""Ways to say what is wanted: the inside of a body that holds it together, example poses, curves
on surfaces, and landmarks; what is near a surface follows it, and tetrahedra follow their skin; the
strain of a morph. Run by Utilities/demo.sh --examples
in pvpython; the argument is the build folder. examples.png, a sheet of all, appears in its folder
demo; what was measured is printed."""
import os
import sys

import numpy
from vtkcartan import (vtkAsRigidAsPossibleDeformation, vtkCarryAlong, vtkCurveDeformation,
                       vtkExampleBasedDeformation, vtkHandleMotion, vtkLandmarkHandles,
                       vtkPoissonDeformation, vtkShapePreservingDeformation, vtkVolumeChange,
                       vtkVolumetricDeformation)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkCommonTransforms import vtkThinPlateSplineTransform
from vtkmodules.vtkFiltersCore import vtkAppendPolyData, vtkGlyph3D
from vtkmodules.vtkFiltersGeneral import vtkTransformPolyDataFilter
from vtkmodules.vtkFiltersSources import vtkPointSource, vtkSphereSource

import cartan_testing
import solids
from pictures import Panel, camera_for, draw, heading, one_below_the_other, side_by_side, write_sheet
from tableone import mark_ends, mark_parts, points_of

SIZE, HEADING = (700, 620), 60
X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)


def copied(surface, handles):
    """A copy with the array Handle, which colors panels."""
    result = vtkPolyData()
    result.DeepCopy(surface)
    array = numpy_to_vtk(numpy.ascontiguousarray(handles, dtype=numpy.int32), deep=True)
    array.SetName("Handle")
    result.GetPointData().AddArray(array)
    return result


def plain(surface):
    return copied(surface, numpy.zeros(surface.GetNumberOfPoints()))


def turned(axis, angle, center=(0, 0, 0), translation=(0, 0, 0)):
    motion = vtkHandleMotion()
    motion.SetAxis(*axis)
    motion.SetAngle(angle)
    motion.SetCenter(*center)
    motion.SetTranslation(*translation)
    return motion


def deformed(method, surface, motions, **settings):
    """The filter, updated, with motions by handle."""
    filter = method()
    filter.SetInputData(surface)
    for handle, motion in motions.items():
        filter.SetHandleMotion(handle, motion)
    for name, value in settings.items():
        getattr(filter, "Set" + name)(value)
    filter.Update()
    return filter


def changes(surface, rest):
    """Volume Change, updated."""
    change = vtkVolumeChange()
    change.SetInputData(surface)
    change.SetReferenceData(rest)
    change.ComputeLocalVolumeOff()
    change.Update()
    return change


def relative_volume(surface, rest):
    table = changes(surface, rest).GetChangeTable()
    names = [table.GetValueByName(i, "Quantity").ToString()
             for i in range(table.GetNumberOfRows())]
    return table.GetValueByName(names.index("Volume"), "RelativeChange").ToDouble()


def row(title, panels, views):
    """The panels under a heading, each seen from its own side."""
    pictures = [draw(panel, camera_for(*view, points_of(panel.surface), SIZE, 0.1, 0.1), SIZE)
                for panel, view in zip(panels, views)]
    return one_below_the_other(
        [heading(title, (len(panels) * SIZE[0], HEADING)), side_by_side(pictures)])


def rolled(length, degrees, middle, start):
    """What the end of a bar along z makes when a length of it, from z = start on, becomes an arc
    towards +x about x = middle."""
    angle = numpy.radians(degrees)
    center = (middle + length / angle, 0, start)
    return turned(Y, degrees, center, (-length * numpy.sin(angle), 0, -length * numpy.cos(angle)))


def bodies():
    """The same rotations on the surface alone and through the inside."""
    print("Change of volume")
    panels = []
    bar = mark_ends(cartan_testing.bar(10, 10, 60, 1, 1, 6), 2, 0.1, 0.9)
    bull = mark_ends(cartan_testing.read_off("bull"), 0, 0.2, 0.8)
    for surface, name, motion in (
            (bar, "a bar bent by 170 degrees", rolled(4.8, 170, 0.5, 0.6)),
            (bull, "a bull turned by 69 degrees", turned(X, 69))):
        for method, how in ((vtkPoissonDeformation, "the surface alone"),
                            (vtkVolumetricDeformation, "with its inside")):
            result = deformed(method, surface, {2: motion}).GetOutput()
            volume = relative_volume(result, surface)
            print("  %-32s%-20s%+.1f %%" % (name, how, 100 * volume))
            panels.append(Panel(name, "%s: volume %+.1f %%" % (how, 100 * volume), result))
    side = ((0.3, -1, 0.3), Z)
    front = ((-0.3, 0.25, 1), Y)
    return row("The inside of a body", panels, (side, side, front, front))


# Of the camel: a box for each part.
PARTS = {1: ((-0.2, 0.05, -0.36), (0.2, 0.5, 0.1)), 2: ((-0.2, 0.40, 0.36), (0.2, 0.55, 0.55)),
         3: ((0.0, -0.5, 0.0), (0.2, -0.29, 0.2)), 4: ((0.0, -0.19, 0.0), (0.2, -0.12, 0.2))}
KNEE, HIP = (0.05, -0.235, 0.045), (0.05, 0.0, 0.06)


def camel(parts):
    surface = cartan_testing.read_off("camel")
    points = points_of(surface)
    handles = numpy.zeros(len(points))
    # The other legs stand.
    handles[(points[:, 1] < -0.3) & ((points[:, 0] < 0) | (points[:, 2] < -0.1))] = 1
    for part in parts:
        low, high = (numpy.array(corner) for corner in PARTS[part])
        handles[((points >= low) & (points <= high)).all(axis=1)] = part
    return copied(surface, handles)


def rotation(axis, degrees, center):
    """A 4 x 4 matrix."""
    angle = numpy.radians(degrees)
    cross = numpy.cross(numpy.eye(3), numpy.array(axis, float))
    result = numpy.eye(4)
    result[:3, :3] += numpy.sin(angle) * cross + (1 - numpy.cos(angle)) * cross @ cross
    result[:3, 3] = center - result[:3, :3] @ center
    return result


def by_matrix(matrix):
    motion = vtkHandleMotion()
    motion.SetModeToMatrix()
    motion.SetMatrixElements(matrix.ravel().tolist())
    return motion


def pose(neck_down, neck_side, lift):
    """Motions of head, knee and foot for parts of a full pose."""
    neck = rotation(X, 60 * neck_down, (0, 0.2, 0.25)) @ rotation(Y, 70 * neck_side, (0, 0.2, 0.25))
    knee = rotation(X, -65 * lift, HIP)
    return {2: by_matrix(neck), 4: by_matrix(knee),
            3: by_matrix(knee @ rotation(X, 105 * lift, KNEE))}


def poses():
    """Five examples made with a handle at each joint, and a drag by two handles only."""
    rest = camel((1, 2, 3, 4))
    examples = [deformed(vtkShapePreservingDeformation, rest, pose(*parts)).GetOutput()
                for parts in ((1, 0, 0), (-0.4, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1))]
    drag = pose(0.5, 0.5, 0.8)
    del drag[4]
    handles = camel((1, 2, 3))
    posed = vtkExampleBasedDeformation()
    for example in examples:
        posed.AddExampleData(example)
    posed.SetInputData(handles)
    for handle, motion in drag.items():
        posed.SetHandleMotion(handle, motion)
    posed.Update()
    weights = posed.GetExampleWeights()
    weights = [weights.GetValue(i) for i in range(weights.GetNumberOfTuples())]
    print("Weights of five example poses: " + " ".join("%.2f" % weight for weight in weights))
    alone = deformed(vtkShapePreservingDeformation, handles, drag).GetOutput()
    panels = [Panel("an example: the neck", "", examples[0]),
              Panel("an example: the knee", "", examples[4]),
              Panel("head and foot dragged", "with five examples", posed.GetOutput()),
              Panel("head and foot dragged", "without examples", alone)]
    return row("Example poses", panels, [((1, 0.12, 0.25), Y)] * 4)


def polyline(points):
    locations = vtkPoints()
    locations.SetData(numpy_to_vtk(numpy.ascontiguousarray(points, dtype=float), deep=True))
    lines = vtkCellArray()
    lines.InsertNextCell(len(points), list(range(len(points))))
    result = vtkPolyData()
    result.SetPoints(locations)
    result.SetLines(lines)
    return result


def back_of(points, first, last):
    """The top of a camel's back in its plane of symmetry, between two places along it."""
    near = points[abs(points[:, 0]) < 0.02]
    line = []
    for z in numpy.linspace(first, last, 60):
        beside = near[abs(near[:, 2] - z) < 0.02]
        line.append((0, beside[:, 1].max(), z))
    return numpy.array(line)


def sketched(surface, start, end, target=None, **settings):
    curve = vtkCurveDeformation()
    curve.SetInputData(surface)
    if target is not None:
        curve.SetTargetData(target)
    curve.SetPointId(0, surface.FindPoint(*start))
    curve.SetPointId(1, surface.FindPoint(*end))
    for name, value in settings.items():
        getattr(curve, "Set" + name)(value)
    curve.Update()
    return curve.GetOutput()


def curves():
    """A camel's outline from the side, whose back is drawn anew with two humps, and ridges along
    its side."""
    rest = cartan_testing.read_off("camel")
    back = back_of(points_of(rest), 0.1, -0.38)
    drawn = back.copy()
    places = back[:, 2]
    parts = (places - places[0]) / (places[-1] - places[0])
    drawn[:, 1] = (1 - parts) * back[0, 1] + parts * back[-1, 1]
    for hump in (0.3, 0.75):
        drawn[:, 1] += 0.16 * numpy.exp(-((parts - hump) / 0.12) ** 2) * numpy.sin(
            numpy.pi * parts) ** 0.5
    side = (0.16, 0.12, 0.08), (0.16, 0.12, -0.33)
    panels = [
        Panel("a scan", f"{rest.GetNumberOfPoints():,} points", plain(rest)),
        Panel("its outline redrawn", "", plain(sketched(
            rest, back[0], back[-1], polyline(drawn), Reach=0.3,
            Source=vtkCurveDeformation.SILHOUETTE, ViewDirection=(-1, 0, 0)))),
        Panel("a ridge along a path", "", plain(sketched(
            rest, *side, RidgeHeight=0.025, RidgeWidth=0.05))),
        Panel("a sharp ravine", "", plain(sketched(
            rest, *side, RidgeHeight=-0.025, RidgeWidth=0.05, SharpRidge=True)))]
    return row("Curves on a surface", panels, [((1, 0.3, 0.35), Y)] * 4)


def bent_space(points):
    """A smooth motion of space."""
    x, y, z = (points - points.mean(axis=0)).T
    return points + numpy.stack([0.5 * z * z * numpy.sign(z), -0.35 * z * z, 0.15 * y * z], axis=1)


def cloud(points):
    result = vtkPolyData()
    locations = vtkPoints()
    locations.SetData(numpy_to_vtk(numpy.ascontiguousarray(points, dtype=float), deep=True))
    result.SetPoints(locations)
    return result


def strain(surface, rest, title, note):
    """A panel that shows how much longer than before the longest direction is."""
    change = changes(surface, rest)
    output = change.GetOutput()
    stretch = vtk_to_numpy(output.GetPointData().GetArray("Stretch1")) - 1
    array = numpy_to_vtk(numpy.ascontiguousarray(stretch), deep=True)
    array.SetName("Strain")
    shown = plain(output)
    shown.GetPointData().AddArray(array)
    print("  %-36sedges %.3f (root mean square)" % (title, change.GetEdgeLengthRMS()))
    return Panel(title, note + "edges %.1f %%" % (100 * change.GetEdgeLengthRMS()), shown,
                 "Strain", 0.3)


def landmarks():
    """Thirty landmarks, a spline of the same ones, and points that follow."""
    rest = cartan_testing.read_off("camel")
    points = points_of(rest)
    chosen = numpy.random.default_rng(1).permutation(len(points))[:30]
    start, goal = points[chosen], bent_space(points)[chosen]
    marked = vtkLandmarkHandles()
    marked.SetInputData(rest)
    marked.SetFromData(cloud(start))
    marked.SetToData(cloud(goal))
    marked.Update()
    method = vtkAsRigidAsPossibleDeformation()
    method.SetInputConnection(marked.GetOutputPort())
    method.SetTargetPositionArrayName("TargetPosition")
    method.Update()
    transform = vtkThinPlateSplineTransform()
    transform.SetSourceLandmarks(cloud(start).GetPoints())
    transform.SetTargetLandmarks(cloud(goal).GetPoints())
    transform.SetBasisToR()
    spline = vtkTransformPolyDataFilter()
    spline.SetInputData(rest)
    spline.SetTransform(transform)
    spline.Update()
    print("Thirty landmarks")
    around = vtkPointSource()
    around.SetCenter(0.0, 0.42, 0.42)
    around.SetRadius(0.17)
    around.SetNumberOfPoints(150)
    followed = vtkCarryAlong()
    followed.SetInputConnection(around.GetOutputPort())
    handles = camel((1, 2))
    bent = deformed(vtkShapePreservingDeformation, handles,
                    {2: by_matrix(rotation(X, 50, (0, 0.2, 0.25)))}).GetOutput()
    followed.SetRestData(handles)
    followed.SetDeformedData(bent)
    followed.Update()
    around.Update()
    panels = [strain(method.GetOutput(), rest, "thirty landmarks", "as rigid as possible: "),
              strain(spline.GetOutput(), rest, "the same landmarks", "a thin-plate spline: "),
              Panel("points near a head", "", with_points(handles, around.GetOutput())),
              Panel("follow it", "", with_points(bent, followed.GetOutput()))]
    return row("Landmarks, and what follows", panels, [((1, 0.12, 0.25), Y)] * 4)


def with_points(surface, points):
    """The surface and small balls at points."""
    ball = vtkSphereSource()
    ball.SetRadius(0.008)
    balls = vtkGlyph3D()
    balls.SetInputData(cloud(points_of(points)))
    balls.SetSourceConnection(ball.GetOutputPort())
    balls.ScalingOff()
    balls.Update()
    count = balls.GetOutput().GetNumberOfPoints()
    both = vtkAppendPolyData()
    both.AddInputData(plain(surface))
    both.AddInputData(copied(balls.GetOutput(), numpy.full(count, 2)))
    both.Update()
    return both.GetOutput()


def tetrahedra():
    above, along = ((0.1, -0.8, 0.8), Z), ((0.1, -1, 0.35), Z)
    return row("Tetrahedra follow their skin", solids.solids(), (above, along, above, along))


def strains():
    """Of a morph of the camel to a pose."""
    rest = camel((1, 2, 3, 4))
    last = deformed(vtkShapePreservingDeformation, rest, pose(1.2, -0.6, 1)).GetOutput()
    return row("Strain of a morph", solids.strains(rest, last), [((1, 0.12, 0.25), Y)] * 4)


def main(build):
    folder = os.path.join(build, "demo")
    os.makedirs(folder, exist_ok=True)
    rows = [bodies(), tetrahedra(), poses(), curves(), landmarks(), strains()]
    write_sheet(one_below_the_other(rows), folder, "examples")


if __name__ == "__main__":
    main(sys.argv[1])
