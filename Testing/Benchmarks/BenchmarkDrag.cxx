// SPDX-License-Identifier: BSD-3-Clause
//
// Dragging large surfaces: whole updates of the filters for raw, tabulated and solved
// motions, the set-up and the table, beside the time in which the machine copies the same bytes
// and an iteration of CGAL's as-rigid-as-possible deformation on the same surface with the same
// handles in the same run. Ends with a table of what was asked and what was measured.
// Arguments: how often the armadillo is subdivided, by default 1 and 2; 3 has 1.66 million
// points. CGAL takes part up to 2.
#include "BenchmarkTools.h"
#include "PeerDeformation.h"

#include "vtkCurvatureError.h"
#include "vtkHandleMotion.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkShapePreservingDeformation.h"
#include "vtkVolumeChange.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string>
#include <utility>
#include <vector>

using namespace benchmarks;

namespace
{
constexpr double Low = 0.05;
constexpr double High = 0.95;
constexpr int Motions = 15;

vtkSmartPointer<vtkPolyData> MarkedSurface(const Mesh& mesh)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(VTK_FLOAT);
  points->SetNumberOfPoints(mesh.Points.rows());
  vtkNew<vtkIntArray> handle;
  handle->SetName("Handle");
  handle->SetNumberOfValues(mesh.Points.rows());
  const std::vector<int> handles = MarkEnds(mesh, Low, High);
  for (Eigen::Index v = 0; v < mesh.Points.rows(); ++v)
  {
    points->SetPoint(v, mesh.Points(v, 0), mesh.Points(v, 1), mesh.Points(v, 2));
    handle->SetValue(v, handles[static_cast<std::size_t>(v)]);
  }
  vtkNew<vtkCellArray> cells;
  cells->AllocateExact(mesh.Triangles.rows(), mesh.Triangles.size());
  for (Eigen::Index t = 0; t < mesh.Triangles.rows(); ++t)
  {
    const vtkIdType ids[3] = { mesh.Triangles(t, 0), mesh.Triangles(t, 1), mesh.Triangles(t, 2) };
    cells->InsertNextCell(3, ids);
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(points);
  surface->SetPolys(cells);
  surface->GetPointData()->AddArray(handle);
  return surface;
}

/// Seconds of the first update, and the least of those after it.
struct Times
{
  double First = 0.0;
  double Motion = 1e300;
};

Times Drag(vtkSurfaceDeformation* filter, vtkHandleMotion* motion)
{
  Times times;
  for (int i = 0; i <= Motions; ++i)
  {
    motion->SetAngle(15.0 + 4.0 * i);
    motion->SetTranslation(0.0, 0.01 * i, 0.0);
    const double start = WallTime();
    filter->Update();
    const double seconds = WallTime() - start;
    (i == 0 ? times.First : times.Motion) = i == 0 ? seconds : std::min(times.Motion, seconds);
  }
  return times;
}

/// Seconds of an update of `measure` alone, whose input a drag has moved: the least.
double MeasureBehind(
  vtkSurfaceComparison* measure, vtkSurfaceDeformation* filter, vtkHandleMotion* motion)
{
  measure->SetInputConnection(filter->GetOutputPort());
  measure->SetReferenceConnection(filter->GetInputConnection(0, 0));
  double least = 1e300;
  for (int i = 0; i <= Motions; ++i)
  {
    motion->SetAngle(15.0 + 4.0 * i);
    filter->Update();
    const double start = WallTime();
    measure->Update();
    // The first update measures the reference, too.
    least = i == 0 ? least : std::min(least, WallTime() - start);
  }
  return least;
}

/// Of `bytes`, in seconds: read and written once, by one thread.
double CopyTime(double bytes)
{
  const std::vector<char> from(static_cast<std::size_t>(bytes), 1);
  std::vector<char> to(from.size());
  double least = 1e300;
  for (int i = 0; i < 7; ++i)
  {
    const double start = WallTime();
    std::memcpy(to.data(), from.data(), from.size());
    least = std::min(least, WallTime() - start);
  }
  return least;
}

double PeerIteration(const Mesh& mesh)
{
  PeerDeformation peer(mesh.Points, mesh.Triangles, MarkEnds(mesh, Low, High));
  double least = 1e300;
  for (int i = 0; i < 3; ++i)
  {
    const cartan::HandleMotion motion = Turn(20.0 + 10.0 * i).Motions[0];
    peer.MoveHandle(motion.Linear, motion.Translation);
    const double start = WallTime();
    peer.Iterate();
    least = std::min(least, WallTime() - start);
  }
  return least;
}

void Measure(int subdivisions)
{
  Mesh mesh = ReadMesh("armadillo");
  for (int i = 0; i < subdivisions; ++i)
  {
    mesh = Subdivide(mesh);
  }
  const double peer = subdivisions <= 2 ? PeerIteration(mesh) : 0.0;
  const auto points = static_cast<double>(mesh.Points.rows());
  const vtkSmartPointer<vtkPolyData> surface = MarkedSurface(mesh);
  mesh = {};
  vtkNew<vtkHandleMotion> motion;
  motion->SetAxis(1.0, 0.0, 0.0);

  vtkNew<vtkRotationInvariantDeformation> raw;
  raw->SetInputData(surface);
  raw->SetHandleMotion(2, motion);
  raw->SetFrameProjection(vtkRotationInvariantDeformation::NONE);
  const Times ofRaw = Drag(raw, motion);
  raw->SetFrameProjection(vtkRotationInvariantDeformation::ROTATION);
  const Times ofSolve = Drag(raw, motion);
  vtkNew<vtkCurvatureError> curvature;
  const double ofCurvature = MeasureBehind(curvature, raw, motion);
  vtkNew<vtkVolumeChange> volume;
  const double ofVolume = MeasureBehind(volume, raw, motion);
  raw->TabulateTurnsOn();
  const Times ofInvariant = Drag(raw, motion);
  const double invariantRange = raw->GetTabulatedRange();
  raw->ReleaseKeptMemory();

  vtkNew<vtkShapePreservingDeformation> shape;
  shape->SetInputData(surface);
  shape->SetHandleMotion(2, motion);
  shape->SetVolumeCorrection(vtkFrameDeformation::NO_CORRECTION);
  shape->TabulateTurnsOn();
  const Times ofTable = Drag(shape, motion);

  std::printf("Armadillo, %.0f points, %d free\n", points, shape->GetNumberOfFreePoints());
  // What a raw motion must at least read and write of a point: phi_0, phi_1 and h_1, the rest
  // position, and its place in single precision.
  constexpr double leastBytes = 7 * 8 + 3 * 8 + 3 * 4;
  const double copy = CopyTime(0.5 * leastBytes * points);
  PrintRow("set-up and first motion", "", ofRaw.First, "s");
  PrintRow("raw motion", "", 1e3 * ofRaw.Motion, "ms");
  PrintRow("  bytes of it over the speed of a copy, the roofline", "", 1e3 * copy, "ms");
  PrintRow("  ratio to that copy of the same bytes", "<= 2", ofRaw.Motion / copy, "",
    ofRaw.Motion <= 2.0 * copy);
  PrintRow("projected motion, solved for", "", 1e3 * ofSolve.Motion, "ms");
  for (const auto& [what, seconds] :
    { std::pair<const char*, double>{ "Curvature Error behind it", ofCurvature },
      { "Volume Change behind it", ofVolume } })
  {
    PrintRow(what, "", 1e3 * seconds, "ms");
    PrintRow("  ratio to the motion", "<= 2", seconds / ofSolve.Motion, "",
      seconds <= 2.0 * ofSolve.Motion);
  }
  PrintRow("making the table, rotation invariant", "", ofInvariant.First, "s");
  PrintRow("motion by it", "", 1e3 * ofInvariant.Motion, "ms");
  PrintRow("  its range, in degrees", "", invariantRange, "");
  PrintRow("set-up and table, shape preserving", "", ofTable.First, "s");
  PrintRow("motion by it", "", 1e3 * ofTable.Motion, "ms");
  PrintRow("  its error, in millionths of the diagonal", "<= 100",
    1e6 * shape->GetTabulationError(), "", shape->GetTabulationError() <= 1e-4);
  PrintRow("  ratio to a raw motion", "<= 5", ofTable.Motion / ofRaw.Motion, "",
    ofTable.Motion <= 5.0 * ofRaw.Motion);
  if (peer > 0.0)
  {
    PrintRow("one iteration of CGAL ORIGINAL_ARAP", "", 1e3 * peer, "ms");
    PrintRow("  ratio of a raw motion to it", "<= 0.017", ofRaw.Motion / peer, "",
      ofRaw.Motion <= peer / 60.0);
    PrintRow("  ratio of a tabulated motion to it", "<= 0.04", ofTable.Motion / peer, "",
      ofTable.Motion <= peer / 25.0);
    PrintRow("  ratio of a projected motion to it", "<= 0.2", ofSolve.Motion / peer, "",
      ofSolve.Motion <= peer / 5.0);
  }
}
}

int main(int argc, char** argv)
{
  vtkSMPTools::SetBackend("STDThread");
  std::vector<int> subdivisions;
  for (int i = 1; i < argc; ++i)
  {
    subdivisions.push_back(std::atoi(argv[i]));
  }
  try
  {
    for (const int count : subdivisions.empty() ? std::vector<int>{ 1, 2 } : subdivisions)
    {
      Measure(count);
    }
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
