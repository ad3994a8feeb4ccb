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
constexpr const char* Advice =
  " Give the reference the same points and cells in the same order, such as the surface before it "
  "was deformed.";

void RequireSameCount(const std::string& what, vtkIdType current, vtkIdType reference)
{
  if (current != reference)
  {
    throw Error(ErrorCode::BadInput,
      "The input has " + std::to_string(current) + " " + what + ", the reference " +
        std::to_string(reference) + "." + Advice);
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
}

SurfacePair ReadSurfacePair(vtkPolyData* current, vtkPolyData* reference)
{
  Surface currentSurface = ReadSurface(current, "input");
  Surface referenceSurface = ReadSurface(reference, "reference");
  RequireSameCount("points", current->GetNumberOfPoints(), reference->GetNumberOfPoints());
  RequireSameCount("polygons", current->GetNumberOfPolys(), reference->GetNumberOfPolys());
  RequireSameCount("triangle strips", current->GetNumberOfStrips(), reference->GetNumberOfStrips());
  const vtkIdType firstPolygon = current->GetNumberOfVerts() + current->GetNumberOfLines();
  IdSample differences;
  CollectDifferences(current->GetPolys(), reference->GetPolys(), firstPolygon, differences);
  CollectDifferences(current->GetStrips(), reference->GetStrips(),
    firstPolygon + current->GetNumberOfPolys(), differences);
  if (!differences.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The input has " + differences.Describe("cell", "cells") +
        " with other points than in the reference." + Advice);
  }

  SurfacePair pair;
  pair.Warning = currentSurface.Warning;
  pair.Warning += (pair.Warning.empty() || referenceSurface.Warning.empty() ? "" : " ") +
    referenceSurface.Warning;
  // Where one of them is so flat that polygons cannot be triangulated, the
  // other one knows how.
  if (currentSurface.Mesh.NumberOfTriangles() > referenceSurface.Mesh.NumberOfTriangles())
  {
    pair.Mesh = currentSurface.Mesh;
    pair.CellIds = currentSurface.CellIds;
  }
  else
  {
    pair.Mesh = referenceSurface.Mesh;
    pair.CellIds = referenceSurface.CellIds;
    // Lines and vertices have ids before the polygons and may differ in number.
    const vtkIdType shift =
      firstPolygon - reference->GetNumberOfVerts() - reference->GetNumberOfLines();
    for (long long& cell : pair.CellIds)
    {
      cell += shift;
    }
  }
  pair.Current = PositionsFor(pair.Mesh, std::move(currentSurface), current, "input");
  pair.Reference = PositionsFor(pair.Mesh, std::move(referenceSurface), reference, "reference");
  return pair;
}
}
