# SPDX-License-Identifier: BSD-3-Clause
"""The filters for arrays of numpy: deform(), morph() and measure()."""
from typing import NamedTuple

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonMath import vtkMatrix4x4

from . import filters
from .vtkCartan import vtkCurvatureError, vtkHandleMotion, vtkSurfaceMorph, vtkVolumeChange

TARGETS = "CartanTarget"


def _handle_array(handles, number_of_points):
    """The handle of each point, and the points of each handle in the caller's order."""
    if not hasattr(handles, "items"):
        array = numpy.asarray(handles)
        if array.shape != (number_of_points,):
            raise ValueError(f"handles has the shape {array.shape}; give a dictionary of point ids "
                             f"by handle id, or the handle of each of {number_of_points} points.")
        return array, {int(i): numpy.flatnonzero(array == i) for i in numpy.unique(array) if i > 0}
    array = numpy.zeros(number_of_points, numpy.int32)
    points = {}
    for handle, ids in handles.items():
        ids = numpy.atleast_1d(ids)
        if ids.dtype == bool:
            ids = numpy.flatnonzero(ids)
        if handle < 1:
            raise ValueError(f"Handle ids are >= 1; got {handle}.")
        if len(ids) and not numpy.issubdtype(ids.dtype, numpy.integer):
            raise ValueError(f"Handle {handle} is made of values of the type {ids.dtype}; give "
                             "point ids, or one boolean per point.")
        wrong = ids[(ids < 0) | (ids >= number_of_points)]
        if len(wrong):
            raise ValueError(f"{len(wrong)} points of handle {handle} (first: {wrong[0]}) do not "
                             f"exist: ids are 0 to {number_of_points - 1}.")
        shared = numpy.count_nonzero(array[ids])
        if shared:
            raise ValueError(f"{shared} points of handle {handle} belong to another handle too.")
        array[ids] = handle
        points[handle] = ids
    return array, points


def _motion(motion):
    """A vtkHandleMotion, from one or from a 4 x 4 matrix."""
    if isinstance(motion, vtkHandleMotion):
        return motion
    elements = numpy.asarray(motion, dtype=float)
    if elements.shape != (4, 4):
        raise ValueError(f"A motion is a vtkHandleMotion or a 4 x 4 matrix; got the shape "
                         f"{elements.shape}.")
    matrix = vtkMatrix4x4()
    matrix.DeepCopy(elements.ravel())
    result = vtkHandleMotion()
    result.SetMatrix(matrix)
    return result


class Deformer:
    """A surface with handles, to be deformed many times.

    What does not depend on the motions is computed once, and kept.

    points: n x 3. triangles: m x 3 point ids. handles: the point ids of each handle, by the id
    of the handle, 1 or more; or the handle of each point, 0 where it is free. method: the name
    of a filter without vtk and Deformation. properties: those of the filter, such as
    LaplacianWeights="Uniform".
    """

    def __init__(self, points, triangles, handles, method="ShapePreserving", **properties):
        self._surface = filters.as_surface(points, triangles)
        self._rest = filters.points_of(self._surface)
        array, self._points = _handle_array(handles, len(self._rest))
        filters.add_point_array(self._surface, "Handle", array)
        self.filter = filters.deformation_class(method)()
        filters.set_properties(self.filter, properties)
        self._listener = filters.Listener(self.filter)
        self.filter.SetInputData(self._surface)

    def __call__(self, motions=None, targets=None):
        """The points, n x 3, after handles have moved.

        motions: by handle id, a vtkHandleMotion or a 4 x 4 matrix. targets: by handle id, where
        its points go, in the order in which they were given. Handles in neither are pinned.
        """
        motions, targets = dict(motions or {}), dict(targets or {})
        both = sorted(set(motions) & set(targets))
        if both:
            raise ValueError(f"Handle {both[0]} has a motion and targets: give one of them.")
        self.filter.RemoveAllHandleMotions()
        for handle, motion in motions.items():
            self.filter.SetHandleMotion(handle, _motion(motion))
        self._set_targets(targets)
        self._listener.update()
        return filters.points_of(self.filter.GetOutput())

    def _set_targets(self, targets):
        self.filter.SetTargetPositionArrayName(TARGETS if targets else "")
        if not targets:
            return
        positions = self._rest.copy()
        for handle, values in targets.items():
            if handle not in self._points:
                raise ValueError(f"Handle {handle} has targets, but no points; handles are "
                                 f"{', '.join(map(str, sorted(self._points)))}.")
            values = filters.as_points(values, f"targets[{handle}]")
            if len(values) != len(self._points[handle]):
                raise ValueError(f"Handle {handle} has {len(self._points[handle])} points, but "
                                 f"{len(values)} targets.")
            positions[self._points[handle]] = values
        filters.add_point_array(self._surface, TARGETS, positions)


def deform(points, triangles, handles, motions=None, targets=None, method="ShapePreserving",
           **properties):
    """The points of a surface, n x 3, after its handles have moved: see Deformer.

    Raises ValueError with the text of the filter for input that it refuses.
    """
    return Deformer(points, triangles, handles, method, **properties)(motions, targets)


def morph(key_frames, triangles, parameter, method="DiscreteForms", **properties):
    """The surface between key frames, from 0, the first, to 1, the last.

    key_frames: two or more arrays of n x 3 points. parameter: a number gives n x 3 points, k
    numbers give k x n x 3. method and properties: those of vtkSurfaceMorph.
    """
    algorithm = vtkSurfaceMorph()
    filters.set_properties(algorithm, {"Method": method, **properties})
    for points in key_frames:
        algorithm.AddInputData(filters.as_surface(points, triangles))
    listener = filters.Listener(algorithm)

    def at(t):
        algorithm.SetParameter(t)
        listener.update()
        return filters.points_of(algorithm.GetOutput())

    return at(float(parameter)) if numpy.ndim(parameter) == 0 else numpy.array(
        [at(float(t)) for t in parameter])


class Measures(NamedTuple):
    """What measure() finds: numbers of the whole surface, and arrays with a value per point."""

    totals: dict
    point_data: dict


def measure(points, triangles, reference):
    """What has changed from a reference with the same triangles, n x 3 points too.

    The totals and arrays are those of vtkVolumeChange and vtkCurvatureError. A total is NaN
    where it has no meaning, such as the volume of an open surface.
    """
    surface = filters.as_surface(points, triangles)
    before = filters.as_surface(reference, triangles)
    totals, arrays = {}, {}
    for kind, names in (
            (vtkVolumeChange, ("RelativeVolumeChange", "RelativeAreaChange", "EdgeLengthRMS",
                               "EdgeLengthMax", "ShapeDistance")),
            (vtkCurvatureError, ("MeanCurvatureErrorRMS", "MeanCurvatureErrorMax",
                                 "GaussianCurvatureErrorRMS", "GaussianCurvatureErrorMax"))):
        algorithm = kind()
        listener = filters.Listener(algorithm)
        algorithm.SetInputData(surface)
        algorithm.SetInputDataObject(1, before)
        listener.update()
        totals.update((name, getattr(algorithm, "Get" + name)()) for name in names)
        data = algorithm.GetOutput().GetPointData()
        arrays.update((data.GetArrayName(i), vtk_to_numpy(data.GetArray(i)).copy())
                      for i in range(data.GetNumberOfArrays()))
    return Measures(totals, arrays)

