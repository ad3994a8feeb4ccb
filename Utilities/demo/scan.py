# SPDX-License-Identifier: BSD-3-Clause
"""The scanned surface with two handles that the tables of memory and of progress are made on."""
import os

from vtkmodules.vtkCommonDataModel import vtkBox
from vtkmodules.vtkFiltersModeling import vtkLinearSubdivisionFilter
from vtkcartan import vtkMarkHandle

import cartan_testing


def armadillo(subdivisions):
    """An updated filter whose output is the armadillo, subdivided: 26,002 points, four times as
    many with each subdivision."""
    fine = vtkLinearSubdivisionFilter()
    fine.SetInputData(
        cartan_testing.read_off(os.path.join(cartan_testing.mesh_dir(), "armadillo.off")))
    fine.SetNumberOfSubdivisions(subdivisions)
    fine.Update()
    return fine


def mark_heights(source, handle, low, high):
    """A vtkMarkHandle behind the filter `source` that marks the points whose y is between two
    parts of the surface's extent in y, 0 at the bottom and 1 at the top. Not updated."""
    bounds = source.GetOutputDataObject(0).GetBounds()
    height = bounds[3] - bounds[2]
    box = vtkBox()
    box.SetBounds(bounds[0] - 1, bounds[1] + 1, bounds[2] + low * height,
                  bounds[2] + high * height, bounds[4] - 1, bounds[5] + 1)
    marked = vtkMarkHandle()
    marked.SetInputConnection(source.GetOutputPort())
    marked.SetRegion(box)
    marked.SetHandleId(handle)
    return marked
