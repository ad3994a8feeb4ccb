// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/HandleCurve.h"

#include "Deformation/JoinedVertices.h"

#include <unordered_map>

namespace cartan
{
namespace
{
/// The length that vertex v of a handle stands for.
double LengthAt(
  const TriangleMesh& mesh, const Points& points, const std::vector<int>& handle, int v)
{
  const auto isInside = [&](int d)
  { return mesh.LeftTriangle(d) >= 0 && handle[mesh.Opposite(d)] == handle[v]; };
  double curve = 0.0;
  double all = 0.0;
  bool hasNeighbor = false;
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    const double length = (points.row(mesh.Neighbor(d)) - points.row(v)).norm();
    all += length;
    if (handle[mesh.Neighbor(d)] == handle[v])
    {
      hasNeighbor = true;
      if (!isInside(d) || !isInside(mesh.Twin(d)))
      {
        curve += 0.5 * length;
      }
    }
  }
  return hasNeighbor ? curve : all / mesh.Valence(v);
}
}

Eigen::VectorXd HandleCurveShares(
  const TriangleMesh& mesh, const Points& points, const std::vector<int>& handle)
{
  struct Total
  {
    double Length = 0.0;
    int Count = 0;
  };
  std::unordered_map<int, Total> totals;
  Eigen::VectorXd shares = Eigen::VectorXd::Zero(mesh.NumberOfVertices());
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (handle[v] > 0 && mesh.IsUsed(v))
    {
      shares[v] = LengthAt(mesh, points, handle, v);
      Total& total = totals[handle[v]];
      total.Length += shares[v];
      ++total.Count;
    }
  }
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (handle[v] > 0 && mesh.IsUsed(v))
    {
      const Total& total = totals[handle[v]];
      shares[v] = total.Length > 0.0 ? shares[v] / total.Length : 1.0 / total.Count;
    }
  }
  return shares;
}

void ScaleSoftWeights(HandleProblem& problem)
{
  if (problem.SoftWeights.size() == 0)
  {
    return;
  }
  Eigen::VectorXd shares = HandleCurveShares(*problem.Mesh, *problem.Rest, problem.Handle);
  AddShares(problem.JoinedWith, shares);
  const Eigen::ArrayXd weights = problem.SoftWeights;
  problem.SoftWeights = weights.isInf().select(weights, weights * shares.array().sqrt());
}
}
