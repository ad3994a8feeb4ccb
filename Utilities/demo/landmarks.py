# SPDX-License-Identifier: BSD-3-Clause
"""Landmarks on a scan of 100K points: how long 3, 30 and 3000 of them take, and how far they
end from where they are to be, besides a thin-plate spline of the same landmarks. Run by
Utilities/demo.sh --landmarks in pvpython; prints a table."""
import sys
import time

import numpy
from vtkcartan import vtkAsRigidAsPossibleDeformation, vtkLandmarkHandles, vtkVolumeChange
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkCommonTransforms import vtkThinPlateSplineTransform
from vtkmodules.vtkFiltersGeneral import vtkTransformPolyDataFilter
from vtkmodules.vtkFiltersModeling import vtkLinearSubdivisionFilter

import cartan_testing

ACCURACY = 0.002  # of the size


def points_of(surface):
    return vtk_to_numpy(surface.GetPoints().GetData())


def cloud(positions):
    points = vtkPoints()
    points.SetData(numpy_to_vtk(numpy.ascontiguousarray(positions), deep=True))
    result = vtkPolyData()
    result.SetPoints(points)
    return result


def bent(points, size):
    """A smooth motion of space: a bend, and a swelling."""
    x, y, z = ((points - points.mean(axis=0)) / size).T
    return points + size * numpy.stack(
        [0.15 * y * y, 0.1 * numpy.sin(3.0 * x), 0.2 * z * y], axis=1)


def deformed(surface, start, goal, accuracy):
    """The as-rigid-as-possible result, the seconds before the motion and the largest miss."""
    landmarks = vtkLandmarkHandles()
    landmarks.SetInputData(surface)
    landmarks.SetFromData(cloud(start))
    landmarks.SetToData(cloud(goal))
    landmarks.SetAccuracy(accuracy)
    begin = time.perf_counter()
    landmarks.Update()
    marking = time.perf_counter() - begin
    method = vtkAsRigidAsPossibleDeformation()
    method.SetInputConnection(landmarks.GetOutputPort())
    method.SetTargetPositionArrayName("TargetPosition")
    method.SetConstraintWeightArrayName("ConstraintWeight" if accuracy else "")
    method.Update()
    marked = landmarks.GetOutput()
    ids = vtk_to_numpy(landmarks.GetLandmarkTable().GetColumnByName("PointId"))
    targets = vtk_to_numpy(marked.GetPointData().GetArray("TargetPosition"))
    misses = numpy.linalg.norm(points_of(method.GetOutput())[ids] - targets[ids], axis=1)
    return method.GetOutput(), marking, method.GetSetupTime(), misses.max()


def spline(surface, start, goal):
    transform = vtkThinPlateSplineTransform()
    transform.SetSourceLandmarks(cloud(start).GetPoints())
    transform.SetTargetLandmarks(cloud(goal).GetPoints())
    transform.SetBasisToR()
    warp = vtkTransformPolyDataFilter()
    warp.SetInputData(surface)
    warp.SetTransform(transform)
    begin = time.perf_counter()
    warp.Update()
    return warp.GetOutput(), time.perf_counter() - begin


def edge_change(surface, rest):
    change = vtkVolumeChange()
    change.ComputeLocalVolumeOff()
    change.SetInputData(surface)
    change.SetReferenceData(rest)
    change.Update()
    return change.GetEdgeLengthRMS()


def main():
    fine = vtkLinearSubdivisionFilter()  # 26K points become 104K
    fine.SetInputData(cartan_testing.read_off("armadillo"))
    fine.Update()
    surface = fine.GetOutput()
    points = points_of(surface).astype(float)
    size = numpy.linalg.norm(points.max(axis=0) - points.min(axis=0))
    print(f"{len(points)} points; lengths in parts of the diagonal")
    print("landmarks  accuracy  marking s  set-up s  largest miss  edge RMS  spline s  edge RMS")
    random = numpy.random.default_rng(1)
    chosen = random.permutation(len(points))
    for accuracy in (0.0, ACCURACY):
        for count in (3, 30, 3000):
            start = points[chosen[:count]]
            noise = random.uniform(-0.5, 0.5, start.shape) * accuracy * size
            goal = bent(points, size)[chosen[:count]] + noise
            result, marking, setup, miss = deformed(surface, start, goal, accuracy * size)
            line = (f"{count:9d}  {accuracy:8g}  {marking:9.2f}  {setup:8.2f}  {miss / size:12.2e}"
                    f"  {edge_change(result, surface):8.4f}")
            # A spline of space needs four landmarks, and takes minutes with thousands.
            if count == 30 and not accuracy:
                warped, seconds = spline(surface, start, goal)
                line += f"  {seconds:8.2f}  {edge_change(warped, surface):8.4f}"
            print(line)
            sys.stdout.flush()


main()
