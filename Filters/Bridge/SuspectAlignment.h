// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/SurfaceReader.h"

namespace cartan
{
/// A suspect surface where the original is, both relative to the original's origin.
struct AlignedSuspect
{
  Points Moved;      ///< #V of the suspect x 3
  Points AtOriginal; ///< #V of the original x 3: the suspect's place of each of its vertices
  bool IsResampled;  ///< the places were looked for, because points or cells differ
};

/// Moves the suspect by the similarity that best maps its vertices on those of the original,
/// where both have the same triangles. Else by iterated closest points (Besl, McKay, A Method
/// for Registration of 3-D Shapes, 1992) from the axes of inertia in all 24 orders; then a
/// vertex of the original is found at the vertex of the suspect if nearly all are nearest to
/// each other, as when points are shuffled, or else at the closest point of the surface.
/// Without `isMoved` the suspect stays where it is.
AlignedSuspect AlignSuspect(const Surface& original, const Surface& suspect, bool isMoved,
  const ExecutionContext& context = {});
}
