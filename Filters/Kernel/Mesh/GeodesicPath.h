// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// A place on an edge: (1 - Part) of vertex From and Part of vertex To; a vertex where both
/// are the same.
struct EdgePoint
{
  int From;
  int To;
  double Part;

  bool IsVertex() const { return this->From == this->To; }
  Eigen::RowVector3d In(const Points& points) const
  {
    return (1.0 - this->Part) * points.row(this->From) + this->Part * points.row(this->To);
  }
};

/// A geodesic across triangles from one vertex to another, both included: straight in the
/// plane of two adjacent triangles, unfolded. It descends GeodesicDistance, as Kimmel and
/// Sethian (Computing geodesic paths on manifolds, 1998) do, in each triangle toward where
/// the distances at its corners see the end, and is straightened after that. As long as the
/// shortest where the surface between is developable, elsewhere to the first order in the edge
/// length; never longer than ShortestEdgePath, along which it runs where it finds no other way.
/// Empty where there is no path.
std::vector<EdgePoint> GeodesicPath(
  const TriangleMesh& mesh, const Points& points, int from, int to);

/// A curve across a surface, and the vertices beside it.
struct CurveAcross
{
  std::vector<int> Vertices; ///< a path of edges: of each edge that is crossed the nearer end
  Points Places;             ///< #Vertices x 3, the places of the curve beside them
};

/// Geodesics from each of `picks` (two or more) to the next; with `isClosed` from the last to
/// the first, too, which is not repeated. Throws Error(BadInput) where there is no path, or the
/// vertices beside it pass one twice.
CurveAcross GeodesicThrough(
  const TriangleMesh& mesh, const Points& points, const std::vector<int>& picks, bool isClosed);

/// The distance of each vertex from a curve: #V, infinite beyond `limit`. GeodesicDistance
/// from its vertices where they are on it. Else that may be wrong by as much as they are beside
/// it, and the distance is the largest that surely is no larger: this less, or the straight
/// line's, which is right in the plane.
Eigen::VectorXd DistanceFromCurve(const TriangleMesh& mesh, const Points& points,
  const CurveAcross& curve, bool isClosed, double limit);
}
