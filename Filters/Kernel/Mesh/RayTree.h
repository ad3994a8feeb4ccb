// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Base/Types.h"

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
/// triangles, each with half the triangles of its parent. No ray passes between
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
  struct Node
  {
    Eigen::AlignedBox3d Box;
    int First = 0; // the first triangle of a leaf, else the second child
    int Count = 0; // triangles of a leaf, else 0: the first child is the next node
  };
  struct Ray;

  void Build(std::vector<Eigen::AlignedBox3d>& boxes, int begin, int end, double padding,
    const ExecutionContext& context);

  Eigen::Vector3d Center;               // what the coordinates below are relative to
  std::vector<Node> Nodes;              // those below a node follow it
  std::vector<int> Ids;                 // of the triangles in the order of the leaves: #T
  std::vector<Eigen::Matrix3d> Corners; // in the same order, a corner per column: #T
};
}
