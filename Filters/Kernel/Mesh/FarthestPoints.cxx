// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/FarthestPoints.h"

#include "Mesh/GeodesicDistance.h"
#include "Mesh/UsedVertices.h"

#include <algorithm>

namespace cartan
{
std::vector<int> FarthestPoints(
  const TriangleMesh& mesh, const Points& points, int count, const ExecutionContext& context)
{
  constexpr double Infinity = std::numeric_limits<double>::infinity();
  Eigen::VectorXd distances(mesh.NumberOfVertices());
  Eigen::RowVector3d center = Eigen::RowVector3d::Zero();
  const std::vector<int> used = UsedVertices(mesh);
  const auto numberOfUsed = static_cast<int>(used.size());
  for (const int v : used)
  {
    center += points.row(v);
  }
  center /= std::max(1, numberOfUsed);
  const auto farthest = [&]
  {
    // Where there is no path yet, the distance from the center decides.
    Eigen::Index best = -1;
    const auto key = [&](Eigen::Index v)
    {
      return std::make_pair(
        distances[v], distances[v] == Infinity ? (points.row(v) - center).norm() : 0.0);
    };
    for (Eigen::Index v = 0; v < distances.size(); ++v)
    {
      if (mesh.IsUsed(static_cast<int>(v)) && (best < 0 || key(v) > key(best)))
      {
        best = v;
      }
    }
    return static_cast<int>(best);
  };
  distances.setConstant(Infinity);
  std::vector<int> chosen;
  while (static_cast<int>(chosen.size()) < std::min(count, numberOfUsed))
  {
    const int next = farthest();
    if (!(distances[next] > 0.0))
    {
      break;
    }
    chosen.push_back(next);
    // Nothing beyond the largest distance so far can come nearer.
    distances = distances.cwiseMin(GeodesicDistance(mesh, points, { next }, distances[next]));
    context.Report(static_cast<double>(chosen.size()) / count);
  }
  return chosen;
}
}
