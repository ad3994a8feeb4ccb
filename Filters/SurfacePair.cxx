// SPDX-License-Identifier: BSD-3-Clause
#include "SurfacePair.h"

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

/// The positions of all points that `mesh` uses. `surface` has those that its
/// own triangles use.
Points PositionsFor(
  const TriangleMesh& mesh, Surface surface, vtkPolyData* polyData, const std::string& role)
{
  IdSample nonFinite;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v) && !surface.Mesh.IsUsed(v))
    {
      Eigen::Vector3d position;
      polyData->GetPoint(v, position.data());
      surface.Positions.row(v) = (position - surface.Origin).transpose();
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
  return std::move(surface.Positions);
}

vtkIdType FirstPolygon(vtkPolyData* surface)
{
  return surface->GetNumberOfVerts() + surface->GetNumberOfLines();
}

void RequireSameConnectivity(const Named& first, const Named& other, const std::string& advice)
{
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
}

MatchedSurfaces ReadMatchedSurfaces(const std::vector<vtkPolyData*>& inputs,
  const std::vector<std::string>& roles, const std::string& advice)
{
  const Named first{ inputs.front(), roles.front() };
  MatchedSurfaces matched;
  std::vector<Surface> surfaces;
  // Where some are so flat that polygons cannot be triangulated, another one
  // knows how.
  std::size_t best = 0;
  for (std::size_t k = 0; k < inputs.size(); ++k)
  {
    surfaces.push_back(ReadSurface(inputs[k], roles[k]));
    RequireSameConnectivity(first, { inputs[k], roles[k] }, advice);
    if (surfaces[k].Mesh.NumberOfTriangles() > surfaces[best].Mesh.NumberOfTriangles())
    {
      best = k;
    }
    matched.Warning +=
      (matched.Warning.empty() || surfaces[k].Warning.empty() ? "" : " ") + surfaces[k].Warning;
    matched.Origins.push_back(surfaces[k].Origin);
    matched.ReadFrom.push_back(surfaces[k].ReadFrom);
  }
  matched.Mesh = surfaces[best].Mesh;
  matched.CellIds = surfaces[best].CellIds;
  // Lines and vertices have ids before the polygons and may differ in number.
  const vtkIdType shift = FirstPolygon(inputs.front()) - FirstPolygon(inputs[best]);
  for (long long& cell : matched.CellIds)
  {
    cell += shift;
  }
  for (std::size_t k = 0; k < inputs.size(); ++k)
  {
    matched.Positions.push_back(
      PositionsFor(matched.Mesh, std::move(surfaces[k]), inputs[k], roles[k]));
  }
  return matched;
}

SurfacePair ReadSurfacePair(vtkPolyData* current, vtkPolyData* reference)
{
  MatchedSurfaces matched = ReadMatchedSurfaces({ current, reference }, { "input", "reference" },
    "Give both the same points and cells in the same order, such as a surface before and after it "
    "was deformed.");
  return { std::move(matched.Mesh), std::move(matched.CellIds), std::move(matched.Positions[1]),
    std::move(matched.Positions[0]), std::move(matched.Warning) };
}
}
