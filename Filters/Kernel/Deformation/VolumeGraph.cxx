// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/VolumeGraph.h"

namespace cartan
{
VolumeGraph ToGraph(Points nodes, const std::vector<GraphEdge>& edges)
{
  VolumeGraph graph;
  graph.Nodes = std::move(nodes);
  graph.Edges.resize(static_cast<Eigen::Index>(edges.size()), 2);
  graph.Weights.resize(graph.Edges.rows());
  for (Eigen::Index e = 0; e < graph.Edges.rows(); ++e)
  {
    graph.Edges.row(e) << edges[e].From, edges[e].To;
    graph.Weights[e] = edges[e].Weight;
  }
  return graph;
}
}
