# SPDX-License-Identifier: BSD-3-Clause
"""All deformation methods on the four standard cases of Botsch and Sorkine, On Linear
Variational Surface Deformation Methods (2008): pictures in one sheet, and what was
measured. Run by Utilities/demo.sh --compare in pvpython; the argument is the build
folder. Its folder demo gets comparison.png, comparison.csv and comparison.md.

Shapes, handles and sizes are not the survey's."""
import csv
import math
import os
import sys
import time
from dataclasses import dataclass

import numpy
from vtkcartan import (vtkAsRigidAsPossibleDeformation, vtkHandleMotion, vtkLaplacianDeformation,
                    vtkMultiresolutionDeformation, vtkPoissonDeformation,
                    vtkPyramidDeformation, vtkRotationInvariantDeformation,
                    vtkShapePreservingDeformation, vtkSimilarityDeformation)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

import shapes
from measures import measure, roughness
from pictures import (Panel, camera_for, draw, heading, one_below_the_other, side_by_side,
                      write_sheet)
from tableone import cartan_testing, mark_ends, mark_parts, points_of

# The rows that no method makes, that times are compared with, and that need a closed
# surface.
EXACT, UNIT, OFFSET = "even twist, round bend", "Shape Preserving", "Shape Preserving, offset"
# Name, class, and what to set: the end of a setter's name, and its arguments.
METHODS = (
    ("Rotation Invariant", vtkRotationInvariantDeformation, {}),
    (UNIT, vtkShapePreservingDeformation, {"VolumeCorrectionToNone": ()}),
    (OFFSET, vtkShapePreservingDeformation,
     {"VolumeCorrectionToNeutralOffset": ()}),
    ("Poisson, harmonic", vtkPoissonDeformation, {"PropagationToHarmonic": ()}),
    ("Poisson, geodesic", vtkPoissonDeformation, {"PropagationToGeodesic": ()}),
    ("Similarity", vtkSimilarityDeformation, {}),
    ("Similarity, 3 re-fits", vtkSimilarityDeformation, {"Refits": (3,)}),
    ("Laplacian, naive", vtkLaplacianDeformation, {"RotationsToNone": ()}),
    ("Laplacian, estimated", vtkLaplacianDeformation, {"RotationsToEstimated": ()}),
    ("Laplacian, implicit", vtkLaplacianDeformation, {"RotationsToImplicit": ()}),
    ("Multiresolution", vtkMultiresolutionDeformation, {}),
    ("As Rigid, spokes", vtkAsRigidAsPossibleDeformation, {"EnergyToSpokes": ()}),
    ("As Rigid, spokes and rims", vtkAsRigidAsPossibleDeformation,
     {"EnergyToSpokesAndRims": ()}),
    # Within 1 % of the least energy.
    ("As Rigid, smoothed", vtkAsRigidAsPossibleDeformation,
     {"EnergyToSmoothedRotations": (), "MaximumIterations": (20,)}),
    ("Pyramid", vtkPyramidDeformation, {}),
)
# Times are the least of so many: other work on the machine only adds to them.
SETUPS, MOTIONS = 2, 5
COLUMNS = ("edges, rms", "edges, max", "area", "volume", "curvature", "roughness", "set-up",
           "motion")
WIDTH, HEIGHT, LABEL = 540, 420, 420
X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)


@dataclass
class Case:
    """A surface and the motion of its handle 2. `exact`: the even twist or round bend
    that does the same to the handles, where there is one, as a map of points."""
    name: str
    rest: object
    angle: float
    axis: tuple
    center: tuple
    translation: tuple
    view_from: tuple
    view_up: tuple
    exact: object = None

    def move(self, motion, part):
        motion.SetAxis(*self.axis)
        motion.SetCenter(*self.center)
        motion.SetAngle(part * self.angle)
        motion.SetTranslation(*(part * length for length in self.translation))


def twisted_bar():
    length, low, high = 5.5, 0.5, 5.0
    rest = mark_ends(cartan_testing.bar(16, 16, 88, 1, 1, length), 2, low / length,
                     high / length)

    def exact(points):
        angle = numpy.radians(135) * numpy.clip((points[:, 2] - low) / (high - low), 0, 1)
        x, y = points[:, 0] - 0.5, points[:, 1] - 0.5
        return numpy.stack([0.5 + numpy.cos(angle) * x - numpy.sin(angle) * y,
                            0.5 + numpy.sin(angle) * x + numpy.cos(angle) * y,
                            points[:, 2]], axis=1)

    return Case("bar twisted by 135\u00b0", rest, 135, Z, (0.5, 0.5, 0), (0, 0, 0),
                (0.5, -1, 0.2), X, exact)


def bent_cylinder():
    length, low, high = 5, 0.5, 4.5
    rest = mark_parts(*shapes.cylinder(length, 75, 64), low / length, high / length)
    total = math.radians(120)
    radius = (high - low) / total

    def exact(points):
        """The middle becomes an arc of a circle of this radius around (low, radius, 0)."""
        angle = total * numpy.clip((points[:, 0] - low) / (high - low), 0, 1)
        beyond = points[:, 0] - low - radius * angle
        outside = radius - points[:, 1]
        return numpy.stack([
            low + outside * numpy.sin(angle) + beyond * numpy.cos(angle),
            radius - outside * numpy.cos(angle) + beyond * numpy.sin(angle), points[:, 2]],
            axis=1)

    # The moving end turns about where its middle is at rest, then goes to the arc's end.
    end = exact(numpy.array([[high, 0.0, 0.0]]))[0]
    return Case("cylinder bent by 120\u00b0", rest, 120, Z, (high, 0, 0),
                tuple(end - (high, 0, 0)), (0.1, -0.35, 1), Y, exact)


def bent_cactus():
    rest, heights = shapes.cactus()
    # The arms, which are as high as the trunk, are free.
    arms = abs(points_of(rest)[:, 0]) > 0.13
    mark_parts(rest, numpy.where(arms, 0.5, heights), 0.1, 0.92)
    # Turning about the middle moves the top less than a circular bend would.
    return Case("cactus bent by 70\u00b0", rest, 70, Z, (-0.03, -0.1, 0), (0, 0, 0),
                (0.1, 0.1, 1), Y)


def pulled_plane():
    rest, distances = shapes.bumpy_plane(201)
    mark_parts(rest, 1 - distances, 0.1, 0.85)
    return Case("bumpy plane pulled up", rest, 0, Z, (0, 0, 0), (0, 0, 1.2), (0.25, -1, 0.45), Z)


def deformed(case, method, settings):
    """The surface, and the seconds of the set-up and of a motion after it."""
    setups, motions = [], []
    for _ in range(SETUPS):
        motion = vtkHandleMotion()
        deform = method()
        deform.SetInputData(case.rest)
        deform.SetHandleMotion(2, motion)
        for name, arguments in settings.items():
            getattr(deform, "Set" + name)(*arguments)
        seconds = []
        for part in numpy.linspace(0.8, 1, 1 + MOTIONS):
            case.move(motion, part)
            start = time.perf_counter()
            deform.Update()
            seconds.append(time.perf_counter() - start)
        # The first update sets up and moves, the others move.
        setups.append(seconds[0])
        motions += seconds[1:]
    return deform.GetOutput(), min(setups) - min(motions), min(motions)


def moved(case):
    """The surface after the exact deformation."""
    result = vtkPolyData()
    result.DeepCopy(case.rest)
    points = vtk_to_numpy(result.GetPoints().GetData())
    points[:] = case.exact(points)
    return result


def figures(case, surface):
    """Those of COLUMNS that tell of the shape."""
    measured = measure(case.rest, surface)
    return [measured.edges, measured.longest, measured.area, measured.volume,
            measured.curvature, roughness(case.rest, surface)]


@dataclass
class Result:
    """A row of a case's table. Without a surface, there is nothing to compare."""
    name: str
    surface: object = None
    figures: list = (math.nan,) * 6
    setup: float = math.nan
    motion: float = math.nan


def results(case):
    """A result per row of the sheet; the times are in seconds."""
    if case.exact:
        surface = moved(case)
        yield Result(EXACT, surface, figures(case, surface))
    else:
        yield Result(EXACT)
    closed = not math.isnan(measure(case.rest, case.rest).volume)
    for name, method, settings in METHODS:
        if name == OFFSET and not closed:
            yield Result(name)
            continue
        surface, setup, motion = deformed(case, method, settings)
        yield Result(name, surface, figures(case, surface), setup, motion)


FORMATS = ("{:.3f}", "{:.2f}", "{:+.3f}", "{:+.3f}", "{:.3f}", "{:.2f}", "{:.1f}", "{:.1f}")


def text(form, value):
    return "" if math.isnan(value) else form.format(value)


def write_tables(cases, table, folder):
    """comparison.csv with seconds, comparison.md with ratios to those of UNIT."""
    with open(os.path.join(folder, "comparison.csv"), "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(("case", "method", *COLUMNS[:-2], "set-up, s", "motion, s"))
        for case, rows in zip(cases, table):
            for row in rows:
                numbers = (*row.figures, row.setup, row.motion)
                writer.writerow((case.name, row.name, *("" if math.isnan(number) else
                                                        f"{number:.6g}" for number in numbers)))
    lines = []
    for case, rows in zip(cases, table):
        unit = next(row for row in rows if row.name == UNIT)
        lines += [f"{case.name}, {case.rest.GetNumberOfPoints():,} points", "",
                  "| method | " + " | ".join(COLUMNS) + " |", "|---" * 9 + "|"]
        for row in rows:
            if row.surface:
                numbers = (*row.figures, row.setup / unit.setup, row.motion / unit.motion)
                lines.append(f"| {row.name} | " + " | ".join(map(text, FORMATS, numbers)) + " |")
        lines.append("")
    tables = "\n".join(lines)
    with open(os.path.join(folder, "comparison.md"), "w", encoding="utf-8") as file:
        file.write(tables)
    print(tables)
    print("edges, area, volume: relative changes; curvature: rms of the change of mean curvature "
          "(1 / length);\nroughness: rms angle between the rotations of adjacent triangles "
          f"(degrees);\nset-up, motion: times over those of {UNIT}")


def pictures_of(case, rows):
    """A picture per result, all seen by the camera that shows what most do: what falls
    apart may leave the picture."""
    size = (WIDTH, HEIGHT)
    shown = case.exact and moved(case) or rows[1].surface
    points = numpy.concatenate([points_of(case.rest), points_of(shown)])
    camera = camera_for(case.view_from, case.view_up, points, size, 0.1, 0.02)
    yield draw(Panel("", f"{case.rest.GetNumberOfPoints():,} points", case.rest), camera, size)
    for row in rows:
        if row.surface:
            edges, *_, rough = row.figures
            note = f"edges {100 * edges:.1f} %, roughness {rough:.1f}\u00b0"
            yield draw(Panel("", note, row.surface), camera, size)
        else:
            yield heading("", size)


def main(build):
    folder = os.path.join(build, "demo")
    os.makedirs(folder, exist_ok=True)
    cases = [make() for make in (twisted_bar, bent_cylinder, bent_cactus, pulled_plane)]
    table = []
    for case in cases:
        print(case.name, flush=True)
        table.append(list(results(case)))
    write_tables(cases, table, folder)
    columns = [one_below_the_other([heading(name, (LABEL, HEIGHT)) for name in
                                    ("at rest", *(row.name for row in table[0]))])]
    for case, rows in zip(cases, table):
        columns.append(one_below_the_other(list(pictures_of(case, rows))))
    top = side_by_side([heading(text, (width, 70)) for text, width in
                        (("", LABEL), *((case.name, WIDTH) for case in cases))])
    write_sheet(one_below_the_other([top, side_by_side(columns)]), folder, "comparison",
                quality=85)


if __name__ == "__main__":
    main(sys.argv[1])
