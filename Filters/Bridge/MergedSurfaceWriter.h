// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/SurfaceReader.h"
#include "Kernel/Merging/Seam.h"

namespace cartan
{
/// One of two surfaces that were sewn together, and where it came from.
struct MergedInput
{
  const Surface* Read;
  vtkPolyData* Data;
};

/// Makes `output` the joined surface: triangles, points in the target's precision
/// (`positions`, #V of the joined surface x 3, relative to the target's origin) without
/// those that no triangle uses, the point and cell arrays that both inputs have with
/// equal names, types and components (of the target where it has the point), and
/// - `MergeOrigin` (int, points and cells): 0 target, 1 source, 2 on the seam,
/// - `OriginalPointIds`, `OriginalCellIds` (vtkIdType): in the target where it has the
///   point or cell, else in the source,
/// - `Normals`, anew, when an input has normals.
void WriteMergedSurface(const MergedInput& target, const MergedInput& source,
  const JoinedSurface& joined, const TriangleMesh& mesh, const Points& positions,
  vtkPolyData* output);
}
