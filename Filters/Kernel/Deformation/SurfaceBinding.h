// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Mesh/TriangleTree.h"

#include <memory>
#include <vector>

namespace cartan
{
/// Points that follow a surface: bound once to the frames near them, and evaluated for each
/// deformed surface of the same connectivity.
///
/// The places near a point x are the closest points c_t on the triangles t whose distance d_t
/// is below Reach d, d the distance to the nearest one, with weights
///
///   w_t ~ area_t (d / d_t - 1 / Reach)^2,   sum w_t = 1.
///
/// Distances change continuously with x, and so do weights, also across the medial axis. Far
/// triangles are taken together in groups that look no larger than GroupAngle, about their
/// centers. With p' the deformed surface and q_v the rotations of one-rings, as quaternions,
///
///   x' = c' + R (x - c),   c = sum w_t c_t,   c' = sum w_t c'_t,   R ~ sum w_t q(c_t).
///
/// So a point on the surface has one place and goes exactly to it, a rigid motion of the
/// surface is followed exactly, and a surface that bends with radius r carries points at the
/// distance d up to an error of d^2 / r.
class SurfaceBinding
{
public:
  /// How far triangles matter, in distances to the nearest one.
  static constexpr double Reach = 2.0;

  /// The largest size of a group of triangles, in parts of its distance.
  static constexpr double GroupAngle = 0.5;

  /// Keeps the rest positions of both. `queries` (#Q x 3) are in the surface's coordinates.
  SurfaceBinding(std::shared_ptr<const TriangleMesh> mesh, std::shared_ptr<const Points> rest,
    Points queries, const ExecutionContext& context = {});

  struct Carried
  {
    Points Positions;   ///< #Q x 3
    Matrices Rotations; ///< #Q x 9
  };

  /// `current` (#V x 3) is the deformed surface.
  Carried Evaluate(const Points& current, const ExecutionContext& context = {}) const;

  /// How far coordinates of `current` that are `rounding` off may put each point at most: #Q. The
  /// turn of a one-ring with the longest edge l and the area A is known to about rounding l / A.
  Eigen::VectorXd RoundingErrors(const Points& current, double rounding) const;

  /// The vertex that a point lies on, -1 elsewhere.
  int VertexOf(Eigen::Index query) const;

  /// From each point to the surface at rest: #Q.
  const Eigen::VectorXd& GetDistances() const { return this->Distances; }

  std::size_t GetBytes() const;

private:
  /// A vertex v, or the group of node n as #V + n, with its weight.
  struct Share
  {
    int Source;
    double Weight;
  };
  std::vector<Share> Bind(const Eigen::Vector3d& query, double& distance) const;
  void AddNear(const Eigen::Vector3d& query, double distance, std::vector<Share>& shares) const;
  void AddPlace(
    int triangle, const ClosestPoint& place, double weight, std::vector<Share>& shares) const;
  Field WithGroups(const Field& ofVertices) const;

  std::shared_ptr<const TriangleMesh> Mesh;
  std::shared_ptr<const Points> Rest;
  Points Queries;
  TriangleTree Tree;
  Field RestSources; ///< (#V + #nodes) x 3: vertices, and centers of nodes
  std::vector<std::vector<Share>> Shares;
  Eigen::VectorXd Distances;
};
}
