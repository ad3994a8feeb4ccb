# SPDX-License-Identifier: BSD-3-Clause
"""How many bits per point files of compressed surfaces and of Draco take at which error: the
root mean squares of the angle between triangles, by area, and of the visual error of Karni and
Gotsman (alpha .15). Neither keeps the order of points. Drawn as two charts."""
import os
import subprocess
import tempfile

import numpy
from vtkcartan import vtkCompressedSurfaceReader, vtkCompressedSurfaceWriter
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkChartsCore import vtkAxis, vtkChart, vtkChartXY
from vtkmodules.vtkCommonCore import vtkFloatArray
from vtkmodules.vtkCommonDataModel import vtkTable
from vtkmodules.vtkRenderingContext2D import vtkContextActor
from vtkmodules.vtkRenderingCore import vtkRenderer
import vtkmodules.vtkRenderingContextOpenGL2  # noqa: F401, registers what draws charts

from pictures import HANDLE_COLORS, INK, new_window, photograph, resized

ALPHA = 0.15


class Measure:
    """The errors of other places of a surface's points."""

    def __init__(self, surface):
        self.points = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
        self.corners = vtk_to_numpy(
            surface.GetPolys().GetConnectivityArray()).reshape(-1, 3).astype(int)
        # Edges with two triangles are there once in each direction, those with one as well.
        ends = numpy.vstack([self.corners[:, pair] for pair in ([0, 1], [1, 2], [2, 0])])
        self.edges = numpy.unique(numpy.vstack([ends, ends[:, ::-1]]), axis=0)

    def crosses(self, points):
        a, b, c = (points[self.corners[:, i]] for i in range(3))
        return numpy.cross(b - a, c - a)

    def laplacians(self, points):
        """v_i - sum_j v_j / l_ij / sum_j 1 / l_ij"""
        start, end = self.edges.T
        weights = 1 / numpy.linalg.norm(points[end] - points[start], axis=1).clip(1e-12)
        sums = numpy.array([numpy.bincount(start, weights * column[end], len(points))
                            for column in points.T]).T
        return points - sums / numpy.bincount(start, weights, len(points))[:, None]

    def normals(self, points):
        """In degrees."""
        before, after = self.crosses(self.points), self.crosses(points)
        angles = numpy.arctan2(numpy.linalg.norm(numpy.cross(before, after), axis=1),
                               (before * after).sum(axis=1))
        areas = numpy.linalg.norm(before, axis=1)
        return numpy.degrees(numpy.sqrt((areas * angles ** 2).sum() / areas.sum()))

    def visual(self, points):
        moved = numpy.linalg.norm(points - self.points, axis=1)
        rough = numpy.linalg.norm(self.laplacians(points) - self.laplacians(self.points), axis=1)
        diagonal = numpy.linalg.norm(self.points.max(axis=0) - self.points.min(axis=0))
        return numpy.sqrt(((ALPHA * moved + (1 - ALPHA) * rough) ** 2).mean()) / diagonal

    def sample(self, size, points):
        return 8 * size / len(self.points), self.normals(points), self.visual(points)


def compressed(surface, measure, folder, anchors):
    """Rows of bits per point, angle and visual error, from 3 to 9 bits."""
    path = os.path.join(folder, "surface.csf")
    for bits in range(3, 10):
        writer = vtkCompressedSurfaceWriter()
        writer.SetInputData(surface)
        writer.SetFileName(path)
        writer.SetBits(bits)
        writer.SetNumberOfAnchors(anchors)
        writer.WritePointArraysOff()
        writer.Write()
        reader = vtkCompressedSurfaceReader()
        reader.SetFileName(path)
        reader.Update()
        points = vtk_to_numpy(reader.GetOutput().GetPoints().GetData()).astype(float)
        writer.KeepPointOrderOff()
        writer.Write()
        yield measure.sample(writer.GetFileSize(), points)


def write_obj(path, measure, with_numbers):
    """Draco's program drops everything but texture coordinates: two of them number a point."""
    with open(path, "w") as file:
        for x, y, z in measure.points:
            file.write(f"v {x:.9g} {y:.9g} {z:.9g}\n")
        for v in range(len(measure.points) if with_numbers else 0):
            file.write(f"vt {v // 1000} {v % 1000}\n")
        for row in measure.corners + 1:
            file.write("f " + " ".join(f"{v}/{v}" if with_numbers else f"{v}" for v in row) + "\n")


def read_obj(path, count):
    lines = [line.split() for line in open(path)]
    places = numpy.array([line[1:4] for line in lines if line[:1] == ["v"]], dtype=float)
    numbers = numpy.array([line[1:3] for line in lines if line[:1] == ["vt"]], dtype=float)
    corners = numpy.array([corner.split("/")[:2] for line in lines if line[:1] == ["f"]
                           for corner in line[1:]], dtype=int) - 1
    points = numpy.full((count, 3), numpy.nan)
    which = numpy.rint(numbers[corners[:, 1]]).astype(int)
    points[1000 * which[:, 0] + which[:, 1]] = places[corners[:, 0]]
    if numpy.isnan(points).any():
        raise RuntimeError("Draco lost points")
    return points


def draco(measure, folder):
    """Rows like those of compressed(), from 7 to 13 bits; the smallest of four speeds."""
    plain, numbered, coded, decoded = (
        os.path.join(folder, name) for name in ("plain.obj", "numbered.obj", "a.drc", "a.obj"))
    write_obj(plain, measure, False)
    write_obj(numbered, measure, True)

    def encode(source, bits, level):
        subprocess.run(["draco_encoder", "-i", source, "-o", coded, "-qp", str(bits), "-qt", "0",
                        "-cl", str(level)], check=True, stdout=subprocess.DEVNULL)
        return os.path.getsize(coded)

    for bits in range(7, 14):
        size = min(encode(plain, bits, level) for level in (7, 8, 9, 10))
        encode(numbered, bits, 10)
        subprocess.run(["draco_decoder", "-i", coded, "-o", decoded], check=True,
                       stdout=subprocess.DEVNULL)
        yield measure.sample(size, read_obj(decoded, len(measure.points)))


def column(name, values):
    array = vtkFloatArray()
    array.SetName(name)
    for value in values:
        array.InsertNextValue(value)
    return array


def chart(title, unit, curves, which, size):
    """Error number `which` of all curves over bits per point, by its logarithm."""
    drawn = vtkChartXY()
    drawn.SetTitle(title)
    drawn.GetTitleProperties().SetFontSize(44)
    drawn.GetTitleProperties().SetBold(True)
    drawn.SetShowLegend(True)
    drawn.GetLegend().SetLabelSize(40)
    for place, name in ((vtkAxis.BOTTOM, "bits per point"), (vtkAxis.LEFT, unit)):
        axis = drawn.GetAxis(place)
        axis.SetTitle(name)
        for look in (axis.GetTitleProperties(), axis.GetLabelProperties()):
            look.SetFontSize(38)
            look.SetColor(INK)
    drawn.GetAxis(vtkAxis.LEFT).LogScaleOn()
    for color, (name, rows) in zip(HANDLE_COLORS, curves):
        table = vtkTable()
        table.AddColumn(column("bits", [row[0] for row in rows]))
        table.AddColumn(column(name, [row[which] for row in rows]))
        line = drawn.AddPlot(vtkChart.LINE)
        line.SetInputData(table, 0, 1)
        line.SetColorF(*color)
        line.SetWidth(5)
        line.SetMarkerStyle(4)
        line.SetMarkerSize(16)
    actor = vtkContextActor()
    actor.GetScene().AddItem(drawn)
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(actor)
    actor.GetScene().SetRenderer(renderer)
    window = new_window(size)
    window.AddRenderer(renderer)
    window.Render()
    return resized(photograph(window), size)


def rate_charts(name, surface, size):
    """The pictures of two charts; prints what they show."""
    measure = Measure(surface)
    with tempfile.TemporaryDirectory() as folder:
        curves = [(f"compressed surface, {anchors} anchors",
                   list(compressed(surface, measure, folder, anchors))) for anchors in (20, 100)]
        curves.append(("Draco", list(draco(measure, folder))))
    for title, rows in curves:
        for bits, angle, visual in rows:
            print(f"{name}, {title}: {bits:.1f} bits per point, {angle:.2f} degrees, {visual:.2g}")
    return [chart(f"{name}: normals", "degrees", curves, 1, size),
            chart(f"{name}: visual error", "parts of the diagonal", curves, 2, size)]
