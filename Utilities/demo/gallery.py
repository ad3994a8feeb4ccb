# SPDX-License-Identifier: BSD-3-Clause
"""Reproduces figures of Lipman, Cohen-Or, Gal and Levin, Volume and Shape
Preservation via Moving Frame Manipulation (2007): what vtkShapePreservingDeformation
does that methods before it did not. Run by Utilities/demo.sh in pvpython; the
argument is the build folder. The pictures and gallery.png, a sheet of all, appear in
its folder demo.

The paper does not say where its handles are. Here they are the ends of the surfaces,
and the turned end finds its own place, as in the paper's bends."""
import os
import sys
from dataclasses import dataclass, replace

import numpy
from vtkcartan import (vtkHandleMotion, vtkRotationInvariantDeformation,
                    vtkShapePreservingDeformation)
from vtkmodules.vtkIOImage import vtkPNGWriter

import shapes
from measures import measure
from pictures import (Panel, camera_for, draw, heading, legend, one_below_the_other,
                      side_by_side, write, write_sheet)
from shapes import cartan_testing
from tableone import mark_ends, mark_parts, marked_armadillo, points_of

WIDTH, HEADING, LEGEND = 700, 70, 90
CURVATURE = 2.0  # where colors end, in 1 / length
X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
# How the volume is kept: title, VolumeCorrection, CloseVolume.
CORRECTIONS = (("no correction", "None", False), ("neutral offset", "NeutralOffset", False),
               ("offset and closed", "NeutralOffset", True))


@dataclass
class Figure:
    """Panels seen by cameras of the same direction and scale; where panels show the
    whole of their surfaces, by the same camera."""
    name: str
    heading: str
    panels: list
    view_from: tuple
    view_up: tuple
    height: int
    details: list = None  # what to show of each panel, as points

    def picture(self):
        size = (WIDTH, self.height)
        # Captions have the same height on panels of any height.
        caption = 60 / self.height
        whole = numpy.concatenate([points_of(panel.surface) for panel in self.panels])
        cameras = [camera_for(self.view_from, self.view_up, points, size, caption, caption)
                   for points in self.details or [whole] * len(self.panels)]
        scale = max(camera[-1] for camera in cameras)
        row = side_by_side([draw(panel, (*camera[:-1], scale), size)
                            for panel, camera in zip(self.panels, cameras)])
        return one_below_the_other([heading(self.heading, (len(self.panels) * WIDTH, HEADING)),
                                    row])


def turned(surface, axis, angle, correction="None", close=False,
           method=vtkShapePreservingDeformation, uniform_positions=False):
    """The surface after a turn of handle 2, whose position is free."""
    motion = vtkHandleMotion()
    motion.SetAxis(*axis)
    motion.SetAngle(angle)
    deform = method()
    deform.SetInputData(surface)
    deform.SetHandleMotion(2, motion)
    deform.ConstrainHandlePositionsOff()
    if uniform_positions:
        deform.SetPositionWeightsToUniform()
    getattr(deform, "SetVolumeCorrectionTo" + correction)()
    deform.SetCloseVolume(close)
    deform.Update()
    return deform.GetOutput()


def percent(value, digits=1):
    """With a sign, and without one where nothing is left."""
    text = f"{100 * value:+.{digits}f}"
    if float(text) == 0:
        text = text[1:]
    return text.replace("-", "\u2212") + " %"


def panel(title, rest, surface):
    """Says what happened to volume and lengths."""
    measured = measure(rest, surface)
    note = f"volume {percent(measured.volume)}, edges {100 * measured.edges:.1f} % rms"
    return Panel(title, note, surface)


def corrected(rest, axis, angle, choices=CORRECTIONS, **others):
    return [panel(title, rest, turned(rest, axis, angle, correction, close, **others))
            for title, correction, close in choices]


def at_rest(surface):
    return Panel("at rest", f"{surface.GetNumberOfPoints():,} points", surface)


def trunk():
    rest = mark_parts(*shapes.trunk(), 0.08, 0.97)
    curled = turned(rest, Z, 360, "NeutralOffset")
    return Figure("fig01-trunk", "Fig. 1: the tip of a trunk turned by 360\u00b0 in one step",
                  [at_rest(rest), panel("curled up", rest, curled)], (0.1, 0.25, 1), Y, 560)


def wound_bar():
    rest = mark_parts(*shapes.studded_bar(16, 16), 0.1, 0.9)
    # The axis leans, so that the bar passes beside itself.
    panels = [panel(f"{angle}\u00b0", rest, turned(rest, (0, 1, 0.2), angle, "NeutralOffset"))
              for angle in (270, 540)]
    return Figure("fig05-wound-bar",
                  "Fig. 5: a bar wound up by 270\u00b0 and by 540\u00b0, each in one step", panels,
                  (0.5, 1, 0.3), X, 560)


def compared_bar():
    """Two methods, colored by the change of mean curvature; then a part of each."""
    rest = mark_parts(*shapes.studded_bar(6, 24), 0.15, 0.85)
    place = points_of(rest)
    middle = (abs(place[:, 2] - 3) < 0.7) & (place[:, 1] < -0.45)
    panels, details = [], []
    for title, method in (("Rotation Invariant, 2005", vtkRotationInvariantDeformation),
                          ("Shape Preserving, 2007", vtkShapePreservingDeformation)):
        measured = measure(rest, turned(rest, Y, 170, method=method))
        panels.append(Panel(title, f"mean curvature off by {measured.curvature:.2f} rms, "
                            f"edges by {100 * measured.edges:.1f} %", measured.surface,
                            "MeanCurvatureError", CURVATURE))
        details.append(points_of(measured.surface)[middle])
    closer = [replace(panel, note="") for panel in panels]
    return (Figure("fig08-curvature", "Fig. 8: a bar of width 1 bent by 170\u00b0", panels,
                   (0.15, -1, 0.25), X, 560),
            Figure("fig08-curvature-closer", "The dome in the middle", closer,
                   (0.15, -1, 0.25), X, 560, details))


def twisted_bar():
    rest = mark_ends(cartan_testing.bar(16, 16, 80, 1, 1, 5), 2, 0.1, 0.9)
    return Figure("fig12-twisted-bar", "Fig. 12: a bar twisted by 720\u00b0 in one step",
                  [at_rest(rest)] + corrected(rest, Z, 720), (0, -1, 0.3), X, 320)


def bent_bar():
    rest = mark_ends(cartan_testing.bar(12, 12, 96, 1, 1, 8), 2, 0.16, 0.84)
    axis = (0, 1, 0.3)
    stepwise = rest
    for _ in range(3):
        stepwise = turned(stepwise, axis, 130, method=vtkRotationInvariantDeformation)
    return Figure("fig14-bent-bar", "Fig. 14: a bar bent by 390\u00b0 in three steps, and in one",
                  [panel("Rotation Invariant, three steps", rest, stepwise)]
                  + corrected(rest, axis, 390), (0.3, -1, 0.5), X, 520)


def armadillo(name, title, axis, angle, view_from):
    rest = marked_armadillo()
    # As in Table I.
    panels = corrected(rest, axis, angle, CORRECTIONS[:2], uniform_positions=True)
    return Figure(name, title, panels, view_from, Y, 620)


def main(build):
    folder = os.path.join(build, "demo")
    os.makedirs(folder, exist_ok=True)
    rows = [
        (trunk(), wound_bar()),
        compared_bar(),
        (twisted_bar(),),
        (bent_bar(),),
        (armadillo("fig15-bent-armadillo", "Fig. 15: the armadillo bent by 180\u00b0", X, 180,
                   (-1, 0.2, -0.6)),
         armadillo("fig16-twisted-armadillo", "Fig. 16: the armadillo twisted by 160\u00b0", Y,
                   160, (0.3, 0.2, -1))),
    ]
    sheet = []
    for figures in rows:
        pictures = []
        for figure in figures:
            print(figure.heading)
            for panel in figure.panels:
                print(f"    {panel.title:32}{panel.note}")
            pictures.append(figure.picture())
            write(vtkPNGWriter(), pictures[-1], os.path.join(folder, figure.name + ".png"))
        sheet.append(side_by_side(pictures))
        first = figures[0].panels[0]
        if first.array == "MeanCurvatureError":
            sheet.append(legend(first, "change of mean curvature (1 / length)",
                                (sheet[-1].GetDimensions()[0], LEGEND)))
    write_sheet(one_below_the_other(sheet), folder, "gallery", quality=88)


if __name__ == "__main__":
    main(sys.argv[1])
