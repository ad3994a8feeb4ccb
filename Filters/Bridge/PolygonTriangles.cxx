// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/PolygonTriangles.h"

#include "Kernel/Mesh/TriangleMesh.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCellData.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkTriangleFilter.h"
#include "vtkTypeInt32Array.h"
#include "vtkTypeInt64Array.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cartan
{
namespace
{
vtkIdType FirstPolygon(vtkPolyData* input)
{
  return input->GetNumberOfVerts() + input->GetNumberOfLines();
}

/// Calls visit(cell, size, ids) for each polygon and strip.
template <typename Visit>
void ForEachPolygon(vtkPolyData* input, const Visit& visit)
{
  vtkIdType cell = FirstPolygon(input);
  for (vtkCellArray* cells : { input->GetPolys(), input->GetStrips() })
  {
    auto iterator = vtk::TakeSmartPointer(cells->NewIterator());
    for (iterator->GoToFirstCell(); !iterator->IsDoneWithTraversal(); iterator->GoToNextCell())
    {
      vtkIdType size = 0;
      const vtkIdType* ids = nullptr;
      iterator->GetCurrentCell(size, ids);
      visit(cell, size, ids);
      ++cell;
    }
  }
}

void RequireNone(const IdSample& bad, const std::string& role)
{
  if (!bad.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The " + role + " has " + bad.Describe("cell", "cells") +
        " using a point that does not exist: repair the cells.");
  }
}

void AddTriangle(const int corners[3], long long cell, CellTriangles& triangles)
{
  if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
  {
    triangles.Repeated.Add(cell);
    return;
  }
  triangles.Corners.insert(triangles.Corners.end(), corners, corners + 3);
  triangles.CellIds.push_back(cell);
}

/// The only pass over the cells of a surface of triangles: checks and copies.
template <typename Array>
void CopyTriangles(vtkPolyData* input, const std::string& role, CellTriangles& triangles)
{
  const auto* ids = Array::SafeDownCast(input->GetPolys()->GetConnectivityArray())->GetPointer(0);
  const vtkIdType firstCell = FirstPolygon(input);
  const vtkIdType count = input->GetNumberOfPolys();
  const vtkIdType numberOfPoints = input->GetNumberOfPoints();
  triangles.Corners.reserve(3 * count);
  triangles.CellIds.reserve(count);
  IdSample bad;
  for (vtkIdType t = 0; t < count; ++t)
  {
    int corners[3];
    bool isValid = true;
    for (int c = 0; c < 3; ++c)
    {
      const vtkIdType id = ids[3 * t + c];
      isValid = isValid && id >= 0 && id < numberOfPoints;
      corners[c] = static_cast<int>(id);
    }
    if (isValid)
    {
      AddTriangle(corners, firstCell + t, triangles);
    }
    else
    {
      bad.Add(firstCell + t);
    }
  }
  RequireNone(bad, role);
}

/// A polygon with a point that is not finite may fall apart when it is
/// triangulated, and then nobody would miss it.
void RequireFinitePolygons(vtkPolyData* input, const std::string& role)
{
  std::vector<char> isSeen(input->GetNumberOfPoints(), 0);
  ForEachPolygon(input,
    [&isSeen](vtkIdType, vtkIdType size, const vtkIdType* ids)
    {
      for (vtkIdType i = 0; i < size; ++i)
      {
        isSeen[ids[i]] = 1;
      }
    });
  MeshReport report;
  for (std::size_t v = 0; v < isSeen.size(); ++v)
  {
    double point[3];
    input->GetPoint(static_cast<vtkIdType>(v), point);
    if (isSeen[v] && !Eigen::Map<const Eigen::Vector3d>(point).allFinite())
    {
      report.NonFinite.Add(static_cast<long long>(v));
    }
  }
  if (!report.NonFinite.IsEmpty())
  {
    throw Error(ErrorCode::BadInput, "The " + role + " has " + report.DescribeErrors());
  }
}

void RequireValidIds(vtkPolyData* input, const std::string& role)
{
  IdSample bad;
  const vtkIdType numberOfPoints = input->GetNumberOfPoints();
  ForEachPolygon(input,
    [&bad, numberOfPoints](vtkIdType cell, vtkIdType size, const vtkIdType* ids)
    {
      if (!std::all_of(ids, ids + size,
            [numberOfPoints](vtkIdType id) { return id >= 0 && id < numberOfPoints; }))
      {
        bad.Add(cell);
      }
    });
  RequireNone(bad, role);
}

/// Polygons of which vtkTriangleFilter made fewer triangles than they have: those
/// without area, in whole or in part, vanish in it, and the surface would fall
/// apart there. As fans they are degenerate triangles like any others.
std::vector<char> BrokenPolygons(
  vtkCellArray* polygons, vtkPolyData* triangulated, vtkIdTypeArray* cellIds, vtkIdType firstCell)
{
  std::vector<vtkIdType> missing(polygons->GetNumberOfCells());
  for (std::size_t polygon = 0; polygon < missing.size(); ++polygon)
  {
    missing[polygon] = polygons->GetCellSize(static_cast<vtkIdType>(polygon)) - 2;
  }
  for (vtkIdType triangle = 0; triangle < triangulated->GetNumberOfPolys(); ++triangle)
  {
    const auto polygon = static_cast<std::size_t>(cellIds->GetValue(triangle) - firstCell);
    if (polygon < missing.size())
    {
      --missing[polygon];
    }
  }
  std::vector<char> isBroken(missing.size());
  std::transform(missing.begin(), missing.end(), isBroken.begin(),
    [](vtkIdType count) -> char { return count > 0; });
  return isBroken;
}

/// vtkTriangleFilter cuts a quad along the shorter diagonal. Those of a rectangle are
/// equally long: rounding would choose, and a turned surface would have other
/// triangles. Returns which polygons are such quads, convex along the diagonal that is
/// taken for equal ones, from corner 1 to 3.
std::vector<char> EvenQuads(vtkPolyData* input)
{
  constexpr double even = 1e-6; // of squares: beyond what a file's six digits tell
  const bool isFloat = input->GetPoints()->GetDataType() == VTK_FLOAT;
  const double digits =
    isFloat ? std::numeric_limits<float>::epsilon() : std::numeric_limits<double>::epsilon();
  std::vector<char> isEven(input->GetNumberOfPolys(), 0);
  vtkNew<vtkIdList> ids;
  for (std::size_t polygon = 0; polygon < isEven.size(); ++polygon)
  {
    input->GetPolys()->GetCellAtId(static_cast<vtkIdType>(polygon), ids);
    if (ids->GetNumberOfIds() != 4)
    {
      continue;
    }
    Eigen::Vector3d x[4];
    for (int corner = 0; corner < 4; ++corner)
    {
      input->GetPoint(ids->GetId(corner), x[corner].data());
    }
    const double first = (x[2] - x[0]).squaredNorm();
    const double second = (x[3] - x[1]).squaredNorm();
    const Eigen::Vector3d normal = (x[1] - x[0]).cross(x[3] - x[0]);
    const Eigen::Vector3d other = (x[3] - x[2]).cross(x[1] - x[2]);
    // What rounding of the coordinates makes of the difference of the squares.
    double largest = 0.0;
    for (const Eigen::Vector3d& point : x)
    {
      largest = std::max(largest, point.cwiseAbs().maxCoeff());
    }
    const double rounding = 8.0 * digits * largest * std::sqrt(first + second);
    isEven[polygon] =
      std::abs(first - second) <= even * (first + second) + rounding && normal.dot(other) > 0.0;
  }
  return isEven;
}

/// The polygons and strips as vtkTriangleFilter cuts them, with their cells' ids.
vtkSmartPointer<vtkPolyData> CutPolygons(vtkPolyData* input)
{
  vtkNew<vtkPolyData> polygons;
  polygons->SetPoints(input->GetPoints());
  polygons->SetPolys(input->GetPolys());
  polygons->SetStrips(input->GetStrips());
  vtkNew<vtkIdTypeArray> cellIds;
  cellIds->SetName("CellIds");
  cellIds->SetNumberOfValues(polygons->GetNumberOfCells());
  for (vtkIdType i = 0; i < polygons->GetNumberOfCells(); ++i)
  {
    cellIds->SetValue(i, FirstPolygon(input) + i);
  }
  polygons->GetCellData()->AddArray(cellIds);
  vtkNew<vtkTriangleFilter> triangulate;
  triangulate->SetInputData(polygons);
  triangulate->PassVertsOff();
  triangulate->PassLinesOff();
  triangulate->Update();
  return triangulate->GetOutput();
}

void TriangulatePolygons(vtkPolyData* input, CellTriangles& triangles)
{
  const vtkSmartPointer<vtkPolyData> cut = CutPolygons(input);
  auto* from = vtkIdTypeArray::SafeDownCast(cut->GetCellData()->GetArray("CellIds"));
  const vtkIdType firstCell = FirstPolygon(input);
  const std::vector<char> isBroken = BrokenPolygons(input->GetPolys(), cut, from, firstCell);
  vtkNew<vtkIdList> ids;
  const auto add = [&](vtkIdType a, vtkIdType b, vtkIdType c, vtkIdType cell)
  {
    const int corners[3] = { static_cast<int>(ids->GetId(a)), static_cast<int>(ids->GetId(b)),
      static_cast<int>(ids->GetId(c)) };
    AddTriangle(corners, cell, triangles);
  };
  const std::vector<char> isEven = EvenQuads(input);
  std::vector<char> isCut(isEven.size(), 0);
  for (vtkIdType triangle = 0; triangle < cut->GetNumberOfPolys(); ++triangle)
  {
    const auto polygon = static_cast<std::size_t>(from->GetValue(triangle) - firstCell);
    if (polygon < isEven.size() && isEven[polygon])
    {
      if (!isCut[polygon])
      {
        input->GetPolys()->GetCellAtId(static_cast<vtkIdType>(polygon), ids);
        add(0, 1, 3, from->GetValue(triangle));
        add(2, 3, 1, from->GetValue(triangle));
        isCut[polygon] = 1;
      }
      continue;
    }
    cut->GetPolys()->GetCellAtId(triangle, ids);
    if (ids->GetNumberOfIds() == 3 && (polygon >= isBroken.size() || !isBroken[polygon]))
    {
      add(0, 1, 2, from->GetValue(triangle));
    }
  }
  for (std::size_t polygon = 0; polygon < isBroken.size(); ++polygon)
  {
    if (isBroken[polygon] && !isEven[polygon])
    {
      input->GetPolys()->GetCellAtId(static_cast<vtkIdType>(polygon), ids);
      for (vtkIdType corner = 2; corner < ids->GetNumberOfIds(); ++corner)
      {
        add(0, corner - 1, corner, firstCell + static_cast<vtkIdType>(polygon));
      }
    }
  }
}
}

bool HasOnlyTriangles(vtkPolyData* input)
{
  return input->GetNumberOfStrips() == 0 && input->GetPolys()->IsHomogeneous() == 3;
}

CellTriangles CollectTriangles(vtkPolyData* input, const std::string& role)
{
  if (!input || input->GetNumberOfPolys() + input->GetNumberOfStrips() == 0)
  {
    throw Error(ErrorCode::BadInput,
      "The " + role +
        " has no triangles: 0 polygons and strips. Give a surface (Extract Surface makes one of a "
        "volume mesh).");
  }
  if (input->GetNumberOfPoints() > std::numeric_limits<int>::max())
  {
    throw Error(ErrorCode::BadInput,
      "The " + role + " has " + std::to_string(input->GetNumberOfPoints()) +
        " points; at most 2147483647 are supported: decimate or split it.");
  }
  CellTriangles triangles;
  if (HasOnlyTriangles(input))
  {
    if (input->GetPolys()->IsStorage64Bit())
    {
      CopyTriangles<vtkTypeInt64Array>(input, role, triangles);
    }
    else
    {
      CopyTriangles<vtkTypeInt32Array>(input, role, triangles);
    }
  }
  else
  {
    RequireValidIds(input, role);
    RequireFinitePolygons(input, role);
    TriangulatePolygons(input, triangles);
  }
  if (triangles.CellIds.empty())
  {
    throw Error(
      ErrorCode::BadInput, "The " + role + " has no triangles with three different points.");
  }
  return triangles;
}

void RequireOnlyTriangles(vtkPolyData* input, const std::string& role)
{
  IdSample others;
  const vtkIdType firstStrip = FirstPolygon(input) + input->GetNumberOfPolys();
  ForEachPolygon(input,
    [&others, firstStrip](vtkIdType cell, vtkIdType size, const vtkIdType*)
    {
      if (size != 3 || cell >= firstStrip)
      {
        others.Add(cell);
      }
    });
  if (!others.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The " + role + " has " + others.Describe("cell", "cells") +
        " that are not triangles: triangulate the surface (Triangulate) before its forms are "
        "computed.");
  }
}
}
