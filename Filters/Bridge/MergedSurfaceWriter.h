// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/SurfaceReader.h"
#include "Kernel/Merging/Transition.h"

namespace cartan
{
/// One of two surfaces that were sewn together, and where it came from.
struct MergedInput
{
  const Surface* Read;
  vtkPolyData* Data;
};

/// `fading` is empty where nothing fades. Real arrays are interpolated there, those of whole
/// numbers and texts are of the nearest point of the surface that has the larger part.
///
/// Makes `output` the joined surface: triangles, points in the target's precision
/// (`positions`, #V of the joined surface x 3, relative to the target's origin) without
/// those that no triangle uses, the point and cell arrays that both inputs have with
/// equal names, types and components (of the target where it has the point, see Fading
/// where points fade), and
/// - `MergeOrigin` (int, points and cells): 0 target, 1 source, 2 on the seam,
/// - `OriginalPointIds`, `OriginalCellIds` (vtkIdType): in the target where it has the
///   point or cell, else in the source; of a point on an edge of the target, its nearer end,
/// - `SourcePart` (double, points) with `fading`,
/// - `Normals`, anew, when an input has normals.
void WriteMergedSurface(const MergedInput& target, const MergedInput& source,
  const JoinedSurface& joined, const TriangleMesh& mesh, const Points& positions,
  const Fading& fading, vtkPolyData* output);
}
