# SPDX-License-Identifier: BSD-3-Clause
"""Prints how long each filter is silent at most, and so how long an abort waits, on a scanned
surface of 416,002 points; and whether its progress ever runs back.

Run it with pvpython and the variables of the tests, CARTAN_MESH_DIR and PYTHONPATH. Times
are those of the processor, so that other programs do not count; names of filters restrict it:
progress.py vtkPoissonDeformation.
"""
import sys
import time

import vtkcartan
from vtkcartan import vtkHandleMotion

import scan

DEFORMATIONS = ("RotationInvariant", "ShapePreserving", "Poisson", "AsRigidAsPossible", "Pyramid",
                "Multiresolution", "Laplacian", "Similarity")


class Watch:
    """Listens to a filter's progress."""

    def __init__(self, name, filter):
        self.name, self.longest, self.at, self.back, self.value = name, 0.0, 0.0, 0, 0.0
        self.filter = filter
        filter.AddObserver("ProgressEvent", self.hear)
        self.begin = self.last = time.process_time()
        filter.Update()
        self.hear()
        print(f"{name:34s} {time.process_time() - self.begin:8.1f} s, longest silence "
              f"{self.longest:5.2f} s after {100 * self.at:3.0f} %"
              f"{', runs back ' + str(self.back) + ' times' if self.back else ''}", flush=True)

    def hear(self, *_):
        now, value = time.process_time(), self.filter.GetProgress()
        if now - self.last > self.longest:
            self.longest, self.at = now - self.last, self.value
        self.back += value < self.value - 1e-9
        self.last, self.value = now, value


def chosen(name):
    return len(sys.argv) < 2 or name.split(",")[0] in sys.argv[1:]


def watch(name, filter):
    if chosen(name):
        Watch(name, filter)


def main():
    fine = scan.armadillo(2)
    print(f"{fine.GetOutput().GetNumberOfPoints()} points")
    first = scan.mark_heights(fine, 1, -0.1, 0.1)
    if chosen("vtkMarkHandle"):
        Watch("vtkMarkHandle", first)
    first.Update()
    marked = scan.mark_heights(first, 2, 0.9, 1.1)
    marked.Update()
    motion = vtkHandleMotion()
    motion.SetAxis(1, 0, 0)
    motion.SetAngle(20)
    for method in DEFORMATIONS:
        name = f"vtk{method}Deformation"
        if chosen(name):
            filter = getattr(vtkcartan, name)()
            filter.SetInputConnection(marked.GetOutputPort())
            filter.SetHandleMotion(2, motion)
            Watch(name, filter)
    bent = vtkcartan.vtkRotationInvariantDeformation()
    bent.SetInputConnection(marked.GetOutputPort())
    bent.SetHandleMotion(2, motion)
    bent.Update()
    for kind in ("vtkCurvatureError", "vtkVolumeChange"):
        measure = getattr(vtkcartan, kind)()
        measure.SetInputConnection(bent.GetOutputPort())
        measure.SetReferenceConnection(marked.GetOutputPort())
        watch(kind, measure)
    for kind in ("vtkDiscreteForms", "vtkPrepareSurface"):
        tool = getattr(vtkcartan, kind)()
        tool.SetInputConnection(marked.GetOutputPort())
        watch(kind, tool)
    for method in ("DiscreteForms", "Isometric", "DeformationGradient", "Linear"):
        morph = vtkcartan.vtkSurfaceMorph()
        getattr(morph, "SetMethodTo" + method)()
        morph.AddInputConnection(marked.GetOutputPort())
        morph.AddInputConnection(bent.GetOutputPort())
        morph.SetParameter(0.5)
        watch("vtkSurfaceMorph, " + method, morph)


main()
