// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/TriangleMesh.h"

namespace cartan
{
/// Triangles and vertices in an order in which the connectivity takes few bits.
struct TraversalOrder
{
  Triangles Faces;           ///< #T x 3, by new numbers
  std::vector<int> Vertices; ///< the old number of each new one: #V
  int NumberOfUsed = 0;      ///< vertices in triangles, which come first

  /// Rows of `values`, which are in the old order, in the new one.
  Points Reordered(const Points& values) const;
};

/// Walks over the triangles as Edgebreaker does (Rossignac, Edgebreaker: Connectivity
/// Compression for Triangle Meshes, IEEE TVCG 5(1), 1999): from a triangle to the one on
/// its right, or else on its left, and back to those that were passed by. Vertices are
/// numbered when they are met. A triangle mostly shares an edge with the one before, and
/// its third vertex is a new one, or next to the one that was met before.
TraversalOrder OrderByTraversal(const TriangleMesh& mesh);
}
