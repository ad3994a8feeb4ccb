# SPDX-License-Identifier: BSD-3-Clause
"""Puts the pictures of the poses on one sheet."""
import os

from vtkmodules.vtkFiltersCore import vtkImageAppend
from vtkmodules.vtkImagingCore import vtkImageResize
from vtkmodules.vtkIOImage import vtkJPEGWriter, vtkPNGReader, vtkPNGWriter

# Wide enough for the README, small enough for the repository.
REDUCED_WIDTH = 1400


def write(writer, port, path):
    writer.SetInputConnection(port)
    writer.SetFileName(path)
    writer.Write()


def write_overview(pictures, folder):
    """overview.png with the pictures one below the other, and a reduced one."""
    append = vtkImageAppend()
    append.SetAppendAxis(1)
    # The origin of images is at the bottom.
    for picture in reversed(pictures):
        reader = vtkPNGReader()
        reader.SetFileName(picture)
        reader.Update()
        append.AddInputConnection(reader.GetOutputPort())
    append.Update()
    write(vtkPNGWriter(), append.GetOutputPort(), os.path.join(folder, "overview.png"))
    width, height, _ = append.GetOutput().GetDimensions()
    resize = vtkImageResize()
    resize.SetInputConnection(append.GetOutputPort())
    resize.SetOutputDimensions(REDUCED_WIDTH, round(height * REDUCED_WIDTH / width), 1)
    resize.InterpolateOn()
    write(vtkJPEGWriter(), resize.GetOutputPort(), os.path.join(folder, "overview-reduced.jpg"))
