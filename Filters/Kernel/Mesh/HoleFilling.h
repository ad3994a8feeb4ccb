// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Base/Types.h"

#include <limits>

namespace cartan
{
/// The longest loop of edges that FillHoles takes: the time grows with the cube.
constexpr int LargestHole = 500;

struct HoleOptions
{
  int MaximumEdges = 0; ///< holes of more edges stay; at most LargestHole
  double MaximumLength = std::numeric_limits<double>::infinity(); ///< of the loop, length units
};

struct HoleFill
{
  Triangles Faces;       ///< the new triangles, oriented as their surroundings
  int NumberOfHoles = 0; ///< filled ones
  int NumberOfOpen = 0;  ///< loops left: too long, or without a manifold filling
};

/// Fills the loops of border edges with triangles of their vertices. Of all
/// triangulations of a loop it takes the one whose largest angle between the
/// normals of neighboring triangles, those around the hole included, is smallest,
/// and of these the one of least area, by dynamic programming over parts of the
/// loop (Liepa, Filling Holes in Meshes, Symposium on Geometry Processing 2003,
/// section 2; Barequet, Sharir, Filling Gaps in the Boundary of a Polyhedron,
/// Computer Aided Geometric Design 12(2), 1995). No triangle gets an edge that
/// the surface has already, so the surface stays a manifold.
///
/// `triangles` are an oriented manifold; loops through a vertex with several
/// border edges are left open. O(n^3) for a loop of n edges. Throws
/// Error(Aborted).
HoleFill FillHoles(const Triangles& triangles, const Points& points, const HoleOptions& options,
  const ExecutionContext& context = {});
}
