// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/VolumeGraph.h"
#include "Differential/Laplacian.h"

namespace cartan
{
struct LatticeOptions
{
  /// The distance between neighbors in length units. 0: the mean length of the
  /// surface's edges, but larger where that would make more than two points for each
  /// vertex, or more than MostPoints.
  double Spacing = 0.0;
  bool OuterLayer = true;
  LaplacianWeights Weights = LaplacianWeights::Cotangent; ///< of the surface's edges
  /// The factor of a three-dimensional Laplacian grows with n^(4/3): it takes 3 GB here.
  double MostPoints = 5e5;
};

/// The volumetric graph of a closed surface (Zhou et al., Large Mesh Deformation Using
/// the Volumetric Graph Laplacian, ACM SIGGRAPH 2005, section 3): the vertices, a cubic
/// lattice inside, and a layer outside at one spacing along the normals, or as far as
/// nothing is in the way. The energy of an edge vector's change g,
///
///   h |g e|^2 (lattice), (h / 2) w_ij |g e|^2 (surface),
///   2 A_i / (k |e|) |g e|^2 (a vertex to the k lattice points that it sees),
///
/// approximates the integral of |g|^2 over the volume; all are divided by h / 2. A
/// vertex that sees no lattice point, as in thin parts, is joined to the surface across.
///
/// Throws Error(BadInput) where the surface is open or encloses no volume, and
/// Error(TooLarge) where the lattice has too many points.
VolumeGraph MakeLatticeGraph(const TriangleMesh& mesh, const Points& points,
  const LatticeOptions& options, const ExecutionContext& context = {});
}
