# SPDX-License-Identifier: BSD-3-Clause
"""Draws surfaces on white panels, and puts pictures together on sheets."""
import os
from dataclasses import dataclass

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkImageAppend, vtkPolyDataNormals
from vtkmodules.vtkImagingCore import vtkImageResize
from vtkmodules.vtkIOImage import vtkJPEGWriter, vtkPNGReader, vtkPNGWriter
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import (vtkActor, vtkColorTransferFunction, vtkLight,
                                         vtkPolyDataMapper, vtkRenderer, vtkRenderWindow,
                                         vtkTextActor, vtkWindowToImageFilter)
from vtkmodules.vtkRenderingOpenGL2 import vtkRenderStepsPass, vtkSSAOPass
import vtkmodules.vtkRenderingFreeType  # noqa: F401, registers what draws text

# Free points in the color of bone, pinned ones dark; then a color per handle.
FREE, PINNED = (0.88, 0.85, 0.79), (0.30, 0.33, 0.38)
HANDLE_COLORS = [(0.90, 0.38, 0.22), (0.17, 0.49, 0.72), (0.93, 0.70, 0.13), (0.30, 0.62, 0.35),
                 (0.58, 0.40, 0.70), (0.10, 0.63, 0.65), (0.85, 0.45, 0.62)]
# From less to more.
DIFFERENCE = [(0.05, 0.20, 0.50), (0.35, 0.65, 0.85), FREE, (0.92, 0.48, 0.30), (0.55, 0.03, 0.12)]
INK = (0.12, 0.12, 0.14)
# Wide enough for the README, small enough for the repository.
REDUCED_WIDTH = 1400


def camera_for(view_from, view_up, points, size, below, above):
    """Focal point, position, up and parallel scale of a camera that shows all points
    in a picture of that size, of which parts are left to captions."""
    back = numpy.array(view_from, dtype=float)
    back /= numpy.linalg.norm(back)
    right = numpy.cross(view_up, back)
    right /= numpy.linalg.norm(right)
    up = numpy.cross(back, right)
    seen = points @ numpy.array([right, up, back]).T
    low, high = seen.min(axis=0), seen.max(axis=0)
    scale = max((high[1] - low[1]) / (0.97 - below - above),
                (high[0] - low[0]) / 0.94 * size[1] / size[0]) / 2
    middle = (low + high) / 2
    middle[1] -= (below - above) * scale
    focal = middle @ numpy.array([right, up, back])
    distance = 4 * scale + (high[2] - low[2])
    return focal, focal + distance * back, up, scale


@dataclass
class Panel:
    """A surface with its captions, colored by its handles or by another array."""
    title: str
    note: str
    surface: object
    array: str = "Handle"
    range: float = 0.0  # of the array: from minus to plus this


def color_map(panel):
    colors = vtkColorTransferFunction()
    if panel.array == "Handle":
        for value, color in enumerate([FREE, PINNED, HANDLE_COLORS[0]]):
            colors.AddRGBPoint(value, *color)
    else:
        colors.SetColorSpaceToLab()
        for part, color in zip(numpy.linspace(-1, 1, len(DIFFERENCE)), DIFFERENCE):
            colors.AddRGBPoint(part * panel.range, *color)
    return colors


def with_held_triangles(surface):
    """The surface with the cell array Handle: the handle that holds all corners."""
    handles = vtk_to_numpy(surface.GetPointData().GetArray("Handle"))
    corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    held = numpy_to_vtk(handles[corners].min(axis=1), deep=True)
    held.SetName("Handle")
    result = vtkPolyData()
    result.ShallowCopy(surface)
    result.GetCellData().AddArray(held)
    return result


def surface_actor(panel):
    normals = vtkPolyDataNormals()
    normals.SetInputData(with_held_triangles(panel.surface))
    # Edges of bars are sharp, scanned and bumpy surfaces smooth.
    normals.SetFeatureAngle(50)
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(normals.GetOutputPort())
    if panel.array == "Handle":
        mapper.SetScalarModeToUseCellFieldData()
    else:
        mapper.SetScalarModeToUsePointFieldData()
        mapper.InterpolateScalarsBeforeMappingOn()
    mapper.SelectColorArray(panel.array)
    mapper.SetLookupTable(color_map(panel))
    mapper.UseLookupTableScalarRangeOn()
    actor = vtkActor()
    actor.SetMapper(mapper)
    surface = actor.GetProperty()
    surface.SetAmbient(0.12)
    surface.SetDiffuse(0.88)
    surface.SetSpecular(0.12)
    surface.SetSpecularPower(25)
    return actor


def text_actor(text, size, place, vertical, bold=False):
    """Centered at a place, in parts of the picture."""
    actor = vtkTextActor()
    actor.SetInput(text)
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    actor.GetPositionCoordinate().SetValue(*place)
    look = actor.GetTextProperty()
    look.SetFontSize(size)
    look.SetColor(INK)
    look.SetBold(bold)
    look.SetBackgroundColor(1, 1, 1)
    look.SetBackgroundOpacity(0.85)
    look.SetJustificationToCentered()
    getattr(look, "SetVerticalJustificationTo" + vertical)()
    return actor


def photograph(window):
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    return grab.GetOutput()


def new_window(size):
    """Twice as large as the picture, which is reduced: that smooths the edges."""
    window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(0)
    window.SetSize(*(2 * length for length in size))
    return window


def draw(panel, camera, size):
    """The picture of a panel: lit from the upper left, with ambient shadows."""
    window = new_window(size)
    window.SetNumberOfLayers(2)
    scene, captions = vtkRenderer(), vtkRenderer()
    captions.SetLayer(1)
    for renderer in (scene, captions):
        window.AddRenderer(renderer)
    scene.SetBackground(1, 1, 1)
    scene.AddActor(surface_actor(panel))
    focal, position, up, scale = camera
    view = scene.GetActiveCamera()
    view.ParallelProjectionOn()
    view.SetParallelScale(scale)
    view.SetFocalPoint(focal)
    view.SetPosition(position)
    view.SetViewUp(up)
    scene.ResetCameraClippingRange()
    # Key, fill and back light, in the camera's coordinates.
    for place, strength in (((-0.5, 0.8, 1), 0.85), ((0.9, 0.1, 0.6), 0.45), ((0, 0.6, -1), 0.25)):
        light = vtkLight()
        light.SetLightTypeToCameraLight()
        light.SetPosition(place)
        light.SetIntensity(strength)
        scene.AddLight(light)
    shadows = vtkSSAOPass()
    shadows.SetRadius(0.25 * scale)
    shadows.SetBias(0.003 * scale)
    shadows.SetKernelSize(96)
    shadows.BlurOn()
    shadows.SetDelegatePass(vtkRenderStepsPass())
    scene.SetPass(shadows)
    captions.AddViewProp(text_actor(panel.title, 46, (0.5, 0.985), "Top", bold=True))
    captions.AddViewProp(text_actor(panel.note, 42, (0.5, 0.02), "Bottom"))
    window.Render()
    return resized(photograph(window), size)


def strip(size, *props):
    """A white picture with texts or a legend."""
    window = new_window(size)
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    for prop in props:
        renderer.AddViewProp(prop)
    window.AddRenderer(renderer)
    window.Render()
    return resized(photograph(window), size)


def heading(text, size):
    return strip(size, text_actor(text, 54, (0.5, 0.5), "Centered", bold=True))


def legend(panel, title, size):
    """What the colors of a panel mean: a bar from minus to plus its range."""
    bar = vtkScalarBarActor()
    bar.SetLookupTable(color_map(panel))
    bar.SetOrientationToHorizontal()
    bar.SetMaximumNumberOfColors(256)
    bar.SetNumberOfLabels(5)
    bar.SetLabelFormat("%.3g")
    bar.UnconstrainedFontSizeOn()
    bar.SetTextPositionToPrecedeScalarBar()
    bar.GetPositionCoordinate().SetValue(0.5, 0.05)
    bar.SetWidth(0.3)
    bar.SetHeight(0.9)
    bar.SetBarRatio(0.45)
    look = bar.GetLabelTextProperty()
    look.SetColor(INK)
    look.SetFontSize(40)
    look.SetBold(False)
    look.SetItalic(False)
    look.SetShadow(False)
    text = text_actor(title, 42, (0.48, 0.5), "Centered")
    text.GetTextProperty().SetJustificationToRight()
    return strip(size, bar, text)


def resized(image, size):
    resize = vtkImageResize()
    resize.SetInputData(image)
    resize.SetOutputDimensions(*size, 1)
    resize.InterpolateOn()
    resize.Update()
    return resize.GetOutput()


def side_by_side(images):
    append = vtkImageAppend()
    for image in images:
        append.AddInputData(image)
    append.Update()
    return append.GetOutput()


def one_below_the_other(images):
    append = vtkImageAppend()
    append.SetAppendAxis(1)
    # The origin of images is at the bottom.
    for image in reversed(images):
        append.AddInputData(image)
    append.Update()
    return append.GetOutput()


def write(writer, image, path):
    writer.SetInputData(image)
    writer.SetFileName(path)
    writer.Write()


def write_sheet(image, folder, name, quality=95):
    """name.png, and name-reduced.jpg, which is as wide as a page."""
    write(vtkPNGWriter(), image, os.path.join(folder, name + ".png"))
    width, height, _ = image.GetDimensions()
    writer = vtkJPEGWriter()
    writer.SetQuality(quality)
    write(writer, resized(image, (REDUCED_WIDTH, round(height * REDUCED_WIDTH / width))),
          os.path.join(folder, name + "-reduced.jpg"))


def write_overview(pictures, folder):
    """overview.png with the pictures one below the other, and a reduced one."""
    images = []
    for picture in pictures:
        reader = vtkPNGReader()
        reader.SetFileName(picture)
        reader.Update()
        images.append(reader.GetOutput())
    write_sheet(one_below_the_other(images), folder, "overview")
