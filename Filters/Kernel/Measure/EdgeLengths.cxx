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
}

EdgeLengthChange CompareEdgeLengths(const TriangleMesh& mesh, const Points& reference,
  const Points& current, const ExecutionContext& context)
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
  double squares = 0.0;
  int count = 0;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      if (v > mesh.Neighbor(d))
      {
        continue;
      }
      if (std::isnan(ratios[d]))
      {
        change.ZeroLength.Add(v);
        continue;
      }
      const double relative = ratios[d] - 1.0;
      squares += relative * relative;
      change.Maximum = std::max(change.Maximum, std::abs(relative));
      ++count;
    }
  }
  change.RootMeanSquare = count > 0 ? std::sqrt(squares / count) : 0.0;
  return change;
}
}
