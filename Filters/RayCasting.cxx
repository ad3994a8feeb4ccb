// SPDX-License-Identifier: BSD-3-Clause
#include "RayCasting.h"

#include "Kernel/Geometry.h"

#include "vtkCellArray.h"
#include "vtkGenericCell.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStaticCellLocator.h"

namespace cartan
{
RayCaster MakeRayCaster(const TriangleMesh& mesh, const Points& points)
{
  vtkNew<vtkPoints> vertices;
  vertices->SetDataTypeToDouble();
  vertices->SetNumberOfPoints(points.rows());
  for (Eigen::Index v = 0; v < points.rows(); ++v)
  {
    vertices->SetPoint(v, points.row(v).data());
  }
  vtkNew<vtkCellArray> triangles;
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const vtkIdType corners[3] = { mesh.GetTriangles()(t, 0), mesh.GetTriangles()(t, 1),
      mesh.GetTriangles()(t, 2) };
    triangles->InsertNextCell(3, corners);
  }
  vtkNew<vtkPolyData> surface;
  surface->SetPoints(vertices);
  surface->SetPolys(triangles);
  // Now, because the first look at a cell would otherwise do it in some thread.
  surface->BuildCells();
  const auto locator = vtkSmartPointer<vtkStaticCellLocator>::New();
  locator->SetDataSet(surface);
  locator->BuildLocator();

  // Rays through an edge must not slip between its triangles.
  const double diagonal = BoundingDiagonal(points);
  const double tolerance = 1e-10 * diagonal;
  return [locator, diagonal, tolerance](
           const Eigen::Vector3d& from, const Eigen::Vector3d& direction)
  {
    thread_local vtkSmartPointer<vtkGenericCell> cell = vtkSmartPointer<vtkGenericCell>::New();
    const Eigen::Vector3d to = from + 2.0 * diagonal * direction;
    double t = 0.0;
    double point[3];
    double parametric[3];
    int subId = 0;
    vtkIdType id = -1;
    RayHit hit;
    if (locator->IntersectWithLine(
          from.data(), to.data(), tolerance, t, point, parametric, subId, id, cell))
    {
      hit.Distance = 2.0 * diagonal * t;
      hit.Triangle = static_cast<int>(id);
    }
    return hit;
  };
}
}
