# SPDX-License-Identifier: BSD-3-Clause
"""What arrays and files need of the filters: their names, properties, errors and data."""
import inspect
import warnings

import numpy
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_STRING, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

from . import vtkCartan


def deformation_class(method):
    """The class of a deformation method: ShapePreserving is vtkShapePreservingDeformation."""
    names = [name[3:-len("Deformation")] for name in dir(vtkCartan)
             if name.startswith("vtk") and name.endswith("Deformation")]
    # Without their bases, and what follows a curve instead of handles.
    methods = [name for name in names if name not in ("Surface", "Frame", "Curve")]
    if method not in methods:
        raise ValueError(f"There is no method {method!r}: choose one of {', '.join(methods)}.")
    return getattr(vtkCartan, f"vtk{method}Deformation")


def settable_properties(algorithm):
    """The names of the properties of a filter that take one value."""
    names = dir(algorithm)
    setters = {name[3:] for name in names if name.startswith("Set")}
    own = {name for cls in type(algorithm).__mro__ if cls.__module__.endswith("vtkCartan")
           for name in vars(cls)}
    return sorted(name for name in setters if "Get" + name in own and "Set" + name in own)


def set_properties(algorithm, properties):
    """Sets properties by their names; enumerations take the names of their values too."""
    for name, value in properties.items():
        setter = getattr(algorithm, "Set" + name, None)
        if isinstance(value, str):
            entry = getattr(algorithm, f"Set{name}To{value}", None)
            entries = [other.split("To", 1)[1] for other in dir(algorithm)
                       if other.startswith(f"Set{name}To")]
            if entry is not None:
                entry()
                continue
            if entries:
                raise ValueError(f"{name} is one of {', '.join(entries)}, not {value!r}.")
        if setter is None:
            raise ValueError(f"{algorithm.GetClassName()} has no property {name!r}; it has "
                             f"{', '.join(settable_properties(algorithm))}.")
        # VTK would take any text as true.
        if isinstance(value, str) and not isinstance(getattr(algorithm, "Get" + name)(), str):
            raise ValueError(f"{name} cannot be {value!r}: it is a number.")
        try:
            setter(value)
        except TypeError as error:
            raise ValueError(f"{name} cannot be {value!r}: {error}") from None


class Listener:
    """Turns the errors of a filter into ValueError, and its warnings into Python's."""

    def __init__(self, algorithm):
        self.algorithm = algorithm
        self.errors = []
        self.warnings = []
        for event, texts in (("ErrorEvent", self.errors), ("WarningEvent", self.warnings)):
            algorithm.AddObserver(event, self._collector(texts))

    @staticmethod
    def _collector(texts):
        @calldata_type(VTK_STRING)
        def collect(_caller, _event, text):
            # "ERROR: In file, line\nvtkClass (0x...): what the filter says\n\n"
            texts.append(text.split("): ", 1)[-1].strip())
        return collect

    def update(self):
        """Updates the filter; raises what it refuses."""
        self.errors.clear()
        self.warnings.clear()
        self.algorithm.Update()
        if self.errors:
            raise ValueError("\n".join(self.errors))
        for text in self.warnings:
            warnings.warn(text, stacklevel=_levels_to_the_caller())


def _levels_to_the_caller():
    """How far up the first frame outside of this package is, for warnings.warn()."""
    package = __name__.rpartition(".")[0]
    frame, level = inspect.currentframe().f_back, 1
    while frame and frame.f_globals.get("__name__", "").startswith(package):
        frame, level = frame.f_back, level + 1
    return level


def as_points(values, what="points"):
    """An n x 3 array of coordinates, float32 or float64."""
    values = numpy.asarray(values)
    if values.ndim != 2 or values.shape[1] != 3:
        raise ValueError(f"{what} has the shape {values.shape}; it must be n x 3.")
    return numpy.ascontiguousarray(values, values.dtype if values.dtype == numpy.float32 else float)


def as_surface(points, triangles):
    """A vtkPolyData of n x 3 coordinates and m x 3 point ids."""
    points = as_points(points)
    triangles = numpy.asarray(triangles)
    if triangles.ndim != 2 or triangles.shape[1] != 3:
        raise ValueError(f"triangles has the shape {triangles.shape}; it must be m x 3.")
    if not numpy.issubdtype(triangles.dtype, numpy.integer):
        raise ValueError(f"triangles has values of the type {triangles.dtype}; they are point ids.")
    wrong = numpy.flatnonzero((triangles < 0) | (triangles >= len(points)))
    if len(wrong):
        raise ValueError(f"{len(wrong)} corners of triangles (first: {triangles.flat[wrong[0]]}) "
                         f"name no point: ids are 0 to {len(points) - 1}.")
    surface = vtkPolyData()
    vtk_points = vtkPoints()
    vtk_points.SetData(numpy_to_vtk(points, deep=True))
    cells = vtkCellArray()
    cells.SetData(3, numpy_to_vtkIdTypeArray(
        numpy.ascontiguousarray(triangles, numpy.int64).ravel(), deep=True))
    surface.SetPoints(vtk_points)
    surface.SetPolys(cells)
    return surface


def points_of(surface):
    """A copy of the coordinates of a vtkPolyData."""
    return vtk_to_numpy(surface.GetPoints().GetData()).copy()


def add_point_array(surface, name, values):
    """Adds a point array, and returns it."""
    array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=True)
    array.SetName(name)
    surface.GetPointData().AddArray(array)
    return array
