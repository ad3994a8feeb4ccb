# SPDX-License-Identifier: BSD-3-Clause
"""Measures what an update of a deformation costs while a handle is dragged, as a box does it.

    pvpython Utilities/demo/drag.py SURFACE [METHOD ...]

SURFACE is a file of ParaView's format .vtp, such as build/demo/armadillo-before.vtp of 26,002
points, and METHOD a class without vtk and Deformation. Prints the processor time of a whole update
with VTK's pipeline around it, the median of 50. With OMP_NUM_THREADS=1 other programs disturb it
least.
"""
import statistics
import sys
import time

import vtkcartan
from vtkmodules.vtkCommonDataModel import vtkBox
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

MOVES = 50


def mark(source, handle, bounds):
    """Marks the points in a box."""
    box = vtkBox()
    box.SetBounds(bounds)
    marked = vtkcartan.vtkMarkHandle()
    marked.SetInputConnection(source.GetOutputPort())
    marked.SetRegion(box)
    marked.SetHandleId(handle)
    return marked


def mark_ends(reader):
    """A tenth of the longest side at each end, as Mark Handle starts in ParaView's window."""
    reader.Update()
    bounds = list(reader.GetOutput().GetBounds())
    lengths = [bounds[i + 1] - bounds[i] for i in (0, 2, 4)]
    axis = 2 * lengths.index(max(lengths))
    low, high = list(bounds), list(bounds)
    low[axis + 1] = bounds[axis] + 0.1 * max(lengths)
    high[axis] = bounds[axis + 1] - 0.1 * max(lengths)
    return mark(mark(reader, 1, low), 2, high), max(lengths)


def drag(name, source, size):
    """Milliseconds of an update."""
    deformation = getattr(vtkcartan, "vtk%sDeformation" % name)()
    deformation.SetInputConnection(source.GetOutputPort())
    box = vtkcartan.vtkHandleMotion()
    box.SetModeToBox()
    deformation.SetActiveHandle(2)
    deformation.SetActiveMotion(box)
    deformation.Update()
    updates = []
    for move in range(1, MOVES + 1):
        box.SetBoxPosition(0.0, 0.0, 0.001 * move * size)
        box.SetBoxRotation(0.1 * move, 0.0, 0.0)
        start = time.process_time()
        deformation.Update()
        updates.append(1000 * (time.process_time() - start))
    print("%-20s %6d points  update %6.2f ms" % (
        name, deformation.GetOutput().GetNumberOfPoints(), statistics.median(updates)), flush=True)


reader = vtkXMLPolyDataReader()
reader.SetFileName(sys.argv[1])
marked, longest = mark_ends(reader)
for method in sys.argv[2:] or ("RotationInvariant", "ShapePreserving", "Poisson", "Laplacian"):
    drag(method, marked, longest)
