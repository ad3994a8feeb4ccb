// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// A closed curve of boundary edges.
struct BoundaryLoop
{
  /// In the direction that has the surface on its left, seen from outside, from the
  /// smallest id on; at least 3, each once.
  std::vector<int> Vertices;
  int Component = 0; ///< the mesh's, see TriangleMesh::Component
};

/// All loops of the boundary, in the order of their smallest vertices. No two have a
/// vertex in common, since a manifold has one fan of triangles around each.
std::vector<BoundaryLoop> FindBoundaryLoops(const TriangleMesh& mesh);

/// What a closed polygon of `curve` (#C x 3) measures.
struct LoopMeasures
{
  double Length = 0.0;
  Eigen::Vector3d Center;     ///< of its length
  Eigen::Vector3d AreaVector; ///< half the sum of x_i x x_(i+1): area times normal where it is flat
};
LoopMeasures MeasureLoop(const Points& curve);
}
