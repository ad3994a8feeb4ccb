// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/MatchedSurfaces.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <algorithm>

namespace cartan
{
namespace
{
/// A surface and its name in messages.
struct Named
{
  vtkPolyData* Surface;
  const std::string& Role;
};

void RequireSameCount(const std::string& what, const Named& first, const Named& other,
  vtkIdType (vtkPolyData::*count)(), const std::string& advice)
{
  const vtkIdType here = (first.Surface->*count)();
  const vtkIdType there = (other.Surface->*count)();
  if (here != there)
  {
    throw Error(ErrorCode::BadInput,
      "The " + first.Role + " has " + std::to_string(here) + " " + what + ", the " + other.Role +
        " " + std::to_string(there) + ". " + advice);
  }
}

/// Adds the cells whose points differ, numbered from `firstCell`.
void CollectDifferences(
  vtkCellArray* current, vtkCellArray* reference, vtkIdType firstCell, IdSample& differences)
{
  auto currentCells = vtk::TakeSmartPointer(current->NewIterator());
  auto referenceCells = vtk::TakeSmartPointer(reference->NewIterator());
  referenceCells->GoToFirstCell();
  for (currentCells->GoToFirstCell(); !currentCells->IsDoneWithTraversal();
       currentCells->GoToNextCell(), referenceCells->GoToNextCell())
  {
    vtkIdType currentSize = 0;
    vtkIdType referenceSize = 0;
    const vtkIdType* currentIds = nullptr;
    const vtkIdType* referenceIds = nullptr;
    currentCells->GetCurrentCell(currentSize, currentIds);
    referenceCells->GetCurrentCell(referenceSize, referenceIds);
    if (currentSize != referenceSize ||
      !std::equal(currentIds, currentIds + currentSize, referenceIds))
    {
      differences.Add(firstCell + currentCells->GetCurrentCellId());
    }
  }
}

/// The positions of all points that `mesh` uses. `surface` has those that its own
/// triangles use.
std::shared_ptr<const Points> PositionsFor(
  const TriangleMesh& mesh, const Surface& surface, vtkPolyData* polyData, const std::string& role)
{
  if (surface.Mesh.get() == &mesh)
  {
    return surface.Positions;
  }
  auto positions = std::make_shared<Points>(*surface.Positions);
  IdSample nonFinite;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v) && !surface.Mesh->IsUsed(v))
    {
      Eigen::Vector3d position;
      polyData->GetPoint(v, position.data());
      positions->row(v) = (position - surface.Origin).transpose();
      if (!position.allFinite())
      {
        nonFinite.Add(v);
      }
    }
  }
  if (!nonFinite.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The " + role + " has " + nonFinite.Describe("point", "points") +
        " with a NaN or infinite coordinate: repair or remove them.");
  }
  return positions;
}

vtkIdType FirstPolygon(vtkPolyData* surface)
{
  return surface->GetNumberOfVerts() + surface->GetNumberOfLines();
}

void RequireSameConnectivity(const Named& first, const Named& other, const std::string& advice)
{
  if (first.Surface->GetNumberOfPoints() == other.Surface->GetNumberOfPoints() &&
    KeyOfCells(first.Surface) == KeyOfCells(other.Surface))
  {
    return;
  }
  RequireSameCount("points", first, other, &vtkPolyData::GetNumberOfPoints, advice);
  RequireSameCount("polygons", first, other, &vtkPolyData::GetNumberOfPolys, advice);
  RequireSameCount("triangle strips", first, other, &vtkPolyData::GetNumberOfStrips, advice);
  const vtkIdType firstPolygon = FirstPolygon(first.Surface);
  IdSample differences;
  CollectDifferences(
    first.Surface->GetPolys(), other.Surface->GetPolys(), firstPolygon, differences);
  CollectDifferences(first.Surface->GetStrips(), other.Surface->GetStrips(),
    firstPolygon + first.Surface->GetNumberOfPolys(), differences);
  if (!differences.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The " + first.Role + " has " + differences.Describe("cell", "cells") +
        " with other points than in the " + other.Role + ". " + advice);
  }
}

/// The triangles of `best` with the cell ids of the first surface: lines and
/// vertices have ids before the polygons and may differ in number.
std::shared_ptr<const Connectivity> CellsOfFirst(
  const std::shared_ptr<const Connectivity>& best, vtkIdType shift)
{
  if (shift == 0)
  {
    return best;
  }
  auto cells = std::make_shared<Connectivity>(*best);
  for (long long& cell : cells->CellIds)
  {
    cell += shift;
  }
  return cells;
}
}

void RequireSameCells(vtkPolyData* first, const std::string& firstRole, vtkPolyData* other,
  const std::string& otherRole, const std::string& advice)
{
  RequireSameConnectivity({ first, firstRole }, { other, otherRole }, advice);
}

Surface MatchedSurfaces::First() const
{
  Surface first;
  first.Cells = this->Cells;
  first.Mesh = this->Mesh;
  first.Positions = this->Positions.front();
  first.Origin = this->Origins.front();
  return first;
}

MatchedSurfaces ReadMatchedSurfaces(const std::vector<vtkPolyData*>& inputs,
  const std::vector<std::string>& roles, const std::string& advice, const ExecutionContext& context)
{
  const Named first{ inputs.front(), roles.front() };
  MatchedSurfaces matched;
  std::vector<std::shared_ptr<const Surface>>& surfaces = matched.Surfaces;
  // Where some are so flat that polygons cannot be triangulated, another one
  // knows how.
  std::size_t best = 0;
  for (std::size_t k = 0; k < inputs.size(); ++k)
  {
    const double count = static_cast<double>(inputs.size());
    surfaces.push_back(
      ReadSurface(inputs[k], roles[k], context.Part(k / count, (k + 1.0) / count)));
    RequireSameConnectivity(first, { inputs[k], roles[k] }, advice);
    if (surfaces[k]->Mesh->NumberOfTriangles() > surfaces[best]->Mesh->NumberOfTriangles())
    {
      best = k;
    }
    const std::string warning = surfaces[k]->Describe(roles[k], inputs[k]);
    matched.Warning += (matched.Warning.empty() || warning.empty() ? "" : " ") + warning;
    matched.Origins.push_back(surfaces[k]->Origin);
  }
  matched.Cells =
    CellsOfFirst(surfaces[best]->Cells, FirstPolygon(inputs.front()) - FirstPolygon(inputs[best]));
  matched.Mesh = { matched.Cells, &matched.Cells->Mesh };
  for (std::size_t k = 0; k < inputs.size(); ++k)
  {
    matched.Positions.push_back(PositionsFor(*matched.Mesh, *surfaces[k], inputs[k], roles[k]));
  }
  return matched;
}
}
