// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/TriangleMesh.h"

#include <array>
#include <functional>
#include <vector>

namespace cartan
{
/// The closest point of a triangle to another point.
struct ClosestPoint
{
  Eigen::Vector3d Weights = Eigen::Vector3d::UnitX(); ///< barycentric coordinates
  double Distance = 0.0;
};
ClosestPoint ClosestOnTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
  const Eigen::Vector3d& c, const Eigen::Vector3d& point);

/// A tree of boxes over triangles, one in each leaf, each node with half the triangles of
/// its parent (balanced along the longest side). It is immutable, so several threads may
/// use it.
class TriangleTree
{
public:
  struct Node
  {
    Eigen::AlignedBox3d Box;
    double Area = 0.0;
    int Second = 0;    ///< the second child; the first is the next node
    int Triangle = -1; ///< of a leaf, else -1
  };

  /// Keeps references: both must live as long as the tree. At least one triangle.
  /// O(#T log #T).
  TriangleTree(const Triangles& triangles, const Points& points);

  /// Those of children come after that of their parent.
  const std::vector<Node>& GetNodes() const { return this->Nodes; }

  ClosestPoint ClosestOn(int triangle, const Eigen::Vector3d& point) const;

  /// The triangle that is closest to a point, and the closest point on it; of several at
  /// one distance the first in the tree. O(log #T) near the surface.
  std::pair<int, ClosestPoint> Closest(const Eigen::Vector3d& point) const;

private:
  void Build(std::vector<int>& ids, const Points& centers, int begin, int end);

  const Triangles& Faces;
  const Points& Positions;
  std::vector<Node> Nodes;
};
}
