// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Merging/LoopMatching.h"
#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// The unit normals at `vertices`, means of the normals of the triangles around
/// weighted by their angles there: #vertices x 3. Zero where there is none.
Points AngleWeightedNormals(
  const TriangleMesh& mesh, const Points& points, const std::vector<int>& vertices);

/// A closed curve of a surface with the normals along it.
struct BoundaryCurve
{
  Points Positions; ///< #C x 3
  Points Normals;   ///< #C x 3
};

/// The similarity s_i R_i that takes the surroundings of each vertex of the source's
/// curve to those of its place on the target's: #C x 9. R_i takes the frame of tangent,
/// normal and their cross product to that at the place; s_i is the ratio of the tangents'
/// lengths (Fu, Au, Tai 2007, section 5.1). Tangents are differences between the two
/// neighbors of a vertex and between their places, so that keys that are spaced
/// unevenly, and the shorter chords of a coarser curve, scale alike on both sides;
/// normals are made orthogonal to them. Throws Error(BadInput) naming `sourceIds` where
/// neighbors are in one place, so that there is no tangent, or the normal vanishes.
Matrices LoopSimilarities(const BoundaryCurve& source, const BoundaryCurve& target,
  const std::vector<CurvePlace>& places, const std::vector<int>& sourceIds);
}
