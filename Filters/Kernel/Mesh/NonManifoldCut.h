// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Base/Types.h"

#include <vector>

namespace cartan
{
/// A surface cut into an oriented manifold.
struct NonManifoldCut
{
  Triangles Faces; ///< #T x 3, with the copies' ids
  /// The vertex that each new one is a copy of; the first of them has the id
  /// #V. A vertex keeps its id in the copy that its first triangle uses.
  std::vector<int> CopyOf;
  int NumberOfEdges = 0;          ///< edges of more than two triangles
  int NumberOfContradictions = 0; ///< edges that both triangles run through in one direction
  int NumberOfPoints = 0;         ///< vertices that got copies
};

/// Gives each vertex one copy per class of corners, so that TriangleMesh takes
/// the result. Two corners at a vertex are in one class when their triangles
/// share an edge at it over which the surface goes on: an edge of exactly two
/// triangles of opposite direction. At edges of four, six, ... triangles where
/// directions alternate around the edge, bodies touch: the triangles on either
/// side of each body go together, unless that leaves more than two on an edge.
/// Such bodies stay closed. Edges of three triangles, and those whose triangles
/// contradict each other, are cut.
///
/// No triangle names a vertex twice. A surface that is an oriented manifold
/// is returned as it is. O(#T log valence). Throws Error(Aborted).
NonManifoldCut CutNonManifold(
  const Triangles& triangles, const Points& points, const ExecutionContext& context = {});
}
