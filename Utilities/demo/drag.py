# SPDX-License-Identifier: BSD-3-Clause
"""Measures what an update of a deformation costs while a handle is dragged, as a box does it.

    pvpython Utilities/demo/drag.py SURFACE [METHOD ...]

SURFACE is a file of ParaView's format .vtp, such as build/demo/armadillo-before.vtp of 26,002
points, and METHOD a class without vtk and Deformation, for Laplacian with its rotations:
LaplacianNone, LaplacianImplicit, LaplacianEstimated. Prints the processor time of a whole update
with VTK's pipeline around it, the median of 50 moves (of 10 where a method iterates), and what one
iteration or round takes of it. With OMP_NUM_THREADS=1 other programs disturb it least.
"""
import statistics
import sys
import time

import vtkcartan
from vtkmodules.vtkCommonDataModel import vtkBox
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

LINEAR = ("RotationInvariant", "ShapePreserving", "Poisson", "Similarity", "Multiresolution",
          "LaplacianNone", "LaplacianImplicit")
ITERATED = ("LaplacianEstimated", "AsRigidAsPossible", "Pyramid")


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


def make(name):
    """The filter of a method, silent."""
    if name.startswith("Laplacian"):
        deformation = vtkcartan.vtkLaplacianDeformation()
        set_rotations = {"LaplacianNone": deformation.SetRotationsToNone,
                         "LaplacianImplicit": deformation.SetRotationsToImplicit}
        set_rotations.get(name, deformation.SetRotationsToEstimated)()
    else:
        deformation = getattr(vtkcartan, "vtk%sDeformation" % name)()
    deformation.AddObserver("WarningEvent", lambda *_: None)
    return deformation


def iterations(deformation):
    """How many the last update took; none where a method is linear."""
    if hasattr(deformation, "GetNumberOfIterations"):
        return deformation.GetNumberOfIterations()
    is_estimated = hasattr(deformation, "GetRounds") and (
        deformation.GetRotations() == deformation.ESTIMATED)
    return deformation.GetRounds() if is_estimated else 0


def drag(name, source, size):
    """Prints a row of the table."""
    deformation = make(name)
    deformation.SetInputConnection(source.GetOutputPort())
    box = vtkcartan.vtkHandleMotion()
    box.SetModeToBox()
    deformation.SetActiveHandle(2)
    deformation.SetActiveMotion(box)
    deformation.Update()
    updates, each = [], []
    for move in range(1, 51 if name in LINEAR else 11):
        box.SetBoxPosition(0.0, 0.0, 0.001 * move * size)
        box.SetBoxRotation(0.1 * move, 0.0, 0.0)
        start = time.process_time()
        deformation.Update()
        updates.append(1000 * (time.process_time() - start))
        each.append(updates[-1] / max(1, iterations(deformation)))
    count = iterations(deformation)
    print("| %s | %.1f | %s |" % (name, statistics.median(updates), "%d of %.1f" % (
        count, statistics.median(each)) if count else ""), flush=True)


reader = vtkXMLPolyDataReader()
reader.SetFileName(sys.argv[1])
marked, longest = mark_ends(reader)
print("| method, %d points | update, ms | iterations, ms each |\n|---|---|---|" %
      reader.GetOutput().GetNumberOfPoints())
for method in sys.argv[2:] or LINEAR + ITERATED:
    drag(method, marked, longest)
