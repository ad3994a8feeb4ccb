# SPDX-License-Identifier: BSD-3-Clause
"""One sensible use of every filter on any surface of triangles, for what is asked of all:
results on real surfaces, time without a report, bounds of properties.

    for task in every_filter.TASKS:
        filter = every_filter.make(task, surface)

`surface` is a vtkPolyData. A deformation holds one end of the longest axis and turns the
other by 40 degrees; morphs, measures, examples and what is carried along take a copy that is
bent by 40 degrees; spectrum, least-squares mesh and quantization take 20 modes or anchors, or
as many as a small surface has; a merge sews two copies together where the triangles of one
point are missing.
"""
import math
import os
import tempfile

import numpy
import vtkcartan
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkBox, vtkCellArray, vtkPolyData
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm


def is_filter(name):
    """Whether the module has such a class that objects can be made of."""
    kind = getattr(vtkcartan, name)
    if not (isinstance(kind, type) and issubclass(kind, vtkAlgorithm)):
        return False
    try:
        kind()
        return True
    except (TypeError, NotImplementedError):
        return False


FILTERS = [name for name in sorted(dir(vtkcartan)) if is_filter(name)]
DEFORMATIONS = [name[3:] for name in FILTERS if name.endswith("Deformation")]
MORPHS = ("DiscreteForms", "Isometric", "DeformationGradient", "PyramidCoordinates", "Linear")
TASKS = (DEFORMATIONS + ["CurvatureError", "VolumeChange", "DiscreteForms", "FrameReconstruction"]
         + ["SurfaceMorph " + name for name in MORPHS]
         + ["DifferentialCoordinates", "DifferentialReconstruction", "LaplacianSpectrum",
            "LeastSquaresMesh", "HighPassQuantization", "SpectralWatermark", "MarkHandle",
            "LandmarkHandles", "CarryAlong", "CoatingTransfer", "MeshMerge", "BoundaryLoops",
            "PrepareSurface", "RestoreSurface", "CompressedSurfaceReader"])

# Those whose output has other points than the surface.
OTHER_POINTS = ("MeshMerge", "BoundaryLoops", "PrepareSurface", "CompressedSurfaceReader")


def positions(surface):
    return vtk_to_numpy(surface.GetPoints().GetData()).astype(float)


def moved(surface, points):
    """A copy of the surface with these points."""
    copy = vtkPolyData()
    copy.ShallowCopy(surface)
    vtk_points = vtkPoints()
    vtk_points.SetData(numpy_to_vtk(numpy.ascontiguousarray(points), deep=True))
    copy.SetPoints(vtk_points)
    return copy


def axis_of(surface):
    """The longest axis of the bounding box of what cells use, with its two ends."""
    bounds = [0.0] * 6
    surface.GetCellsBounds(bounds)
    axis = max(range(3), key=lambda i: bounds[2 * i + 1] - bounds[2 * i])
    return axis, bounds[2 * axis], bounds[2 * axis + 1]


def bent(surface, angle):
    """A copy, bent by an angle in degrees over the length of its longest axis."""
    axis, low, high = axis_of(surface)
    points = positions(surface)
    turn = math.radians(angle) / max(high - low, 1e-300)
    along, up = points[:, axis] - low, points[:, (axis + 1) % 3]
    radius = 1.0 / turn
    result = points.copy()
    result[:, axis] = low + (radius - up) * numpy.sin(along * turn)
    result[:, (axis + 1) % 3] = radius - (radius - up) * numpy.cos(along * turn)
    return moved(surface, result)


def marked(surface, handles):
    """The surface with an array Handle."""
    array = numpy_to_vtk(handles, deep=True)
    array.SetName("Handle")
    copy = vtkPolyData()
    copy.ShallowCopy(surface)
    copy.GetPointData().AddArray(array)
    return copy


def with_handles(surface):
    """The surface with its two ends marked: 1 and 2."""
    axis, low, high = axis_of(surface)
    along = positions(surface)[:, axis]
    handles = numpy.zeros(len(along), dtype=numpy.int32)
    handles[along <= low + 0.15 * (high - low)] = 1
    handles[along >= high - 0.15 * (high - low)] = 2
    return marked(surface, handles)


def cells_of(surface):
    """The point ids of each cell."""
    offsets = vtk_to_numpy(surface.GetPolys().GetOffsetsArray())
    ids = vtk_to_numpy(surface.GetPolys().GetConnectivityArray())
    return [ids[begin:end].tolist() for begin, end in zip(offsets[:-1], offsets[1:])]


def used_points(surface):
    """Those of cells, each with the first point of its component."""
    parent = list(range(surface.GetNumberOfPoints()))

    def root(i):
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i
    used = set()
    for ids in cells_of(surface):
        used.update(ids)
        for i in ids[1:]:
            low, high = sorted((root(ids[0]), root(i)))
            parent[high] = low
    return {i: root(i) for i in used}


def with_anchors(surface):
    """The surface with the first point of each component and every hundredth marked."""
    handles = numpy.zeros(surface.GetNumberOfPoints(), dtype=numpy.int32)
    handles[::100] = 1
    handles[list(used_points(surface).values())] = 1
    return marked(surface, handles)


def end_motion(surface):
    """A turn of the far end by 40 degrees about the middle of the surface."""
    axis, _, _ = axis_of(surface)
    motion = vtkcartan.vtkHandleMotion()
    motion.SetAxis(*[1.0 if i == (axis + 1) % 3 else 0.0 for i in range(3)])
    motion.SetAngle(40.0)
    motion.SetCenter(*surface.GetCenter())
    return motion


def with_keys(surface):
    """The surface with a point of each boundary loop numbered."""
    loops = silent("BoundaryLoops", surface).GetOutput()
    keys = numpy.zeros(surface.GetNumberOfPoints(), dtype=numpy.int32)
    ids = loops.GetPointData().GetArray("OriginalPointIds")
    for cell in range(loops.GetNumberOfCells()):
        keys[ids.GetValue(loops.GetCell(cell).GetPointId(0))] = cell + 1
    array = numpy_to_vtk(keys, deep=True)
    array.SetName("BoundaryKey")
    surface.GetPointData().AddArray(array)
    return surface


def opened(surface):
    """The surface without the triangles of the point that most others use, with boundary keys."""
    cells = cells_of(surface)
    count = numpy.bincount(numpy.concatenate(cells), minlength=surface.GetNumberOfPoints())
    left = [ids for ids in cells if int(count.argmax()) not in ids]
    polys = vtkCellArray()
    polys.SetData(numpy_to_vtkIdTypeArray(
        numpy.cumsum([0] + [len(ids) for ids in left]), deep=True), numpy_to_vtkIdTypeArray(
            numpy.concatenate(left or [[]]).astype(numpy.int64), deep=True))
    result = vtkPolyData()
    result.SetPoints(surface.GetPoints())
    result.SetPolys(polys)
    return with_keys(result)


def silent(kind, surface):
    """An updated filter whose own complaints are not the matter."""
    filter = getattr(vtkcartan, "vtk" + kind)()
    filter.SetInputData(0, surface)
    filter.AddObserver("ErrorEvent", lambda *_: None)
    filter.AddObserver("WarningEvent", lambda *_: None)
    filter.Update()
    return filter


def point_set(points):
    result = vtkPolyData()
    vtk_points = vtkPoints()
    vtk_points.SetData(numpy_to_vtk(numpy.ascontiguousarray(points), deep=True))
    result.SetPoints(vtk_points)
    return result


def number_for(surface):
    """20 modes or anchors, as many as a small surface has, or as many as parts need."""
    used = used_points(surface)
    return max(min(20, len(used)), len(set(used.values())))


def set_number(filter, name, surface):
    if name == "LaplacianSpectrum":
        filter.SetNumberOfModes(min(20, len(used_points(surface))))
    else:
        filter.SetNumberOfAnchors(number_for(surface))


def set_deformation(filter, surface):
    filter.SetInputData(with_handles(surface))
    filter.SetHandleMotion(2, end_motion(surface))
    if filter.IsA("vtkExampleBasedDeformation"):
        filter.AddExampleData(bent(surface, 40.0))


def set_curve(filter, surface):
    """The shortest path between the ends of the first component, lifted in its middle."""
    axis, _, _ = axis_of(surface)
    points = positions(surface)
    used = used_points(surface)
    first = min(used.values())
    part = [i for i, root in used.items() if root == first]
    ends = [min(part, key=lambda i: points[i, axis]), max(part, key=lambda i: points[i, axis])]
    filter.SetInputData(surface)
    filter.SetSourceToShortestPath()
    filter.SetNumberOfPointIds(2)
    for index, end in enumerate(ends):
        filter.SetPointId(index, end)
    t = numpy.linspace(0.0, 1.0, 30)[:, None]
    line = (1.0 - t) * points[ends[0]] + t * points[ends[1]]
    line[:, (axis + 1) % 3] += 0.1 * surface.GetLength() * numpy.sin(math.pi * t[:, 0])
    target = point_set(line)
    lines = vtkCellArray()
    lines.SetData(30, numpy_to_vtkIdTypeArray(numpy.arange(30), deep=True))
    target.SetLines(lines)
    filter.SetTargetData(target)


def set_landmarks(filter, surface):
    used = sorted(used_points(surface))
    chosen = used[::max(1, len(used) // 12)]
    points = positions(surface)[chosen]
    filter.SetInputData(surface)
    filter.SetFromData(point_set(points))
    filter.SetToData(point_set(points + 0.01 * surface.GetLength()))


def set_region(filter, surface):
    axis, low, high = axis_of(surface)
    bounds = list(surface.GetBounds())
    bounds[2 * axis] = high - 0.15 * (high - low)
    box = vtkBox()
    box.SetBounds(bounds)
    filter.SetInputData(surface)
    filter.SetRegion(box)
    filter.SetGrowDistance(0.02 * surface.GetLength())


def reader_of(surface):
    """A reader of a file with the surface, which is deleted with the filter; the writer, which
    says why, where it refuses the surface."""
    folder = tempfile.TemporaryDirectory()
    path = os.path.join(folder.name, "surface.csf")
    writer = vtkcartan.vtkCompressedSurfaceWriter()
    writer.SetFileName(path)
    writer.SetNumberOfAnchors(number_for(surface))
    writer.SetInputData(surface)
    writer.AddObserver("ErrorEvent", lambda *_: None)
    writer.Write()
    filter = vtkcartan.vtkCompressedSurfaceReader() if os.path.exists(path) else writer
    filter.SetFileName(path)
    filter.Modified()  # the writer speaks again
    filter.folder = folder
    return filter


def set_by_name(filter, name, surface):
    """The filters that differ from each other."""
    filter.SetInputData(0, surface)
    if name == "VolumeChange":
        filter.SetInputData(1, bent(surface, 40.0))
    elif name in ("LaplacianSpectrum", "LeastSquaresMesh", "HighPassQuantization"):
        set_number(filter, name, surface)
    elif name == "SpectralWatermark":
        filter.SetMessageFormatToBits()
        filter.SetMessage("10")
    elif name == "DifferentialReconstruction":
        coordinates = silent("DifferentialCoordinates", with_anchors(surface)).GetOutput()
        if coordinates.GetNumberOfPoints() > 0:
            filter.SetInputData(coordinates)
    elif name == "FrameReconstruction":
        forms = vtkcartan.vtkDiscreteForms()
        forms.SetInputData(surface)
        filter.SetInputConnection(1, forms.GetOutputPort(1))
    elif name == "CarryAlong":
        filter.SetInputData(point_set(1.01 * positions(surface)))
        filter.SetRestData(surface)
        filter.SetDeformedData(bent(surface, 40.0))
    elif name == "CoatingTransfer":
        filter.SetSourceData(bent(surface, 40.0))
    elif name == "MeshMerge":
        filter.SetInputData(opened(surface))
        filter.SetSourceData(opened(surface))
    elif name == "RestoreSurface":
        filter.SetInputData(silent("PrepareSurface", surface).GetOutput())
        filter.SetOriginalData(surface)


def make(task, surface):
    """The filter of a task, ready for its Update()."""
    name, _, method = task.partition(" ")
    if name == "CompressedSurfaceReader":
        return reader_of(surface)
    filter = getattr(vtkcartan, "vtk" + name)()
    if name == "SurfaceMorph":
        filter.AddInputData(surface)
        filter.AddInputData(bent(surface, 40.0))
        getattr(filter, "SetMethodTo" + method)()
        filter.SetParameter(0.5)
    elif name == "CurveDeformation":
        set_curve(filter, surface)
    elif name.endswith("Deformation"):
        set_deformation(filter, surface)
    elif name == "LandmarkHandles":
        set_landmarks(filter, surface)
    elif name == "MarkHandle":
        set_region(filter, surface)
    else:
        set_by_name(filter, name, surface)
    return filter
