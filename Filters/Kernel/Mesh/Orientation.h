// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Base/Types.h"

#include <vector>

/// The sides of triangles that need not be a manifold.
namespace cartan
{
struct ConsistentOrientation
{
  std::vector<char> IsReversed;   ///< #T, which triangles to turn over
  int NumberOfPatches = 0;        ///< parts that hang together over edges of two triangles
  int NumberOfContradictions = 0; ///< edges of two triangles that stay inconsistent
};

/// Turns triangles over so that those on either side of each edge of exactly two
/// triangles agree. A patch, what hangs together over such edges, keeps the
/// orientation of the larger part of its area (at a tie, that of its first
/// triangle). A one-sided patch, such as a Moebius strip, keeps contradictions
/// along a cut that makes it two-sided. O(#T log valence).
ConsistentOrientation OrientConsistently(
  const Triangles& triangles, const Points& points, const ExecutionContext& context = {});

struct OutwardOrientation
{
  std::vector<char> IsReversed; ///< #T, which triangles to turn over
  int NumberOfReversedComponents = 0;
};

/// Turns closed components over so that they face outward, or, with
/// `alternatesNested`, a component inside an odd number of others inward: it is
/// the wall of a cavity. A component is closed when each of its edges has two
/// triangles of opposite direction. Others keep their orientation, and so do
/// components without volume (below 1e-9 area^(3/2)).
///
/// A component is inside another when the other winds an odd number of times
/// around a point of it; the winding number is the sum of the triangles' solid
/// angles (Van Oosterom, Strackee, The Solid Angle of a Plane Triangle, IEEE
/// Transactions on Biomedical Engineering 30(2), 1983). Throws Error(Aborted).
OutwardOrientation OrientOutwards(const Triangles& triangles, const Points& points,
  bool alternatesNested, const ExecutionContext& context = {});

/// Swaps the last two corners of the triangles marked.
void ReverseTriangles(Triangles& triangles, const std::vector<char>& isReversed);
}
