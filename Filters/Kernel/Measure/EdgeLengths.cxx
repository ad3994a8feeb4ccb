// SPDX-License-Identifier: BSD-3-Clause
#include "Measure/EdgeLengths.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cartan
{
namespace
{
constexpr double Undefined = std::numeric_limits<double>::quiet_NaN();

/// What all edges together have: of their `ratios` (#D).
void Summarize(const TriangleMesh& mesh, const Eigen::VectorXd& ratios,
  const DistributedRows* pieces, EdgeLengthChange& change)
{
  // Of a piece the owner of the end with the lower name counts an edge.
  const auto isCounted = [&](int v, int w)
  { return pieces ? pieces->IsOwned(v) && pieces->GetName(v) < pieces->GetName(w) : v <= w; };
  Eigen::Vector2d sums = Eigen::Vector2d::Zero(); // of squares, and the count
  std::vector<std::int64_t> ofNoLength;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      if (!isCounted(v, mesh.Neighbor(d)))
      {
        continue;
      }
      if (std::isnan(ratios[d]))
      {
        ofNoLength.push_back(pieces ? pieces->GetName(v) : v);
        continue;
      }
      const double relative = ratios[d] - 1.0;
      sums += Eigen::Vector2d(relative * relative, 1.0);
      change.Maximum = std::max(change.Maximum, std::abs(relative));
    }
  }
  if (pieces)
  {
    Eigen::VectorXd ofAll = sums;
    pieces->Sum(ofAll);
    sums = ofAll;
    Eigen::VectorXd most = Eigen::VectorXd::Constant(1, change.Maximum);
    pieces->Max(most);
    change.Maximum = most[0];
    ofNoLength = pieces->Gather(ofNoLength);
    std::sort(ofNoLength.begin(), ofNoLength.end());
  }
  for (const std::int64_t id : ofNoLength)
  {
    change.ZeroLength.Add(id);
  }
  change.RootMeanSquare = sums[1] > 0.0 ? std::sqrt(sums[0] / sums[1]) : 0.0;
}
}

EdgeLengthChange CompareEdgeLengths(const TriangleMesh& mesh, const Points& reference,
  const Points& current, const ExecutionContext& context, const DistributedRows* pieces)
{
  EdgeLengthChange change;
  change.VertexRatio = Eigen::VectorXd::Ones(mesh.NumberOfVertices());
  Eigen::VectorXd ratios(mesh.NumberOfDirectedEdges());
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        double sum = 0.0;
        int count = 0;
        for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
        {
          const int w = mesh.Neighbor(d);
          const double before = (reference.row(w) - reference.row(v)).norm();
          const double after = (current.row(w) - current.row(v)).norm();
          ratios[d] = before > 0.0 ? after / before : Undefined;
          if (before > 0.0)
          {
            sum += ratios[d];
            ++count;
          }
        }
        if (mesh.IsUsed(v))
        {
          change.VertexRatio[v] = count > 0 ? sum / count : Undefined;
        }
      }
    });
  Summarize(mesh, ratios, pieces, change);
  return change;
}
}
