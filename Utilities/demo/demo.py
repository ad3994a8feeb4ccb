# SPDX-License-Identifier: BSD-3-Clause
"""Marks, bends, colors and measures four scanned surfaces with the ParaView
plugin. Run by Utilities/demo.sh in pvpython; the argument is the build folder."""
import math
import os
import statistics
import sys

import numpy
from paraview import servermanager
from paraview.simple import *
from vtkmodules.numpy_interface.dataset_adapter import WrapDataObject
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

from cartan_testing import read_off
from pictures import DIFFERENCE, FREE, HANDLE_COLORS, PINNED, camera_for, write_overview
from plugin import load_plugin
from poses import POSES, Sphere

# From nothing to much.
AMOUNT = [FREE, (0.95, 0.66, 0.28), (0.80, 0.24, 0.26), (0.35, 0.05, 0.32)]
PANEL = (640, 720)
NUMBER_OF_MOTIONS = 9


def write_rest_surface(pose, path):
    """The scanned mesh as .vtp, with normals, which the deformation renews."""
    normals = vtkPolyDataNormals()
    normals.SetInputData(read_off(pose.mesh))
    normals.SplittingOff()
    normals.ConsistencyOff()
    writer = vtkXMLPolyDataWriter()
    writer.SetInputConnection(normals.GetOutputPort())
    writer.SetFileName(path)
    # ParaView's reader and some versions of libexpat disagree on appended data.
    writer.SetDataModeToBinary()
    writer.Write()


def mark(pose, surface):
    """A Mark Handle filter per region."""
    for handle_id, handle in enumerate(pose.handles, 1):
        for number, region in enumerate(handle.regions, 1):
            # States find filters by their names.
            part = f" {number}" if len(handle.regions) > 1 else ""
            surface = MarkHandle(registrationName=f"{pose.title}: {handle.name}{part}",
                                 Input=surface)
            surface.HandleId = handle_id
            if isinstance(region, Sphere):
                surface.Region = "Sphere"
                surface.Region.Center = region.center
                surface.Region.Radius = region.radius
            else:
                surface.Region = "Box"
                surface.Region.Position = region.low
                surface.Region.Length = numpy.subtract(region.high, region.low).tolist()
    return surface


def deform(pose, marked):
    """The first handle with joints by the panel's motion, the others by rows."""
    result = RotationInvariantDeformation(registrationName=f"{pose.title} deformed", Input=marked)
    result.GenerateFrameChange = 1
    rows = []
    motion = None
    for handle_id, handle in enumerate(pose.handles, 1):
        if not handle.joints:
            continue
        angle, axis, center, translation = handle.motion()
        if motion is None:
            result.ActiveHandle = handle_id
            result.Motion = "Axis and Angle"
            motion = result.Motion
            motion.Angle, motion.Axis = angle, axis
            motion.Center, motion.Translation = center, translation
        else:
            rows += [handle_id, 1, 1, 1, angle, *axis, *center, *translation]
    result.MotionRows = rows
    return result


def time_motions(deformed):
    """Seconds of the set-up, and the median of some motions after it."""
    def seconds(name):
        deformed.UpdatePipeline()
        deformed.UpdatePropertyInformation()
        return deformed.GetProperty(name).GetData()

    setup = seconds("SetupTime")
    angle = deformed.Motion.Angle
    motions = []
    for step in range(NUMBER_OF_MOTIONS):
        # A full swing and back to the pose, so that the last motion is the pose.
        part = abs(2 * step / (NUMBER_OF_MOTIONS - 1) - 1)
        deformed.Motion.Angle = angle * (0.5 + 0.5 * part)
        motions.append(seconds("MotionTime"))
    return setup, statistics.median(motions)


def nice(value):
    """The value rounded to one or two digits, for the end of a color bar."""
    digit = 10.0 ** math.floor(math.log10(value))
    return min((factor * digit for factor in (1, 1.5, 2, 3, 4, 5, 6, 8, 10)),
               key=lambda candidate: abs(candidate - value))


def new_view(camera):
    view = CreateView("RenderView")
    view.UseColorPaletteForBackground = 0
    view.BackgroundColorMode = "Single Color"
    view.Background = (1, 1, 1)
    view.OrientationAxesVisibility = 0
    view.CameraParallelProjection = 1
    focal, position, up, scale = camera
    view.CameraFocalPoint, view.CameraPosition = focal.tolist(), position.tolist()
    view.CameraViewUp, view.CameraParallelScale = up.tolist(), scale
    return view


def show(source, view):
    shown = Show(source, view)
    shown.Representation = "Surface"
    shown.Specular = 0.15
    return shown


def color_by_handle(shown, pose):
    ColorBy(shown, ("POINTS", "Handle"), separate=True)
    table = GetColorTransferFunction("Handle", shown, separate=True)
    names = ["free"] + [handle.name for handle in pose.handles]
    moving = iter(HANDLE_COLORS)
    colors = [FREE] + [next(moving) if handle.joints else PINNED for handle in pose.handles]
    table.InterpretValuesAsCategories = 1
    table.Annotations = [text for value, name in enumerate(names) for text in (str(value), name)]
    table.IndexedColors = [component for color in colors for component in color]


def color_by_field(shown, view, array, title, colors, low, high):
    ColorBy(shown, ("POINTS", array), separate=True)
    table = GetColorTransferFunction(array, shown, separate=True)
    table.AutomaticRescaleRangeMode = "Never"
    table.ColorSpace = "Lab"
    table.RGBPoints = [number for value, color in zip(numpy.linspace(low, high, len(colors)), colors)
                       for number in (value, *color)]
    bar = GetScalarBar(table, view)
    bar.Title, bar.ComponentTitle = title, ""
    bar.Orientation, bar.WindowLocation = "Horizontal", "Any Location"
    bar.Position, bar.ScalarBarLength, bar.ScalarBarThickness = (0.15, 0.035), 0.7, 20
    bar.TitleColor = bar.LabelColor = (0.1, 0.1, 0.1)
    bar.TitleFontSize, bar.LabelFontSize = 28, 26
    bar.AutomaticLabelFormat, bar.LabelFormat, bar.RangeLabelFormat = 0, "%.3g", "%.3g"
    bar.UseCustomLabels, bar.CustomLabels = 1, [low, (low + high) / 2, high]
    bar.AddRangeLabels = 0
    bar.DrawTickMarks = 0
    shown.SetScalarBarVisibility(view, True)


def draw(pose, marked, bent, measured, folder):
    """A layout of four panels, kept in the state, and its picture."""
    before, after = (WrapDataObject(servermanager.Fetch(s)) for s in (marked, measured))
    points = numpy.concatenate([numpy.asarray(surface.Points) for surface in (before, after)])
    # The lowest 17 % of a panel belong to the color bar, the highest 8 % to its title.
    camera = camera_for(pose.view_from, pose.view_up, points, PANEL, 0.17, 0.08)
    # The largest two percent would leave everything else without color.
    error = nice(numpy.percentile(abs(after.PointData["MeanCurvatureError"]), 98))
    change = nice(after.PointData["FrameChange"].max())
    layout = CreateLayout(pose.title)
    panels = [
        ("handles", marked, lambda shown, view: color_by_handle(shown, pose)),
        ("moved", bent, lambda shown, view: color_by_handle(shown, pose)),
        ("frame change", bent, lambda shown, view: color_by_field(
            shown, view, "FrameChange", "norm of R - I", AMOUNT, 0, change)),
        ("mean-curvature error", measured, lambda shown, view: color_by_field(
            shown, view, "MeanCurvatureError", "H' - H  (1 / length)", DIFFERENCE,
            -error, error)),
    ]
    cell = 0
    captions = []
    for number, (caption, source, color) in enumerate(panels):
        view = new_view(camera)
        AssignViewToLayout(view=view, layout=layout, hint=cell)
        if number < len(panels) - 1:
            cell = layout.SplitHorizontal(cell, 1 / (len(panels) - number)) + 1
        shown = show(source, view)
        color(shown, view)
        text = Text(Text=f"{pose.title}: {caption}" if number == 0 else caption)
        label = Show(text, view)
        label.Color, label.FontSize = (0.1, 0.1, 0.1), 30
        label.WindowLocation = "Upper Center"
        captions.append(text)
    size = (PANEL[0] * len(panels), PANEL[1])
    layout.SetSize(*size)
    picture = os.path.join(folder, pose.mesh + ".png")
    SaveScreenshot(picture, layout, ImageResolution=size, SeparatorWidth=0)
    for text in captions:
        Delete(text)
    return picture


def relative_curvature_error(reference, surface):
    """rms of the change of mean curvature over the rms of mean curvature."""
    before = CurvatureError(Input=reference)
    values = [WrapDataObject(servermanager.Fetch(source)).PointData[array]
              for source, array in ((before, "MeanCurvature"), (surface, "MeanCurvatureError"))]
    Delete(before)
    return numpy.sqrt(numpy.mean(values[1]**2) / numpy.mean(values[0]**2))


def run(pose, folder):
    """The whole of one pose: its row of the table and its picture."""
    rest = os.path.join(folder, pose.mesh + "-before.vtp")
    write_rest_surface(pose, rest)
    surface = XMLPolyDataReader(registrationName=pose.title, FileName=[rest])
    marked = mark(pose, surface)
    bent = deform(pose, marked)
    setup, motion = time_motions(bent)
    curvature = CurvatureError(registrationName=f"{pose.title} curvature", Input=bent,
                               Reference=marked)
    measured = VolumeChange(registrationName=f"{pose.title} measures", Input=curvature,
                            Reference=marked)
    measured.UpdatePipeline()
    measured.UpdatePropertyInformation()
    SaveData(os.path.join(folder, pose.mesh + "-after.vtp"), proxy=measured,
             DataMode="Binary")
    volume, edges = (measured.GetProperty(name).GetData()
                     for name in ("RelativeVolumeChange", "EdgeLengthRMS"))
    row = (pose.title, surface.GetDataInformation().GetNumberOfPoints(), setup, 1e3 * motion,
           "open" if math.isnan(volume) else f"{100 * volume:+.1f} %", 100 * edges,
           100 * relative_curvature_error(marked, curvature))
    return row, draw(pose, marked, bent, measured, folder)


def main(build):
    folder = os.path.join(build, "demo")
    os.makedirs(folder, exist_ok=True)
    load_plugin(build, globals())
    rows, pictures = zip(*(run(pose, folder) for pose in POSES))
    SaveState(os.path.join(folder, "demo.pvsm"))
    write_overview(pictures, folder)

    print(f"\n{'':12}{'vertices':>9}{'set-up':>10}{'a motion':>11}{'volume':>10}"
          f"{'edges':>10}{'curvature':>11}")
    for title, vertices, setup, motion, volume, edges, curvature in rows:
        print(f"{title:12}{vertices:9,}{setup:8.3f} s{motion:8.1f} ms{volume:>10}"
              f"{edges:8.1f} %{curvature:9.0f} %")
    print("volume: relative change; edges: rms of the relative change of lengths;\n"
          "curvature: rms of the change of mean curvature over its rms before\n")
    print(f"Pictures, surfaces and the state demo.pvsm are in {folder}")


if __name__ == "__main__":
    main(sys.argv[1])
