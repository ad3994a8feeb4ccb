# SPDX-License-Identifier: BSD-3-Clause
"""Prints what each filter keeps from one update to the next, in bytes per point, for a scanned
surface of 104,002 points: the table of Documentation/Memory.md.

Run it with pvpython and the variables of the tests, CARTAN_MESH_DIR and PYTHONPATH.
"""
import os

from vtkmodules.vtkCommonDataModel import vtkBox
from vtkmodules.vtkFiltersModeling import vtkLinearSubdivisionFilter
from vtkcartan import (vtkAsRigidAsPossibleDeformation, vtkCurvatureError, vtkDiscreteForms,
                       vtkFrameReconstruction, vtkHandleMotion, vtkLaplacianDeformation,
                       vtkMarkHandle, vtkMultiresolutionDeformation, vtkPoissonDeformation,
                       vtkPrepareSurface, vtkRestoreSurface, vtkRotationInvariantDeformation,
                       vtkShapePreservingDeformation, vtkSimilarityDeformation, vtkSurfaceMorph,
                       vtkVolumeChange)

import cartan_testing


def mark(source, handle, low, high):
    """Marks the points between two parts of the height."""
    bounds = source.GetOutputDataObject(0).GetBounds()
    height = bounds[3] - bounds[2]
    box = vtkBox()
    box.SetBounds(bounds[0] - 1, bounds[1] + 1, bounds[2] + low * height,
                  bounds[2] + high * height, bounds[4] - 1, bounds[5] + 1)
    marked = vtkMarkHandle()
    marked.SetInputConnection(source.GetOutputPort())
    marked.SetRegion(box)
    marked.SetHandleId(handle)
    marked.SetGrowDistance(1e-3 * height)
    marked.Update()
    return marked


def main():
    scan = cartan_testing.read_off(os.path.join(cartan_testing.mesh_dir(), "armadillo.off"))
    fine = vtkLinearSubdivisionFilter()
    fine.SetInputData(scan)
    fine.Update()
    points = fine.GetOutput().GetNumberOfPoints()
    marked = mark(mark(fine, 1, -0.1, 0.1), 2, 0.9, 1.1)
    motion = vtkHandleMotion()
    motion.SetAxis(1, 0, 0)
    motion.SetAngle(20)

    def row(name, filter):
        print(f"{name:42s} {filter.GetKeptMemory() * 1e6 / points:7.0f}")

    print(f"bytes per point, {points} points")
    row("vtkMarkHandle", marked)
    forms = vtkDiscreteForms()
    forms.SetInputConnection(marked.GetOutputPort())
    rebuilt = vtkFrameReconstruction()
    rebuilt.SetInputConnection(marked.GetOutputPort())
    rebuilt.SetFormsConnection(forms.GetOutputPort(1))
    prepared = vtkPrepareSurface()
    prepared.SetInputConnection(marked.GetOutputPort())
    restored = vtkRestoreSurface()
    restored.SetInputConnection(prepared.GetOutputPort())
    restored.SetOriginalConnection(marked.GetOutputPort())
    for filter in (forms, rebuilt, prepared, restored):
        filter.Update()
        row(filter.GetClassName(), filter)
    bent = None
    for kind in (vtkRotationInvariantDeformation, vtkShapePreservingDeformation,
                 vtkPoissonDeformation, vtkAsRigidAsPossibleDeformation,
                 vtkMultiresolutionDeformation, vtkLaplacianDeformation,
                 vtkSimilarityDeformation):
        filter = kind()
        filter.SetInputConnection(marked.GetOutputPort())
        filter.SetHandleMotion(2, motion)
        filter.Update()
        row(filter.GetClassName(), filter)
        bent = bent or filter
    for kind in (vtkCurvatureError, vtkVolumeChange):
        measure = kind()
        measure.SetInputConnection(bent.GetOutputPort())
        measure.SetReferenceConnection(marked.GetOutputPort())
        measure.Update()
        row(measure.GetClassName(), measure)
    for method in ("DiscreteForms", "Isometric", "DeformationGradient", "Linear"):
        morph = vtkSurfaceMorph()
        getattr(morph, "SetMethodTo" + method)()
        morph.AddInputConnection(marked.GetOutputPort())
        morph.AddInputConnection(bent.GetOutputPort())
        morph.SetParameter(0.5)
        morph.Update()
        row("vtkSurfaceMorph, " + method, morph)


main()
