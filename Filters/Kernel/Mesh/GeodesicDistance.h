// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

#include <limits>
#include <vector>

namespace cartan
{
/// The length of the shortest path over the surface from each vertex to the
/// nearest of `sources` (vertex ids, repetitions allowed): #V, in length units;
/// infinity where there is no path, at unused vertices that are not sources,
/// and beyond `limit`.
///
/// Fast marching (Kimmel and Sethian, Computing geodesic paths on manifolds,
/// 1998): vertices are settled in the order of their distance, and a vertex
/// gets its value from two settled corners of a triangle. Where the shortest
/// paths of both corners end at the same source, the triangle and that source
/// are unfolded into the plane, which is exact if the surface between them is
/// developable (Novotni and Klein, Computing geodesic distances on triangular
/// meshes, 2002); elsewhere the front is approximated by a straight line. A
/// settled vertex is settled again if a triangle with an obtuse angle gives a
/// better value later.
///
/// Never larger than the shortest path along edges, never smaller than the
/// straight line to the nearest source. The error is of first order in the
/// edge length at worst. With a limit, only the region within it and one ring
/// of triangles around it are visited.
///
/// Throws Error(BadInput) if a source is not a vertex or the limit is NaN or
/// negative; points of used vertices must be finite.
Eigen::VectorXd GeodesicDistance(const TriangleMesh& mesh, const Points& points,
  const std::vector<int>& sources, double limit = std::numeric_limits<double>::infinity(),
  const ExecutionContext& context = {});
}
