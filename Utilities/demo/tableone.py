# SPDX-License-Identifier: BSD-3-Clause
"""Prints Table I of Lipman, Cohen-Or, Gal and Levin, Volume and Shape
Preservation via Moving Frame Manipulation (2007), with the paper's figures and
those of vtkShapePreservingDeformation side by side: how the volume of a bar and
of the armadillo changes when they are bent in one step, without and with each
volume correction.

    PYTHONPATH=<build>/lib/python3.11/site-packages CARTAN_MESH_DIR=<meshes> \\
        pvpython Utilities/demo/tableone.py

The paper gives no positions for its handles. Those here reproduce its column
without correction: the bar (1 x 1 x 5, 4400 triangles) is pinned at z <= .16 of
its length and turned at z >= .84 about y; the armadillo is pinned at y <= .3 of
its height and turned at y >= .8 about x. The handles' frames turn and the
surface finds its place from the pinned part, as in the paper's bends.
"""
import math
import os
import sys

import numpy
from vtkcartan import vtkHandleMotion, vtkShapePreservingDeformation
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)),
                                "..", "..", "Testing", "Python"))
import cartan_testing

# The ways to correct the volume: name, VolumeCorrection, CloseVolume.
CORRECTIONS = {
    "none": (vtkShapePreservingDeformation.NO_CORRECTION, False),
    "scaling": (vtkShapePreservingDeformation.FRAME_SCALING, False),
    "offset": (vtkShapePreservingDeformation.NEUTRAL_OFFSET, False),
    "closed": (vtkShapePreservingDeformation.NEUTRAL_OFFSET, True),
}


def mark_parts(surface, fraction, pinned, moving):
    """Marks points whose fraction is at most `pinned` as handle 1, and those whose
    fraction is at least `moving` as handle 2."""
    # The bar's points lie on the limits themselves.
    handles = numpy.where(fraction <= pinned + 1e-9, 1, 0)
    handles[fraction >= moving - 1e-9] = 2
    array = numpy_to_vtk(handles.astype(numpy.int32), deep=True)
    array.SetName("Handle")
    surface.GetPointData().AddArray(array)
    return surface


def mark_ends(surface, axis, pinned, moving):
    """Marks what lies below the part `pinned` of the extent along an axis as
    handle 1, and what lies above the part `moving` as handle 2."""
    heights = vtk_to_numpy(surface.GetPoints().GetData())[:, axis].astype(float)
    fraction = (heights - heights.min()) / (heights.max() - heights.min())
    return mark_parts(surface, fraction, pinned, moving)


def marked_bar():
    return mark_ends(cartan_testing.bar(10, 10, 50, 1, 1, 5), axis=2, pinned=.16, moving=.84)


def marked_armadillo():
    return mark_ends(cartan_testing.read_off("armadillo"), axis=1, pinned=.3, moving=.8)


def triangles_of(surface):
    return vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def points_of(surface):
    return vtk_to_numpy(surface.GetPoints().GetData()).astype(float)


def volume(surface):
    """The enclosed volume, about the first point so that no digits are lost."""
    points = points_of(surface)
    a, b, c = numpy.moveaxis((points - points[0])[triangles_of(surface)], 1, 0)
    return float((a * numpy.cross(b, c)).sum() / 6)


class Bend:
    """Turns handle 2 of a surface about an axis, its position free."""

    def __init__(self, surface, axis, uniform_positions):
        self.motion = vtkHandleMotion()
        self.motion.SetAxis(*axis)
        self.filter = vtkShapePreservingDeformation()
        self.filter.SetInputData(surface)
        self.filter.SetHandleMotion(2, self.motion)
        self.filter.ConstrainHandlePositionsOff()
        if uniform_positions:
            self.filter.SetPositionWeightsToUniform()

    def __call__(self, angle, correction):
        """The surface turned by an angle in radians, with one of CORRECTIONS."""
        self.motion.SetAngle(math.degrees(angle))
        kind, close = CORRECTIONS[correction]
        self.filter.SetVolumeCorrection(kind)
        self.filter.SetCloseVolume(close)
        self.filter.Update()
        return self.filter.GetOutput()


# The figures of the paper: the change of the volume, relative, without a sign.
# Model, axis, weights of the positions; then angle over pi, uncorrected, corrected.
TABLE = (
    ("bar", marked_bar, (0, 1, 0), False,
     ((1 / 2, .0473, .0027), (1, .143, .0033), (2, .37, .0017), (3, .53, .053))),
    ("armadillo", marked_armadillo, (1, 0, 0), True,
     ((1 / 4, .0164, .0066), (1 / 2, .0412, .0097), (1, .143, .0316), (3 / 2, .26, .0704))),
)


def rows():
    """One dictionary per row of the table: model, angle over pi, the paper's two
    figures, and the relative change of the volume for each of CORRECTIONS."""
    for model, make, axis, uniform_positions, published in TABLE:
        surface = make()
        rest = volume(surface)
        bend = Bend(surface, axis, uniform_positions)
        for turns, uncorrected, corrected in published:
            row = {"model": model, "angle": turns, "paper none": uncorrected,
                   "paper corrected": corrected}
            for name in CORRECTIONS:
                row[name] = volume(bend(turns * math.pi, name)) / rest - 1
            yield row


def main():
    print("Relative change of the volume; the paper's figures have no sign.\n")
    print("%-10s %8s | %11s %8s | %9s %8s %8s %8s" % (
        "", "", "uncorrected", "", "corrected", "frame", "neutral", "offset,"))
    print("%-10s %8s | %11s %8s | %9s %8s %8s %8s" % (
        "model", "rotation", "paper", "ours", "paper", "scaling", "offset", "closed"))
    print("-" * 20 + "+" + "-" * 22 + "+" + "-" * 37)
    for row in rows():
        print("%-10s %5.2f pi | %11.4f %+8.4f | %9.4f %+8.4f %+8.4f %+8.0e" % (
            row["model"], row["angle"], row["paper none"], row["none"], row["paper corrected"],
            row["scaling"], row["offset"], row["closed"]), flush=True)


if __name__ == "__main__":
    main()
