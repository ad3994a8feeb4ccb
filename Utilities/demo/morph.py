# SPDX-License-Identifier: BSD-3-Clause
"""Morphs between two surfaces by each method of the ParaView plugin's Surface Morph:
bars, the scanned camel and strips. Run by Utilities/demo.sh in pvpython after
demo.py, which poses the camel; the argument is the build folder. For each case,
the folder demo/morph gets a sheet of in-betweens (<case>.png), an animation with all
methods side by side (<case>.avi) and its pictures (<case>/*.png); morph.png is a sheet
of the most telling ones."""
import glob
import math
import os
import statistics
import sys
from dataclasses import dataclass

import numpy
from paraview import servermanager
from paraview.simple import *
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkImagingCore import vtkExtractVOI, vtkImageTranslateExtent
from vtkmodules.vtkIOImage import vtkPNGReader, vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPolyDataWriter

from demo import new_view
from gallery import percent, turned
from pictures import (FREE, HANDLE_COLORS, INK, PINNED, camera_for, one_below_the_other,
                      side_by_side, strip, text_actor, with_held_triangles, write, write_sheet)
from plugin import load_plugin
from poses import CAMEL
from tableone import cartan_testing, mark_ends, mark_parts, points_of, triangles_of, volume

METHODS = ("Discrete Forms", "Isometric", "Deformation Gradient", "Linear")
EDGES = (0.55, 0.52, 0.47)
# The animation has so many steps, the sheets every third of them.
STEPS, COLUMNS = 24, 9
FRAMES_PER_SECOND = 12
WIDTH, LABEL, NOTE = 480, 340, 100
# Of a view in the animation belongs to its title, at the top, in pixels.
TITLE = 50
X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)


@dataclass
class Case:
    """Two key frames, the height of a picture, where the camera is, the colors of
    handles (none: two of the sides), and the methods that the sheet of all cases
    shows."""
    name: str
    title: str
    first: object
    last: object
    height: int
    view_from: tuple
    view_up: tuple
    colors: list
    told: tuple = ("Discrete Forms", "Linear")


def moved(surface, points):
    """The surface with its points elsewhere."""
    result = cartan_testing.surface(points, triangles_of(surface))
    result.GetPointData().AddArray(surface.GetPointData().GetArray("Handle"))
    return result


def bent_bar():
    rest = mark_ends(cartan_testing.bar(12, 12, 96, 1, 1, 8), 2, 0.125, 0.875)
    return Case("bend", "A bar bent by 170\u00b0", rest, turned(rest, Y, 170, "NeutralOffset"),
                300, (0.25, -1, 0.25), X, [FREE, PINNED, HANDLE_COLORS[0]])


def twisted_bar():
    """Turned evenly about its middle line from one end to the other."""
    length = 8
    rest = mark_ends(cartan_testing.bar(16, 16, 128, 1, 1, length), 2, 0.125, 0.875)
    x, y, z = points_of(rest).T
    x, y, angle = x - 0.5, y - 0.5, math.radians(540) * z / length
    twisted = numpy.stack([0.5 + numpy.cos(angle) * x - numpy.sin(angle) * y,
                           0.5 + numpy.sin(angle) * x + numpy.cos(angle) * y, z], axis=1)
    return Case("twist", "A bar twisted by 540\u00b0", rest, moved(rest, twisted), 180,
                (0.15, -1, 0.3), X, [FREE, PINNED, HANDLE_COLORS[0]],
                ("Discrete Forms", "Deformation Gradient", "Linear"))


def posed_camel(folder):
    """Both as demo.py left them."""
    surfaces = []
    for name in ("before", "after"):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(os.path.join(folder, f"{CAMEL.mesh}-{name}.vtp"))
        reader.Update()
        surfaces.append(reader.GetOutput())
    first, last = surfaces
    first.GetPointData().AddArray(last.GetPointData().GetArray("Handle"))
    moving = iter(HANDLE_COLORS)
    colors = [FREE] + [next(moving) if handle.joints else PINNED for handle in CAMEL.handles]
    return Case("camel", "The demo\u2019s camel, from rest to its pose", first, last, 400,
                CAMEL.view_from, CAMEL.view_up, colors)


def ribbon(curve, width):
    """A strip of triangles as wide as that along z, over an n x 2 polygon."""
    count = len(curve)
    points = numpy.concatenate([numpy.insert(curve, 2, z, axis=1)
                                for z in (-width / 2, width / 2)])
    left = numpy.arange(count - 1)
    right = left + count
    # Their front is on the left of the polygon.
    triangles = numpy.concatenate([numpy.stack([left, right + 1, left + 1], -1),
                                   numpy.stack([left, right, right + 1], -1)])
    part = numpy.tile(numpy.linspace(0, 1, count), 2)
    return mark_parts(cartan_testing.surface(points, triangles), part, -1, 2)


def waves():
    """The example of Bose, O'Rourke, Shu and Wuhrer, Isometric Morphing of Triangular
    Meshes (2008), figures 2 and 3."""
    x = numpy.linspace(0, 4 * math.pi, 49)
    first, last = (ribbon(numpy.stack([x, sign * numpy.sin(x)], axis=1), 3) for sign in (1, -1))
    return Case("wave", "A ribbon from y = sin x to y = \u2212sin x", first, last, 200,
                (0.35, 0.55, 1), Y, None, ("Isometric", "Linear"))


def rolled_ribbon():
    """Two turns of a spiral of the radius inner + growth * angle, in steps of the same
    length, so that no length changes."""
    inner, growth, total = 0.5, 0.12, 4 * math.pi
    length = inner * total + growth * total**2 / 2
    count = 65
    step = length / (count - 1)
    middles = (numpy.arange(count - 1) + 0.5) * step
    angles = (numpy.sqrt(inner**2 + 2 * growth * middles) - inner) / growth
    rolled, flat = ([[0, 0]] + [(step * math.cos(angle), step * math.sin(angle))
                                for angle in directions]
                    for directions in (angles, 0 * angles))
    first, last = (ribbon(numpy.cumsum(steps, axis=0), 3.5) for steps in (flat, rolled))
    return Case("roll", "A ribbon rolled up in two turns", first, last, 230, (0.9, 0.55, 1), Y,
                None, ("Isometric", "Linear"))


def edge_lengths(surface):
    corners = triangles_of(surface)
    edges = numpy.unique(numpy.sort(corners[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1),
                         axis=0)
    first, second = points_of(surface)[edges].swapaxes(0, 1)
    return numpy.linalg.norm(second - first, axis=1)


@dataclass
class Measured:
    """The in-betweens of a method: relative deviations, at each of the sheet's times,
    of the volume (None where open) and, rms, of the edge lengths from those linear
    between the key frames'; seconds for an in-between; iterations; all points."""
    volumes: list
    edges: list
    seconds: float
    iterations: int
    points: object


def measure(case, morph):
    keys = [(volume(surface), edge_lengths(surface)) for surface in (case.first, case.last)]
    # What is open has no volume.
    closed = triangles_of(case.first).size == 2 * len(keys[0][1])
    volumes, edges, seconds, iterations, points = [], [], [], [], []
    for t in numpy.linspace(0, 1, COLUMNS):
        morph.UpdatePipeline(t)
        morph.UpdatePropertyInformation()
        surface = servermanager.Fetch(morph)
        volume_now, edges_now = ((1 - t) * a + t * b for a, b in zip(*keys))
        volumes.append(volume(surface) / volume_now - 1 if closed else None)
        edges.append(math.sqrt(numpy.mean((edge_lengths(surface) / edges_now - 1)**2)))
        points.append(points_of(surface))
        # The key frames are there already.
        if 0 < t < 1:
            seconds.append(morph.GetProperty("EvaluationTime").GetData())
            iterations.append(morph.GetProperty("NumberOfIterations").GetData())
    return Measured(volumes if closed else None, edges, statistics.median(seconds),
                    max(iterations), numpy.concatenate(points))


def key_frame(surface, path):
    """A reader of the surface, from a file, without what says more than colors."""
    held = with_held_triangles(surface)
    bare = vtkPolyData()
    bare.CopyStructure(held)
    bare.GetCellData().AddArray(held.GetCellData().GetArray("Handle"))
    bare.GetPointData().SetNormals(surface.GetPointData().GetNormals())
    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(bare)
    writer.SetFileName(path)
    # ParaView's reader and some versions of libexpat disagree on appended data.
    writer.SetDataModeToBinary()
    writer.Write()
    return XMLPolyDataReader(FileName=[path])


def show(case, morph, view, method):
    shown = Show(morph, view)
    shown.Representation = "Surface"
    shown.Specular = 0.15
    if case.colors:
        ColorBy(shown, ("CELLS", "Handle"), separate=True)
        table = GetColorTransferFunction("Handle", shown, separate=True)
        table.InterpretValuesAsCategories = 1
        table.Annotations = [text for value in range(len(case.colors)) for text in 2 * [str(value)]]
        table.IndexedColors = [part for color in case.colors for part in color]
    else:
        # A ribbon: what is in front, what behind, and its triangles.
        shown.Representation, shown.EdgeColor = "Surface With Edges", EDGES
        shown.DiffuseColor, shown.AmbientColor = FREE, FREE
        shown.BackfaceRepresentation = "Surface With Edges"
        shown.BackfaceDiffuseColor = shown.BackfaceAmbientColor = HANDLE_COLORS[0]
    title = AnnotateTimeFilter(Input=morph, Format=method + ", t = {time:0.2f}")
    label = Show(title, view)
    label.Color, label.FontSize, label.WindowLocation = INK, 20, "Upper Center"
    return title


def animate(case, morphs, camera, folder):
    """Plays the morphs in views side by side into an AVI and pictures, whose paths
    are returned."""
    layout = CreateLayout(case.title)
    layout.SplitHorizontal(0, 0.5)
    layout.SplitVertical(1, 0.5)
    layout.SplitVertical(2, 0.5)
    titles = []
    for (method, morph), cell in zip(morphs.items(), (3, 5, 4, 6)):
        view = new_view(camera)
        view.UseFXAA = 1
        # More from the front than by default: bars are seen from the side.
        view.KeyLightElevation, view.KeyLightWarmth = 35, 0.55
        AssignViewToLayout(view=view, layout=layout, hint=cell)
        titles.append(show(case, morph, view, method))
    size = (2 * WIDTH, 2 * (case.height + TITLE))
    layout.SetSize(*size)
    scene = GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.PlayMode = "Snap To TimeSteps"
    pictures = os.path.join(folder, case.name)
    os.makedirs(pictures, exist_ok=True)
    for old in glob.glob(os.path.join(pictures, "*.png")):
        os.remove(old)
    # The second time, nothing has to be found again.
    GetSettingsProxy("GeneralSettings").CacheGeometryForAnimation = 1
    for path in (os.path.join(pictures, "frame.png"), os.path.join(folder, case.name + ".avi")):
        SaveAnimation(path, layout, ImageResolution=size, SeparatorWidth=0,
                      SeparatorColor=(1, 1, 1), FrameRate=FRAMES_PER_SECOND)
    # What stays would be drawn with the next case.
    RemoveViewsAndLayouts()
    for source in (*titles, *morphs.values()):
        Delete(source)
    return sorted(glob.glob(os.path.join(pictures, "*.png")))


def panels(case, pictures):
    """The views in the pictures of the sheet's times, without their titles: a list for
    each method."""
    result = [[] for _ in METHODS]
    for picture in pictures[::STEPS // (COLUMNS - 1)]:
        reader = vtkPNGReader()
        reader.SetFileName(picture)
        for number, row in enumerate(result):
            left = number % 2 * WIDTH
            bottom = (1 - number // 2) * (case.height + TITLE)
            crop = vtkExtractVOI()
            crop.SetInputConnection(reader.GetOutputPort())
            crop.SetVOI(left, left + WIDTH - 1, bottom, bottom + case.height - 1, 0, 0)
            # To the origin, as what it is joined with.
            shift = vtkImageTranslateExtent()
            shift.SetInputConnection(crop.GetOutputPort())
            shift.SetTranslation(-left, -bottom, 0)
            shift.Update()
            row.append(shift.GetOutput())
    return result


def note(measured, column):
    text = f"edges {100 * measured.edges[column]:.1f} %"
    if measured.volumes:
        text = f"volume {percent(measured.volumes[column])}\n{text}"
    return strip((WIDTH, NOTE), text_actor(text, 66, (0.5, 0.95), "Top"))


def words(text, size):
    return strip(size, text_actor(text, 76, (0.5, 0.5), "Centered", bold=True))


def row_of(case, method, pictures, measured, columns):
    label = words(method.replace(" ", "\n"), (LABEL, case.height + NOTE))
    return side_by_side([label] + [
        one_below_the_other([pictures[column], note(measured, column)]) for column in columns])


def times(columns):
    """What stands over the columns of a sheet."""
    texts = [""] + [f"t = {column / (COLUMNS - 1):.3g}" for column in columns]
    return side_by_side([words(text, (WIDTH if text else LABEL, 60)) for text in texts])


def run(case, folder):
    """Measures, animates and draws a case: what was measured, and its rows of the
    sheet of all cases."""
    first, last = (key_frame(surface, os.path.join(folder, f"{case.name}-{end}.vtp"))
                   for end, surface in (("first", case.first), ("last", case.last)))
    morphs = {method: SurfaceMorph(registrationName=f"{case.name}: {method}", Input=[first, last],
                                   Method=method, StepsBetweenKeyFrames=STEPS)
              for method in METHODS}
    measured = {method: measure(case, morph) for method, morph in morphs.items()}
    size = (WIDTH, case.height + TITLE)
    points = numpy.concatenate([result.points for result in measured.values()])
    camera = camera_for(case.view_from, case.view_up, points, size, 0.02, TITLE / size[1])
    pictures = dict(zip(METHODS, panels(case, animate(case, morphs, camera, folder))))

    columns = range(COLUMNS)
    sheet = [words(case.title, (LABEL + COLUMNS * WIDTH, 110)), times(columns)]
    sheet += [row_of(case, method, pictures[method], measured[method], columns)
              for method in METHODS]
    write(vtkPNGWriter(), one_below_the_other(sheet), os.path.join(folder, case.name + ".png"))
    few = range(0, COLUMNS, 2)
    return measured, [words(case.title, (LABEL + len(few) * WIDTH, 110))] + [
        row_of(case, method, pictures[method], measured[method], few) for method in case.told]


def worst(values):
    return max(values, key=abs)


def main(build):
    demo = os.path.join(build, "demo")
    folder = os.path.join(demo, "morph")
    os.makedirs(folder, exist_ok=True)
    load_plugin(build, globals())
    sheet = [times(range(0, COLUMNS, 2))]
    print(f"\n{'':38}{'points':>8}{'volume':>10}{'edges':>9}{'time':>8}{'iterations':>12}")
    for case in (bent_bar(), twisted_bar(), posed_camel(demo), waves(), rolled_ribbon()):
        measured, rows = run(case, folder)
        sheet += rows
        print(f"{case.title:38}{case.first.GetNumberOfPoints():8,}")
        for method, result in measured.items():
            change = percent(worst(result.volumes)) if result.volumes else "open"
            time = result.seconds / measured["Linear"].seconds
            print(f"  {method:44}{change:>10}{100 * max(result.edges):7.2f} %{time:8.1f}"
                  f"{result.iterations:12}", flush=True)
    print("volume, edges: the largest deviation, over time, from what is linear between the key\n"
          "frames (edges: rms); time: of an in-between, over that of Linear\n")
    print(f"Sheets, animations and their pictures are in {folder}")
    write_sheet(one_below_the_other(sheet), folder, "morph", quality=88)


if __name__ == "__main__":
    main(sys.argv[1])
