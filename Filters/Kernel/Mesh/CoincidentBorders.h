// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Error.h"
#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

namespace cartan
{
/// Where the surface looks closed and is not: two border edges in one place
/// that would become one inner edge if their ends were merged. Split normals,
/// texture seams and triangle soup make such borders, and every deformation
/// opens them to cracks.
struct CoincidentBorders
{
  /// Points within this part of the bounding diagonal are in one place: about
  /// what single precision leaves of an angle that went around once.
  static constexpr double SamePlace = 1e-6;

  IdSample Points;       ///< the ends of such edges
  int NumberOfEdges = 0; ///< such border edges, two for each inner edge there would be
  /// The tolerance that merges them, as a part of the bounding diagonal: 0 where
  /// all coordinates are equal, else SamePlace.
  double RelativeTolerance = 0.0;

  bool IsEmpty() const { return this->NumberOfEdges == 0; }
};

/// Three or more border edges in one place are not counted, since no merging
/// closes them: pages of a book, cut where they met. Ids are those of the mesh. O(#border log
/// #border). Throws Error(Aborted).
CoincidentBorders FindCoincidentBorders(
  const TriangleMesh& mesh, const Points& points, const ExecutionContext& context = {});
}
