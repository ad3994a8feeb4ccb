// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/SurfacePlaces.h"

#include "Kernel/Base/Error.h"

#include "vtkCellArray.h"
#include "vtkGenericCell.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStaticCellLocator.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>

namespace cartan
{
namespace
{
/// How many places are found between two reports.
constexpr int PlacesPerReport = 4096;

vtkSmartPointer<vtkPolyData> MakeSurface(const Points& points, const Triangles& triangles)
{
  vtkNew<vtkPoints> coordinates;
  coordinates->SetDataTypeToDouble();
  for (Eigen::Index v = 0; v < points.rows(); ++v)
  {
    coordinates->InsertNextPoint(points.row(v).data());
  }
  vtkNew<vtkCellArray> cells;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    cells->InsertNextCell({ triangles(t, 0), triangles(t, 1), triangles(t, 2) });
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(coordinates);
  surface->SetPolys(cells);
  return surface;
}

/// Of a point of a triangle; (1, 0, 0) where the triangle has no area.
Eigen::Vector3d Barycentric(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
  const Eigen::Vector3d& c, const Eigen::Vector3d& point)
{
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double squaredArea = normal.squaredNorm();
  if (!(squaredArea > 0.0))
  {
    return Eigen::Vector3d::UnitX();
  }
  const double second = std::max(0.0, normal.dot((point - a).cross(c - a)) / squaredArea);
  const double third = std::max(0.0, normal.dot((b - a).cross(point - a)) / squaredArea);
  const double sum = std::max(1.0, second + third);
  return { 1.0 - (second + third) / sum, second / sum, third / sum };
}
}

FoundPlaces ClosestPlaces(const TriangleMesh& mesh, const Points& points, const Points& queries,
  const ExecutionContext& context)
{
  const Triangles& triangles = mesh.GetTriangles();
  const auto surface = MakeSurface(points, triangles);
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(surface);
  locator->BuildLocator();
  FoundPlaces found;
  found.Places.resize(queries.rows());
  found.Distances.resize(queries.rows());
  vtkNew<vtkGenericCell> cell;
  for (Eigen::Index i = 0; i < queries.rows(); ++i)
  {
    if (i % PlacesPerReport == 0)
    {
      context.Report(static_cast<double>(i) / static_cast<double>(queries.rows()));
    }
    Eigen::Vector3d closest;
    vtkIdType triangle = -1;
    int part = 0;
    double squaredDistance = 0.0;
    locator->FindClosestPoint(
      queries.row(i).data(), closest.data(), cell, triangle, part, squaredDistance);
    if (triangle < 0 || !std::isfinite(squaredDistance))
    {
      throw Error(ErrorCode::BadInput,
        "No place on the source is closest to point " + std::to_string(i) + " of the target: " +
          "none of the source's " + std::to_string(triangles.rows()) + " triangles has an area.");
    }
    SurfacePlace& place = found.Places[i];
    const Eigen::RowVector3i corners = triangles.row(triangle);
    place.Corners = { corners[0], corners[1], corners[2] };
    place.Weights = Barycentric(points.row(corners[0]).transpose(),
      points.row(corners[1]).transpose(), points.row(corners[2]).transpose(), closest);
    found.Distances[i] = std::sqrt(squaredDistance);
  }
  return found;
}
}
