// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Base/Types.h"

#include <array>
#include <vector>

namespace cartan
{
/// The first point where a ray meets the surface.
struct RayHit
{
  double Distance = -1.0; ///< in length units; negative: nowhere
  int Triangle = -1;
};

/// Finds the first triangle that a ray meets: a tree of boxes over the
/// triangles, each with a quarter of the triangles of its parent, so that a ray is tried against
/// four boxes, or four triangles, at once. No ray passes between
/// neighbors that share an edge or a vertex. It is immutable, so several
/// threads may use it.
class RayTree
{
public:
  /// Keeps a copy of the corners. Coordinates are finite. O(#T log #T).
  RayTree(const Triangles& triangles, const Points& points, const ExecutionContext& context = {});

  /// The triangle that the ray from a point in a unit direction meets first, on
  /// either side, its start included; of several at the same distance the one
  /// of the smallest id. Triangles without area are ignored. Triangles parallel
  /// to the ray may be missed, but their neighbors are found. The start is at
  /// most some hundred bounding diagonals away. O(log #T) for most surfaces.
  RayHit FirstHit(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const;

private:
  static constexpr int Width = 4;
  using Lanes = Eigen::Array<double, Width, 1>;

  /// Up to four boxes below a box.
  struct Node
  {
    Lanes Low[3];                 // by axes; infinite where there is no child
    Lanes High[3];                // as Low
    std::array<int, Width> Child; // a node, or -1 - i of the i-th leaf
  };
  /// Up to four triangles.
  struct Leaf
  {
    Lanes Corners[3][3];        // by corners and axes
    std::array<int, Width> Ids; // -1 where there is no triangle
  };
  struct Ray;
  struct Builder;

  void MeetLeaf(const Ray& ray, const Leaf& leaf, RayHit& nearest) const;

  Eigen::Vector3d Center;  // what the coordinates below are relative to
  std::vector<Node> Nodes; // the first one is above all others
  std::vector<Leaf> Leaves;
};
}
