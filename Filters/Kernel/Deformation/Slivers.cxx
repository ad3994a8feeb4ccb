// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/Slivers.h"

#include "Mesh/TriangleShape.h"

#include <algorithm>
#include <limits>

namespace cartan
{
namespace
{
/// A cap is lower than this part of its long edge. At this height the weights'
/// error is as large as the change that any point added to the mesh makes.
constexpr double LargestCap = 0.05;

/// A needle's short edge in parts of the longest of each of its triangles.
constexpr double ShortEdge = 1e-3;

/// The same in parts of the longest edge at either of its ends: what lies between
/// such vertices is smaller than what rounding leaves of a large system.
constexpr double TinyEdge = 1e-5;

/// The squared length of the longest edge at each vertex.
std::vector<double> LongestEdgesSquared(const TriangleMesh& mesh, const Points& points)
{
  std::vector<double> longest(mesh.NumberOfVertices(), 0.0);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      longest[v] =
        std::max(longest[v], (points.row(mesh.Neighbor(d)) - points.row(v)).squaredNorm());
    }
  }
  return longest;
}

/// Whether v is low over the edge across from it in the triangle on the left of d.
bool IsCap(const TriangleMesh& mesh, const Points& points, int v, int d)
{
  const int next = mesh.NextAround(v, d);
  if (next < 0)
  {
    return false;
  }
  const Eigen::Vector3d apex = points.row(v);
  const Eigen::Vector3d a = points.row(mesh.Neighbor(d));
  const Eigen::Vector3d b = points.row(mesh.Neighbor(next));
  const double squared = (b - a).squaredNorm();
  const double along = (apex - a).dot(b - a);
  // Nearer to an end than it is high, it is a needle's.
  return (a - apex).cross(b - apex).squaredNorm() < LargestCap * LargestCap * squared * squared &&
    along > ShortEdge * squared && along < (1.0 - ShortEdge) * squared;
}

bool IsShort(
  const TriangleMesh& mesh, const Points& points, const std::vector<double>& longest, int v, int d)
{
  const int w = mesh.Neighbor(d);
  const Eigen::Vector3d from = points.row(v);
  const Eigen::Vector3d to = points.row(w);
  double triangles = std::numeric_limits<double>::infinity();
  for (const int side : { d, mesh.Twin(d) })
  {
    const int apex = mesh.Opposite(side);
    if (apex >= 0)
    {
      triangles = std::min(triangles, LongestEdgeSquared(from, to, points.row(apex)));
    }
  }
  const double squared = (to - from).squaredNorm();
  return squared < ShortEdge * ShortEdge * triangles ||
    squared < TinyEdge * TinyEdge * std::max(longest[v], longest[w]);
}
}

std::vector<Sliver> FindSlivers(const TriangleMesh& mesh, const Points& points)
{
  const std::vector<double> longest = LongestEdgesSquared(mesh, points);
  std::vector<Sliver> slivers;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      const int w = mesh.Neighbor(d);
      if (IsCap(mesh, points, v, d))
      {
        const int other = mesh.Neighbor(mesh.NextAround(v, d));
        slivers.push_back({ true, (points.row(other) - points.row(w)).squaredNorm(), v, d });
      }
      else if (v < w && IsShort(mesh, points, longest, v, d))
      {
        slivers.push_back({ false, (points.row(w) - points.row(v)).squaredNorm(), v, d });
      }
    }
  }
  std::stable_sort(slivers.begin(), slivers.end(),
    [](const Sliver& a, const Sliver& b) { return a.Squared < b.Squared; });
  return slivers;
}
}
