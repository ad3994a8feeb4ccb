"""What the Python tests share: where things are, and surfaces to work on."""
import os

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData


def mesh_dir():
    """The folder of the scanned meshes (armadillo.off, camel.off, ...)."""
    return os.environ["CARTAN_MESH_DIR"]


def data_dir():
    """The folder of the meshes that belong to this project."""
    return os.environ["CARTAN_DATA_DIR"]


def baseline_dir():
    """The folder of the reference images."""
    return os.environ["CARTAN_BASELINE_DIR"]


def output_path(name):
    """Where a test may write a file of this name."""
    return os.path.join(os.environ["CARTAN_TEST_OUTPUT"], name)


def plugin_path():
    """The ParaView plugin of this build."""
    return os.environ["CARTAN_PLUGIN"]


def surface(points, triangles):
    """A vtkPolyData from an n x 3 array of coordinates and an m x 3 array of point ids."""
    points = numpy.ascontiguousarray(points)
    triangles = numpy.ascontiguousarray(triangles, dtype=numpy.int64)
    vtk_points = vtkPoints()
    vtk_points.SetData(numpy_to_vtk(points, deep=True))
    cells = vtkCellArray()
    cells.SetData(3, numpy_to_vtkIdTypeArray(triangles.ravel(), deep=True))
    result = vtkPolyData()
    result.SetPoints(vtk_points)
    result.SetPolys(cells)
    return result


def read_off(path):
    """The triangle mesh in an OFF file (a path, or the name of a scanned mesh).

    Also reads COFF: colors and other values after the coordinates are skipped.
    Faces with more than three corners become fans.
    """
    if not os.path.exists(path):
        path = os.path.join(mesh_dir(), path + ".off")
    with open(path, encoding="ascii") as file:
        lines = (line.split("#")[0].split() for line in file)
        records = [line for line in lines if line]
    if not records or not records[0][0].endswith("OFF"):
        raise ValueError(path + " is not an OFF file")
    # The counts may stand on the header's line.
    first = 0 if len(records[0]) > 1 else 1
    number_of_points, number_of_faces = map(int, records[first][1 - first:3 - first])
    first += 1
    points = numpy.array([r[:3] for r in records[first:first + number_of_points]], dtype=float)
    first += number_of_points
    triangles = []
    for record in records[first:first + number_of_faces]:
        corners = [int(c) for c in record[1:1 + int(record[0])]]
        triangles += [(corners[0], corners[c - 1], corners[c]) for c in range(2, len(corners))]
    return surface(points, triangles)


def bar(nx, ny, nz, lx, ly, lz):
    """The closed surface of a bar: a box of lx x ly x lz with one corner at the
    origin, its faces divided into nx, ny and nz quads along the axes, each split
    into two triangles. Points on edges are shared; the triangles are oriented
    counter-clockwise as seen from outside.
    """
    counts = (nx, ny, nz)
    lengths = (lx, ly, lz)
    ids = {}

    def point_id(grid):
        return ids.setdefault(grid, len(ids))

    triangles = []
    for axis in range(3):
        # u, v, axis form a right-handed system: (u, v) turns outward where
        # the axis ends, and inward where it starts.
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for end in (0, counts[axis]):
            for i in range(counts[u]):
                for j in range(counts[v]):
                    corners = []
                    for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        grid = [0, 0, 0]
                        grid[axis], grid[u], grid[v] = end, i + di, j + dj
                        corners.append(point_id(tuple(grid)))
                    if end == 0:
                        corners.reverse()
                    triangles.append((corners[0], corners[1], corners[2]))
                    triangles.append((corners[0], corners[2], corners[3]))
    # Python keeps the order of insertion, which is the order of the ids.
    points = numpy.array(list(ids), dtype=float) * numpy.array(lengths) / numpy.array(counts)
    return surface(points, triangles)
