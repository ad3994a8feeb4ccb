// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/PreparedSurface.h"

#include "vtkSmartPointer.h"

class vtkPolyData;

/// What vtkPrepareSurface does by default, inside of a filter whose input needs
/// it. Private to the filters, not installed.
namespace cartan
{
/// How a surface is prepared: for all that have its cells.
struct InputPreparation
{
  TriangleSoup Soup;
  RepairedSurface Repaired;

  std::size_t GetBytes() const;
};

/// Throws Error(BadInput) as ReadTriangles and RepairSurface do.
std::unique_ptr<InputPreparation> PrepareInput(
  vtkPolyData* input, const std::string& role, const ExecutionContext& context);

/// The prepared surface, with the points and arrays of `input`.
vtkSmartPointer<vtkPolyData> ApplyPreparation(
  const InputPreparation& preparation, vtkPolyData* input);

/// Writes `result`, which a filter made of the prepared `input`, onto the points
/// and cells of `original`: points, arrays of points and cells, what is new among
/// the field arrays, and which scalars are active. Returns a warning, empty if
/// there is nothing to say.
std::string RestoreResult(
  vtkPolyData* result, vtkPolyData* input, vtkPolyData* original, vtkPolyData* output);
}
