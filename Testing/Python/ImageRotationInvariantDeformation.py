# SPDX-License-Identifier: BSD-3-Clause
"""The armadillo bends at the waist; its colors show how far each frame turned.

The picture shows that something sensible is drawn. That it is right, the numbers
say that are checked before.
"""
import math
import os
import sys

import numpy
from vtkcartan import vtkHandleMotion, vtkRotationInvariantDeformation, vtkVolumeChange
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals
from vtkmodules.vtkIOImage import vtkPNGReader, vtkPNGWriter
from vtkmodules.vtkRenderingCore import (vtkActor, vtkPolyDataMapper, vtkRenderer,
                                         vtkRenderWindow, vtkWindowToImageFilter)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401, registers the classes that draw

import cartan_testing

NAME = "ImageRotationInvariantDeformation.png"
DEGREES = 75
SIZE = 400


def points_of(surface):
    return vtk_to_numpy(surface.GetPoints().GetData())


def bent_armadillo():
    """The legs are pinned, the chest and all above it turns about the waist."""
    armadillo = cartan_testing.read_off("armadillo")
    points = points_of(armadillo)
    low, high = points[:, 1].min(), points[:, 1].max()
    height = (points[:, 1] - low) / (high - low)
    handle = numpy_to_vtk((height < .35) + 2 * (height > .62).astype(numpy.int32), deep=True)
    handle.SetName("Handle")
    armadillo.GetPointData().AddArray(handle)
    middle = points.mean(0)
    motion = vtkHandleMotion()
    motion.SetCenter(middle[0], low + .48 * (high - low), middle[2])
    motion.SetAxis(0, 0, 1)
    motion.SetAngle(DEGREES)
    bend = vtkRotationInvariantDeformation()
    bend.SetInputData(armadillo)
    bend.SetHandleMotion(2, motion)
    bend.GenerateFrameChangeOn()
    bend.Update()
    return armadillo, bend.GetOutput()


def check_numbers(armadillo, bent):
    change = vtk_to_numpy(bent.GetPointData().GetArray("FrameChange"))
    handle = vtk_to_numpy(armadillo.GetPointData().GetArray("Handle"))
    full = math.sqrt(8) * math.sin(math.radians(DEGREES / 2))
    numpy.testing.assert_allclose(change[handle == 1], 0, atol=1e-12)
    numpy.testing.assert_allclose(change[handle == 2], full, atol=1e-12)
    free = change[handle == 0]
    assert ((free > 0) & (free < full)).all()
    # Turning spreads over the waist instead of jumping somewhere.
    shares = numpy.histogram(free, 6, (0, full))[0] / len(free)
    assert (shares > .03).all(), shares
    volume = vtkVolumeChange()
    volume.SetInputData(0, bent)
    volume.SetInputData(1, armadillo)
    volume.Update()
    table = volume.GetOutputDataObject(1)
    quantities = table.GetColumnByName("Quantity")
    row = [quantities.GetValue(i) for i in range(table.GetNumberOfRows())].index("Volume")
    relative = table.GetColumnByName("RelativeChange").GetValue(row)
    assert abs(relative) < .05, relative


def picture(surface):
    normals = vtkPolyDataNormals()
    normals.SetInputData(surface)
    normals.SplittingOff()
    colors = vtkLookupTable()
    colors.SetHueRange(.62, .02)
    colors.Build()
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(normals.GetOutputPort())
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("FrameChange")
    mapper.SetScalarRange(0, math.sqrt(8) * math.sin(math.radians(DEGREES / 2)))
    mapper.SetLookupTable(colors)
    actor = vtkActor()
    actor.SetMapper(mapper)
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(actor)
    # From the armadillo's front, a little from above.
    camera = renderer.GetActiveCamera()
    camera.SetPosition(0, .3, -1)
    camera.SetViewUp(0, 1, 0)
    renderer.ResetCamera()
    camera.Zoom(1.3)
    window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(0)
    window.SetSize(SIZE, SIZE)
    window.AddRenderer(renderer)
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    return grab.GetOutput()


def pixels(image):
    width, height, _ = image.GetDimensions()
    values = vtk_to_numpy(image.GetPointData().GetScalars())
    return values.reshape(height, width, -1)[:, :, :3].astype(float)


def check_picture(image):
    path = cartan_testing.output_path(NAME)
    writer = vtkPNGWriter()
    writer.SetInputData(image)
    writer.SetFileName(path)
    writer.Write()
    baseline = os.path.join(cartan_testing.baseline_dir(), NAME)
    if not os.path.exists(baseline):
        sys.exit("There is no " + baseline + "; the picture is " + path)
    reader = vtkPNGReader()
    reader.SetFileName(baseline)
    reader.Update()
    difference = numpy.abs(pixels(image) - pixels(reader.GetOutput())).max(2)
    # Rasterizers differ at silhouettes only: a few pixels, but no region.
    wrong = (difference > 40).mean()
    assert wrong < .005, "{:.2%} of the pixels differ from {}".format(wrong, baseline)
    os.remove(path)


if __name__ == "__main__":
    before, after = bent_armadillo()
    check_numbers(before, after)
    check_picture(picture(after))
