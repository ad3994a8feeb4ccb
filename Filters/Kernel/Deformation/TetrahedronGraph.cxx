// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/TetrahedronGraph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace cartan
{
namespace
{
/// The edges of a tetrahedron by its corners.
constexpr std::array<std::array<int, 2>, 6> EdgesOfTetrahedron = { { { 0, 1 }, { 0, 2 }, { 0, 3 },
  { 1, 2 }, { 1, 3 }, { 2, 3 } } };
}

VolumeGraph MakeTetrahedronGraph(const Points& nodes, const Tetrahedra& tetrahedra)
{
  const Eigen::VectorXd determinants = TetrahedronDeterminants(nodes, tetrahedra);
  std::vector<GraphEdge> edges;
  double lengths = 0.0;
  for (Eigen::Index t = 0; t < tetrahedra.rows(); ++t)
  {
    for (const auto& [a, b] : EdgesOfTetrahedron)
    {
      const int from = std::min(tetrahedra(t, a), tetrahedra(t, b));
      const int to = std::max(tetrahedra(t, a), tetrahedra(t, b));
      const double length = (nodes.row(to) - nodes.row(from)).norm();
      lengths += length;
      edges.push_back(
        { from, to, length > 0.0 ? std::abs(determinants[t]) / (12.0 * length * length) : 0.0 });
    }
  }
  std::sort(edges.begin(), edges.end(),
    [](const GraphEdge& a, const GraphEdge& b)
    { return std::tie(a.From, a.To, a.Weight) < std::tie(b.From, b.To, b.Weight); });
  const double unit = static_cast<double>(edges.size()) / lengths;
  std::vector<GraphEdge> unique;
  for (const GraphEdge& edge : edges)
  {
    if (unique.empty() || unique.back().From != edge.From || unique.back().To != edge.To)
    {
      unique.push_back({ edge.From, edge.To, 0.0 });
    }
    unique.back().Weight += unit * edge.Weight;
  }
  return ToGraph(nodes, unique);
}

Eigen::VectorXd TetrahedronDeterminants(const Points& nodes, const Tetrahedra& tetrahedra)
{
  Eigen::VectorXd determinants(tetrahedra.rows());
  for (Eigen::Index t = 0; t < tetrahedra.rows(); ++t)
  {
    const Eigen::RowVector3d origin = nodes.row(tetrahedra(t, 0));
    const Eigen::RowVector3d a = nodes.row(tetrahedra(t, 1)) - origin;
    const Eigen::RowVector3d b = nodes.row(tetrahedra(t, 2)) - origin;
    const Eigen::RowVector3d c = nodes.row(tetrahedra(t, 3)) - origin;
    determinants[t] = a.cross(b).dot(c);
  }
  return determinants;
}

IdSample InvertedTetrahedra(const Points& rest, const Points& current, const Tetrahedra& tetrahedra)
{
  const Eigen::VectorXd before = TetrahedronDeterminants(rest, tetrahedra);
  const Eigen::VectorXd after = TetrahedronDeterminants(current, tetrahedra);
  IdSample inverted;
  for (Eigen::Index t = 0; t < tetrahedra.rows(); ++t)
  {
    double longest = 0.0;
    for (const auto& [a, b] : EdgesOfTetrahedron)
    {
      longest = std::max(longest, (rest.row(tetrahedra(t, a)) - rest.row(tetrahedra(t, b))).norm());
    }
    const bool isFlat = std::abs(before[t]) <= 1e-9 * longest * longest * longest;
    if (!isFlat && !(before[t] * after[t] > 0.0))
    {
      inverted.Add(t);
    }
  }
  return inverted;
}
}
