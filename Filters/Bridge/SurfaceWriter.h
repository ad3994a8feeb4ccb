// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/SurfaceReader.h"
#include "Kernel/Deformation/PositionRows.h"

namespace cartan
{
/// Makes `output` a shallow copy of `input`, from which `surface` was read, with
/// new points in the input's precision: `positions` (#V x 3, relative to the
/// surface's origin) for used points, the input's own for the others. Points that
/// did not move keep their coordinates to the last bit. Point and cell normals, if
/// present, turn with the surface: from the computed normal before to the one
/// after, by the shortest way.
///
/// Throws Error(BadInput) when a coordinate is not finite or outgrows the input's
/// precision. Returns what is odd, in sentences.
std::string WriteSurface(const Surface& surface, const Points& positions, vtkPolyData* input,
  vtkPolyData* output, const ExecutionContext& context);

/// The same from rows in one pass over memory, for an input without normals. False, and `output`
/// has the points of the input, where a coordinate is not finite, outgrows the precision, or
/// moves by more than `farthest`.
bool WriteSurfaceRows(const Surface& surface, const PositionRows& rows, double farthest,
  vtkPolyData* input, vtkPolyData* output, const ExecutionContext& context);

/// The same for positions that do not come from the input's: double precision
/// (#V x 3 in world coordinates), and normals computed from them.
void WriteReconstruction(const Surface& surface, const Points& positions, vtkPolyData* input,
  vtkPolyData* output, const ExecutionContext& context);
}
