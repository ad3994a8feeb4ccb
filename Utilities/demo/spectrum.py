# SPDX-License-Identifier: BSD-3-Clause
"""Reproduces figures 4, 5 and 7, 8 and 9 of Sorkine, Differential Representations for Mesh
Processing (2006), on scanned surfaces scaled to unit bounding-box diagonal, draws a few modes,
and bits and errors of compressed surfaces and of Draco. Run by Utilities/demo.sh --spectrum
in pvpython; the argument is the build folder. spectrum.png, a sheet of all, appears in its
folder demo."""
import os
import sys

import numpy
from vtkcartan import vtkHighPassQuantization, vtkLaplacianSpectrum, vtkLeastSquaresMesh
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

from pictures import (Panel, camera_for, draw, heading, one_below_the_other, side_by_side,
                      write_sheet)
from rates import rate_charts
import cartan_testing

SIZE, HEADING = (560, 560), 60
FRONT, UP = (0.9, 0.25, 0.55), (0, 1, 0)


def points_of(surface):
    return vtk_to_numpy(surface.GetPoints().GetData())


def scan(name):
    """A surface of unit diagonal, with the arrays that panels expect."""
    surface = cartan_testing.read_off(name)
    points = points_of(surface)
    points /= numpy.linalg.norm(points.max(axis=0) - points.min(axis=0))
    return shown(surface)


def shown(surface, array=None, values=None):
    """A copy with the handle 0 everywhere and maybe another array."""
    result = vtkPolyData()
    result.DeepCopy(surface)
    count = result.GetNumberOfPoints()
    for name, numbers in (("Handle", numpy.zeros(count, dtype=numpy.int32)), (array, values)):
        if name:
            column = numpy_to_vtk(numpy.ascontiguousarray(numbers), deep=True)
            column.SetName(name)
            result.GetPointData().AddArray(column)
    return result


def rms(surface, original):
    """Of the distance to the original's points, in parts of the diagonal."""
    difference = points_of(surface) - points_of(original)
    return numpy.sqrt((difference ** 2).sum(axis=1).mean())


def approximation(title, original, surface):
    return Panel(title, f"{rms(surface, original):.4f} rms", shown(surface))


def at_rest(surface):
    return Panel("original", f"{surface.GetNumberOfPoints():,} points", surface)


def updated(filter_class, surface, **values):
    made = filter_class()
    made.SetInputData(surface)
    for name, value in values.items():
        getattr(made, "Set" + name)(value)
    made.Update()
    return made


def spectral(surface, counts):
    made = updated(vtkLaplacianSpectrum, surface, NumberOfModes=max(counts))
    for count in counts:
        made.SetApproximationModes(count)
        made.Update()
        yield approximation(f"{count} modes", surface, made.GetOutput())


def geometry_aware(surface, counts):
    for count in counts:
        made = updated(vtkLeastSquaresMesh, surface, NumberOfAnchors=count)
        made.SetAnchorSelectionToGreedy()
        made.Update()
        yield approximation(f"{count} anchors", surface, made.GetOutput())


def rounded(surface, bits):
    """The surface with its positions rounded to so many bits."""
    result = shown(surface)
    points = points_of(result)
    low = points.min(axis=0)
    step = (points.max(axis=0) - low).max() / (2 ** bits - 1)
    points[:] = low + numpy.round((points - low) / step) * step
    return Panel(f"positions, {bits} bits", f"{rms(result, surface):.4f} rms", result)


def quantized(surface, bits):
    made = updated(vtkHighPassQuantization, surface, Bits=bits)
    panel = approximation(f"differences, {bits} bits", surface, made.GetOutput())
    panel.note += f", {made.GetBitsPerPoint():.1f} bits/point"
    return panel


def visual_errors(surface, anchors):
    for count in anchors:
        made = updated(vtkHighPassQuantization, surface, Bits=7, NumberOfAnchors=count)
        output = made.GetOutput()
        errors = vtk_to_numpy(output.GetPointData().GetArray("VisualError"))
        yield Panel(f"{count} anchors", f"{numpy.abs(errors).max():.4f} at most",
                    shown(output), "VisualError", 0.002)


def modes(surface, which):
    made = updated(vtkLaplacianSpectrum, surface, NumberOfModes=max(which) + 1)
    made.SetOperatorToCotangent()
    made.SetApproximationToNone()
    made.GenerateModesOn()
    made.Update()
    columns = vtk_to_numpy(made.GetOutput().GetPointData().GetArray("Modes"))
    table = made.GetSpectrumTable()
    for k in which:
        mode = columns[:, k] / numpy.abs(columns[:, k]).max()
        eigenvalue = table.GetValueByName(k, "Eigenvalue").ToDouble()
        yield Panel(f"mode {k}", f"eigenvalue {eigenvalue:.0f}", shown(surface, "Mode", mode),
                    "Mode", 1.0)


def figure(title, panels, reference, view=FRONT):
    """A row of panels, all seen as the reference is."""
    panels = list(panels)
    camera = camera_for(view, UP, points_of(reference), SIZE, 0.11, 0.11)
    row = side_by_side([draw(panel, camera, SIZE) for panel in panels])
    for panel in panels:
        print(f"{title}: {panel.title}: {panel.note}")
    return one_below_the_other([heading(title, (len(panels) * SIZE[0], HEADING)), row])


def rates(surfaces):
    """A row of two charts per surface, as wide as five panels."""
    size = (5 * SIZE[0] // (2 * len(surfaces)), 560)
    title = "Bits per point at equal error: compressed surfaces and Draco"
    return one_below_the_other([
        heading(title, (5 * SIZE[0], HEADING)),
        side_by_side([chart for name, surface in surfaces
                      for chart in rate_charts(name, surface, size)])])


def main(build):
    folder = os.path.join(build, "demo")
    elephant, camel, armadillo = scan("elephant"), scan("camel"), scan("armadillo")
    sheet = one_below_the_other([
        figure("Fig. 4: progressive approximation by the modes of the graph",
               [*spectral(elephant, (10, 20, 100, 500)), at_rest(elephant)], elephant),
        figure("Figs. 5 and 7: as many modes, and anchors that know the geometry",
               [*spectral(camel, (100, 500)), *geometry_aware(camel, (100, 500)), at_rest(camel)],
               camel),
        figure("Fig. 8: rounded positions, and rounded differential coordinates",
               [rounded(camel, 7), rounded(camel, 8), quantized(camel, 5), quantized(camel, 7),
                at_rest(camel)], camel),
        figure("Fig. 9: visual error of 7 bits, outwards red, inwards blue",
               [*visual_errors(camel, (2, 4, 20, 100)), at_rest(camel)], camel),
        figure("Modes of the cotangent Laplacian", modes(armadillo, (1, 3, 8, 20, 60)), armadillo,
               (0.2, 0.1, -1)),
        rates([("elephant", elephant), ("camel", camel)]),
    ])
    write_sheet(sheet, folder, "spectrum")


if __name__ == "__main__":
    main(sys.argv[1])
