// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Bytes.h"
#include "Base/Types.h"

#include <vector>

namespace cartan
{
/// The points in and around a surface, and the edges that hold them together. Weights
/// have no unit: an edge of the surface weighs what it weighs in a Laplacian.
struct VolumeGraph
{
  Points Nodes; ///< #N x 3, the surface's vertices first
  Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor> Edges; ///< #E x 2
  Eigen::VectorXd Weights;                                      ///< #E, positive or of a Laplacian

  int NumberOfNodes() const { return static_cast<int>(this->Nodes.rows()); }
  std::size_t GetBytes() const { return TotalBytes(this->Nodes, this->Edges, this->Weights); }
};

/// An edge of a graph that is being made.
struct GraphEdge
{
  int From;
  int To;
  double Weight;
};

/// The graph of these nodes and edges.
VolumeGraph ToGraph(Points nodes, const std::vector<GraphEdge>& edges);
}
