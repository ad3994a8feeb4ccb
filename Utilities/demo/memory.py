# SPDX-License-Identifier: BSD-3-Clause
"""Prints the memory of each filter in bytes per point, for a scanned surface of 104,002 points:
what it keeps from one update to the next, and what its first update takes at its peak beyond
its input. The table of Documentation/Memory.md.

Run it with pvpython and the variables of the tests, CARTAN_MESH_DIR and PYTHONPATH; memory.py 2
subdivides twice: 416,002 points; memory.py 2 Morph is for filters with such a name only. Linux
only: peaks come from /proc.
"""
import ctypes
import os
import sys

import numpy
import vtkcartan
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_ID_TYPE
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkTable
from vtkmodules.vtkCommonExecutionModel import vtkTrivialProducer

import scan

DEFORMATIONS = ("RotationInvariant", "ShapePreserving", "Poisson", "AsRigidAsPossible", "Pyramid",
                "Multiresolution", "Laplacian", "Similarity")


def resident(which):
    """VmRSS, the memory that the process has in use, or VmHWM, its maximum; in bytes."""
    with open("/proc/self/status", encoding="ascii") as status:
        for line in status:
            if line.startswith(which + ":"):
                return 1024 * int(line.split()[1])
    raise RuntimeError(which + " is not in /proc/self/status")


def in_process(action):
    """Runs action() in a process of its own, so that nothing of it remains here."""
    sys.stdout.flush()
    child = os.fork()
    if child == 0:
        action()
        sys.stdout.flush()
        os._exit(0)
    os.waitpid(child, 0)


def connected(kind, *connections, **properties):
    """A filter with the outputs of others on its ports."""
    filter = getattr(vtkcartan, "vtk" + kind)()
    for port, source in enumerate(connections):
        source, output = source if isinstance(source, tuple) else (source, 0)
        filter.AddInputConnection(port, source.GetOutputPort(output))
    for name, value in properties.items():
        getattr(filter, "Set" + name)(value)
    return filter


def bending(kind, marked, **properties):
    motion = vtkcartan.vtkHandleMotion()
    motion.SetAxis(1, 0, 0)
    motion.SetAngle(20)
    filter = connected(kind + "Deformation", marked, **properties)
    filter.SetHandleMotion(2, motion)
    return filter


def morph(method, marked, bent, **properties):
    filter = connected("SurfaceMorph", marked, Parameter=0.5, **properties)
    getattr(filter, "SetMethodTo" + method)()
    filter.AddInputConnection(bent.GetOutputPort())
    return filter


def opened(source):
    """The surface without the triangles of its first point."""
    surface = source.GetOutput()
    corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    kept = corners[(corners != corners[0, 0]).all(axis=1)]
    cells = vtkCellArray()
    cells.SetData(3, numpy_to_vtk(kept.astype(numpy.int64).ravel(), deep=True,
                                  array_type=VTK_ID_TYPE))
    result = vtkPolyData()
    result.SetPoints(surface.GetPoints())
    result.SetPolys(cells)
    producer = vtkTrivialProducer()
    producer.SetOutput(result)
    return producer


def misfit(forms):
    """The forms with angles that those of no surface are."""
    table = vtkTable()
    table.DeepCopy(forms.GetOutputDataObject(1))
    angles = vtk_to_numpy(table.GetColumnByName("Angle"))
    angles += 0.1 * numpy.sin(numpy.arange(len(angles)))
    producer = vtkTrivialProducer()
    producer.SetOutput(table)
    return producer


def cases(marked, forms, bent):
    """Names, and what makes the filter."""
    yield "vtkMarkHandle, growing", lambda: connected(
        "MarkHandle", marked, HandleId=3, GrowDistance=1e-3, Region=marked.GetRegion())
    yield "vtkDiscreteForms", lambda: connected("DiscreteForms", marked)
    yield "vtkFrameReconstruction", lambda: connected("FrameReconstruction", marked, (forms, 1))
    yield "vtkFrameReconstruction, forms of no surface", lambda: connected(
        "FrameReconstruction", marked, misfit(forms))
    yield "vtkPrepareSurface", lambda: connected("PrepareSurface", marked)
    yield "vtkRestoreSurface", lambda: connected(
        "RestoreSurface", connected("PrepareSurface", marked), marked)
    for kind in DEFORMATIONS:
        yield f"vtk{kind}Deformation", lambda kind=kind: bending(kind, marked)
    for kind in ("CurvatureError", "VolumeChange"):
        yield "vtk" + kind, lambda kind=kind: connected(kind, bent, marked)
    yield "vtkBoundaryLoops", lambda: connected("BoundaryLoops", opened(marked))
    yield "vtkMeshMerge", lambda: connected("MeshMerge", opened(marked), opened(marked))
    yield "vtkCoatingTransfer", lambda: connected("CoatingTransfer", marked, marked)
    for method in ("DiscreteForms", "Isometric", "DeformationGradient", "Linear"):
        yield "vtkSurfaceMorph, " + method, lambda method=method: morph(method, marked, bent)
    yield "vtkSurfaceMorph, ConjugateGradients", lambda: morph(
        "DiscreteForms", marked, bent, FrameSolver=vtkcartan.vtkSurfaceMorph.CONJUGATE_GRADIENTS)
    yield "vtkSurfaceMorph, Direct", lambda: morph(
        "DiscreteForms", marked, bent, FrameSolver=vtkcartan.vtkSurfaceMorph.DIRECT)
    yield "vtkSurfaceMorph, Isometric, polish", lambda: morph(
        "Isometric", marked, bent, LengthPolish=3)
    yield "vtkLaplacianDeformation, Implicit", lambda: bending(
        "Laplacian", marked, Rotations=vtkcartan.vtkLaplacianDeformation.IMPLICIT)


def main():
    fine = scan.armadillo(int(sys.argv[1]) if len(sys.argv) > 1 else 1)
    points = fine.GetOutput().GetNumberOfPoints()
    marked = fine
    for handle, low, high in ((1, -0.1, 0.1), (2, 0.9, 1.1)):
        marked = scan.mark_heights(marked, handle, low, high)
        marked.Update()
    print(f"bytes per point, {points} points{'':22s} kept    peak")
    forms = connected("DiscreteForms", marked)
    forms.Update()
    bent = bending("RotationInvariant", marked)
    bent.Update()
    # Their own share of the surface's mesh would hide it from the peaks.
    for filter in (forms, bent, marked):
        filter.ReleaseKeptMemory()

    def measure(name, make):
        filter = make()
        ctypes.CDLL(None).malloc_trim(0)  # what is free already would serve again
        with open("/proc/self/clear_refs", "w", encoding="ascii") as peak:
            peak.write("5")  # VmHWM begins anew
        before = resident("VmRSS")
        filter.Update()
        print(f"{name:42s} {filter.GetKeptMemory() * 1e6 / points:8.0f}"
              f"{(resident('VmHWM') - before) / points:8.0f}")

    for name, make in cases(marked, forms, bent):
        if len(sys.argv) < 3 or sys.argv[2] in name:
            in_process(lambda: measure(name, make))


main()
