#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Times every method of two builds against each other, as Utilities/benchmark.sh --against
does:

    Utilities/compare_times.py OLD NEW [runs]

OLD and NEW are build folders with the Python module. Prints a table of Markdown: for each
method the first update and a motion, in milliseconds of processor time, old and new, and the
ratio of new to old. Each build runs so many times (default 3), in turn with the other, each
method in a process of its own on one thread, with three filters one after the other, each on a
copy of the surface; the least time counts, because other work on the machine and the loading of
libraries only add to it.

The surface is the armadillo of libcgal-demo, subdivided once (104,002 points), pinned at its
feet and turned at its head; morphs play between it and its bent pose.
"""
import importlib
import os
import subprocess
import sys
import time
from pathlib import Path

DEFORMATIONS = {
    "Rotation Invariant": ("RotationInvariant", {}),
    "Rotation Invariant, frames not projected":
        ("RotationInvariant", {"FrameProjectionToNone": ()}),
    "Shape Preserving": ("ShapePreserving", {"VolumeCorrectionToNone": ()}),
    "Shape Preserving, offset": ("ShapePreserving", {"VolumeCorrectionToNeutralOffset": ()}),
    "Poisson, harmonic": ("Poisson", {"PropagationToHarmonic": ()}),
    "Poisson, geodesic": ("Poisson", {"PropagationToGeodesic": ()}),
    "Similarity": ("Similarity", {}),
    "Similarity, 3 re-fits": ("Similarity", {"Refits": (3,)}),
    "Laplacian, naive": ("Laplacian", {"RotationsToNone": ()}),
    "Laplacian, estimated": ("Laplacian", {"RotationsToEstimated": ()}),
    "Multiresolution": ("Multiresolution", {}),
    "As Rigid, spokes": ("AsRigidAsPossible", {"EnergyToSpokes": ()}),
    "As Rigid, spokes and rims": ("AsRigidAsPossible", {"EnergyToSpokesAndRims": ()}),
    "As Rigid, smoothed": ("AsRigidAsPossible", {"EnergyToSmoothedRotations": ()}),
}
MORPHS = ("DiscreteForms", "Isometric", "DeformationGradient", "Linear")
MEASURES = ("CurvatureError", "VolumeChange")
MOTIONS = 4
FILTERS = 3


def names():
    return [*DEFORMATIONS, *("Morph, " + morph for morph in MORPHS), *MEASURES]


class Classes:
    """The classes of the build on the path, whose package was once named otherwise."""

    def __getattr__(self, name):
        for package in ("vtkcartan", "cartan"):
            try:
                return getattr(importlib.import_module(package), name)
            except ImportError:
                pass
        raise AttributeError(name)


def surface():
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    from vtkmodules.vtkFiltersModeling import vtkLinearSubdivisionFilter
    import cartan_testing

    fine = vtkLinearSubdivisionFilter()
    fine.SetInputData(cartan_testing.read_off(
        os.path.join(os.environ["CARTAN_MESH_DIR"], "armadillo.off")))
    fine.Update()
    result = fine.GetOutput()
    heights = vtk_to_numpy(result.GetPoints().GetData())[:, 1]
    low, high = heights.min(), heights.max()
    parts = (heights - low) / (high - low)
    handles = numpy_to_vtk((1 * (parts < 0.1) + 2 * (parts > 0.9)).astype("int32"), deep=True)
    handles.SetName("Handle")
    result.GetPointData().AddArray(handles)
    return result


def bending(classes, rest, kind, settings):
    """The filter, and its motion, which turns handle 2."""
    motion = classes.vtkHandleMotion()
    motion.SetAxis(1, 0, 0)
    motion.SetCenter(*(sum(rest.GetBounds()[2 * i:2 * i + 2]) / 2 for i in range(3)))
    filter = getattr(classes, f"vtk{kind}Deformation")()
    filter.SetInputData(rest)
    filter.SetHandleMotion(2, motion)
    for name, arguments in settings.items():
        getattr(filter, "Set" + name)(*arguments)
    return filter, motion


def copied(surface):
    """The surface with nothing kept for it: a mesh travels with the data set it was read from."""
    copy = surface.NewInstance()
    copy.DeepCopy(surface)
    return copy


def prepared(name, rest):
    """A fresh filter of that name, and what changes its next update to that number."""
    classes = Classes()
    if name in DEFORMATIONS:
        filter, motion = bending(classes, rest, *DEFORMATIONS[name])
        return filter, lambda i: motion.SetAngle(20 + 5 * i)
    bend, motion = bending(classes, rest, "ShapePreserving", {})
    motion.SetAngle(40)
    bend.Update()
    if name in MEASURES:
        filter = getattr(classes, "vtk" + name)()
        filter.SetInputConnection(bend.GetOutputPort())
        filter.SetInputDataObject(1, rest)

        def move(i):
            motion.SetAngle(40 + i)
            bend.Update()

        return filter, move
    filter = classes.vtkSurfaceMorph()
    getattr(filter, "SetMethodTo" + name.split(", ")[1])()
    filter.AddInputDataObject(rest)
    filter.AddInputConnection(bend.GetOutputPort())
    return filter, lambda i: filter.SetParameter(0.2 + 0.1 * i)


def measure(name):
    """Prints the milliseconds of the first update and of a motion."""
    rest = surface()
    first = motion = float("inf")
    for _ in range(FILTERS):
        filter, change = prepared(name, copied(rest))
        times = []
        for i in range(1 + MOTIONS):
            change(i)
            start = time.process_time()
            filter.Update()
            times.append(1e3 * (time.process_time() - start))
        first = min(first, times[0])
        motion = min(motion, *times[1:])
    print(first, motion)


def run(build, name):
    tests = Path(__file__).resolve().parent.parent / "Testing" / "Python"
    packages = next(Path(build).glob("lib*/python3*/site-packages"))
    environment = dict(os.environ, OMP_NUM_THREADS="1", PYTHONPATH=f"{packages}:{tests}",
                       CARTAN_MESH_DIR=str(Path(build) / "MeshData"))
    output = subprocess.run(["pvpython", __file__, name], env=environment, check=True,
                            capture_output=True, text=True).stdout
    return [float(number) for number in output.split()[-2:]]


def main():
    if len(sys.argv) == 2:
        measure(sys.argv[1])
        return
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    builds = sys.argv[1:3]
    runs = int(sys.argv[3]) if len(sys.argv) == 4 else 3
    print("| method | first update, old | new | ratio | motion, old | new | ratio |\n"
          "|---|---|---|---|---|---|---|")
    for name in names():
        least = [[float("inf")] * 2, [float("inf")] * 2]
        for _ in range(runs):
            for which, build in enumerate(builds):
                least[which] = [min(pair) for pair in zip(least[which], run(build, name))]
        cells = []
        for old, new in zip(*least):
            cells += [f"{old:.1f}", f"{new:.1f}", f"{new / old:.2f}" if old > 0.05 else ""]
        print("| " + " | ".join([name, *cells]) + " |", flush=True)


main()
