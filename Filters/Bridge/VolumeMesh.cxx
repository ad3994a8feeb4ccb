// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/VolumeMesh.h"

#include "Kernel/Base/Bytes.h"

#include "vtkCellArray.h"
#include "vtkCellType.h"
#include "vtkGenericCell.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkStaticPointLocator.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

namespace cartan
{
namespace
{
/// Points this near, in parts of the size, are the same: more than float rounds.
constexpr double SamePlace = 1e-6;

void ReadCells(vtkUnstructuredGrid* grid, VolumeMesh& mesh)
{
  IdSample others;
  std::vector<vtkIdType> corners;
  vtkNew<vtkIdList> ids;
  vtkNew<vtkGenericCell> cell;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    const int type = grid->GetCellType(c);
    if (type == VTK_TETRA)
    {
      grid->GetCellPoints(c, ids);
      corners.insert(corners.end(), ids->begin(), ids->end());
      mesh.CellIds.push_back(c);
      continue;
    }
    cell->SetCellType(type);
    if (cell->GetCellDimension() == 3)
    {
      others.Add(c);
    }
  }
  if (!others.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      others.Describe("cell", "cells") +
        " of the volume mesh that are not linear tetrahedra: use Tetrahedralize first.");
  }
  if (mesh.CellIds.empty())
  {
    throw Error(ErrorCode::BadInput,
      "The volume mesh has no tetrahedra: make some (Delaunay 3D), or disconnect it for a "
      "lattice inside of the surface.");
  }
  mesh.Cells.resize(static_cast<Eigen::Index>(mesh.CellIds.size()), 4);
  for (Eigen::Index i = 0; i < mesh.Cells.size(); ++i)
  {
    mesh.Cells.data()[i] = mesh.NodeOfPoint[corners[i]];
  }
}

/// Gives the points at the surface's points these as nodes.
void MatchPoints(const Surface& surface, vtkUnstructuredGrid* grid, VolumeMesh& mesh)
{
  vtkNew<vtkStaticPointLocator> locator;
  locator->SetDataSet(grid);
  locator->BuildLocator();
  const double tolerance = SamePlace * grid->GetLength();
  IdSample lost;
  IdSample shared;
  for (int v = 0; v < surface.Mesh->NumberOfVertices(); ++v)
  {
    if (!surface.Mesh->IsUsed(v))
    {
      continue;
    }
    const Eigen::Vector3d place = surface.Positions->row(v).transpose() + surface.Origin;
    double squaredDistance = 0.0;
    const vtkIdType point =
      locator->FindClosestPointWithinRadius(tolerance, place.data(), squaredDistance);
    if (point < 0)
    {
      lost.Add(v);
    }
    else if (mesh.NodeOfPoint[point] >= 0)
    {
      shared.Add(v);
    }
    else
    {
      mesh.NodeOfPoint[point] = v;
    }
  }
  if (!lost.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      lost.Describe("point", "points") +
        " of the surface that are not points of the volume mesh: take the surface from it with "
        "Extract Surface.");
  }
  if (!shared.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      shared.Describe("point", "points") +
        " of the surface at the same place of the volume mesh as others: merge them with Prepare "
        "Surface.");
  }
}
}

std::size_t VolumeMesh::GetBytes() const
{
  return TotalBytes(this->Inner, this->Cells, this->CellIds, this->NodeOfPoint);
}

ContentKey KeyOfVolumeMesh(const Surface& surface, vtkUnstructuredGrid* grid)
{
  ContentKey key = surface.Key;
  key.Add(KeyOfArray(grid->GetPoints() ? grid->GetPoints()->GetData() : nullptr).GetValue());
  if (vtkCellArray* cells = grid->GetCells())
  {
    key.Add(KeyOfArray(cells->GetOffsetsArray()).GetValue());
    key.Add(KeyOfArray(cells->GetConnectivityArray()).GetValue());
    key.Add(KeyOfArray(grid->GetCellTypesArray()).GetValue());
  }
  return key;
}

VolumeMesh ReadVolumeMesh(const Surface& surface, vtkUnstructuredGrid* grid)
{
  VolumeMesh mesh;
  mesh.Key = KeyOfVolumeMesh(surface, grid);
  IdSample notFinite;
  for (vtkIdType point = 0; point < grid->GetNumberOfPoints(); ++point)
  {
    const Eigen::Vector3d place(grid->GetPoint(point));
    if (!place.allFinite())
    {
      notFinite.Add(point);
    }
  }
  if (!notFinite.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      notFinite.Describe("point", "points") +
        " of the volume mesh with coordinates that are not finite.");
  }
  mesh.NodeOfPoint.assign(grid->GetNumberOfPoints(), -1);
  if (grid->GetNumberOfPoints() > 0)
  {
    MatchPoints(surface, grid, mesh);
  }
  std::vector<vtkIdType> inner;
  for (vtkIdType point = 0; point < grid->GetNumberOfPoints(); ++point)
  {
    if (mesh.NodeOfPoint[point] < 0)
    {
      mesh.NodeOfPoint[point] = surface.Mesh->NumberOfVertices() + static_cast<int>(inner.size());
      inner.push_back(point);
    }
  }
  mesh.Inner.resize(static_cast<Eigen::Index>(inner.size()), 3);
  for (std::size_t i = 0; i < inner.size(); ++i)
  {
    mesh.Inner.row(static_cast<Eigen::Index>(i)) =
      (Eigen::Vector3d(grid->GetPoint(inner[i])) - surface.Origin).transpose();
  }
  ReadCells(grid, mesh);
  return mesh;
}

void WriteVolumeMesh(const Surface& surface, const VolumeMesh& mesh, const Points& nodes,
  vtkUnstructuredGrid* grid, vtkUnstructuredGrid* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(grid->GetPoints()->GetDataType());
  points->SetNumberOfPoints(grid->GetNumberOfPoints());
  for (vtkIdType point = 0; point < grid->GetNumberOfPoints(); ++point)
  {
    const Eigen::Vector3d place = nodes.row(mesh.NodeOfPoint[point]).transpose() + surface.Origin;
    points->SetPoint(point, place.data());
  }
  output->ShallowCopy(grid);
  output->SetPoints(points);
}
}
