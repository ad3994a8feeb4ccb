// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// A triangle that discretizes nothing and only breaks the numbers: a *cap*, a vertex
/// lower over the opposite edge than 5 % of it, gives cotangent weights of the
/// inverse of that height with both signs, and a *needle*, with an edge shorter than
/// .1 % of the longest of each of its triangles, or than 1e-5 of the longest edge
/// at one of its ends, weights of that ratio.
struct Sliver
{
  bool IsCap;
  double Squared; ///< length of a cap's long edge, or of a needle's short one
  int Vertex;     ///< the low one of a cap, the smaller one of a short edge
  int Edge;       ///< of Vertex: with the cap on its left, or the short one
};

/// The slivers in increasing order of Squared: that of their vertices does not matter,
/// but where lengths are equal. O(#T).
std::vector<Sliver> FindSlivers(const TriangleMesh& mesh, const Points& points);
}
