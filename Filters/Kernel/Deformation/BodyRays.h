// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/RayTree.h"
#include "Mesh/TriangleMesh.h"

namespace cartan
{
/// What rays tell of the body that a closed surface bounds. Where all triangles are
/// oriented inward, everything here is turned around.
class BodyRays
{
public:
  /// Throws Error(BadInput) where the surface is open or encloses no volume. Keeps
  /// references to mesh and points.
  BodyRays(const TriangleMesh& mesh, const Points& points, const ExecutionContext& context = {});

  double GetVolume() const { return this->Volume; }
  const Points& GetNormals() const { return this->Normals; }         ///< outward, #V x 3
  const Points& GetAreaVectors() const { return this->AreaVectors; } ///< outward, #T x 3

  RayHit FirstHit(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const
  {
    return this->Tree.FirstHit(from, direction);
  }

  /// Whether a hit leaves the body.
  bool Leaves(const RayHit& hit, const Eigen::Vector3d& direction) const
  {
    return hit.Triangle >= 0 && this->AreaVectors.row(hit.Triangle).dot(direction) > 0.0;
  }

  /// Whether most of six rays along the axes leave the body, and none of them meets it
  /// nearer than `nearest`.
  bool IsInside(const Eigen::Vector3d& place, double nearest) const;

  /// Whether the straight way between two points does not pass through the surface.
  bool Sees(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

private:
  double Volume;
  double Sense; ///< -1 where triangles are oriented inward
  RayTree Tree;
  Points Normals;
  Points AreaVectors;
};
}
