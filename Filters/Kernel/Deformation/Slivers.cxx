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

/// Tells at which vertices there can be slivers at all, one look at each triangle: on a
/// surface without any, that is all that finding them costs.
class Suspects
{
public:
  Suspects(const TriangleMesh& mesh, const Points& points)
    : Longest(mesh.NumberOfVertices(), 0.0)
    , Shortest(mesh.NumberOfVertices(), std::numeric_limits<double>::infinity())
    , IsMarked(mesh.NumberOfVertices(), 0)
  {
    const Triangles& triangles = mesh.GetTriangles();
    for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    {
      this->Look(points, triangles.data() + 3 * t);
    }
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      // An edge's other end may be the one with the long edge: that is marked then,
      // and so is this, by what it shares with it.
      if (this->Shortest[v] < Generous * TinyEdge * TinyEdge * this->Longest[v])
      {
        this->IsMarked[v] = 1;
        for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
        {
          this->IsMarked[mesh.Neighbor(d)] = 1;
        }
      }
    }
  }

  bool IsSuspect(int v) const { return this->IsMarked[v]; }

  /// The squared length of the longest edge at a vertex.
  double LongestSquared(int v) const { return this->Longest[v]; }

private:
  /// Rounding of what the exact tests compute otherwise.
  static constexpr double Generous = 1.0 + 1e-9;

  void Look(const Points& points, const int* corners)
  {
    const Eigen::Vector3d a = points.row(corners[0]);
    const Eigen::Vector3d b = points.row(corners[1]);
    const Eigen::Vector3d c = points.row(corners[2]);
    const Eigen::Vector3d ab = b - a;
    const Eigen::Vector3d ac = c - a;
    const double squared[3] = { ab.squaredNorm(), (c - b).squaredNorm(), ac.squaredNorm() };
    for (int i = 0; i < 3; ++i)
    {
      for (const int v : { corners[i], corners[(i + 1) % 3] })
      {
        this->Longest[v] = std::max(this->Longest[v], squared[i]);
        this->Shortest[v] = std::min(this->Shortest[v], squared[i]);
      }
    }
    const double longest = std::max({ squared[0], squared[1], squared[2] });
    const double shortest = std::min({ squared[0], squared[1], squared[2] });
    if (ab.cross(ac).squaredNorm() < Generous * LargestCap * LargestCap * longest * longest ||
      shortest < Generous * ShortEdge * ShortEdge * longest)
    {
      this->IsMarked[corners[0]] = this->IsMarked[corners[1]] = this->IsMarked[corners[2]] = 1;
    }
  }

  std::vector<double> Longest;  // #V
  std::vector<double> Shortest; // #V
  std::vector<char> IsMarked;   // #V
};

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

bool IsShort(const TriangleMesh& mesh, const Points& points, const Suspects& suspects, int v, int d)
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
    squared <
    TinyEdge * TinyEdge * std::max(suspects.LongestSquared(v), suspects.LongestSquared(w));
}
}

std::vector<Sliver> FindSlivers(const TriangleMesh& mesh, const Points& points)
{
  const Suspects suspects(mesh, points);
  std::vector<Sliver> slivers;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v) && suspects.IsSuspect(v); ++d)
    {
      const int w = mesh.Neighbor(d);
      if (IsCap(mesh, points, v, d))
      {
        const int other = mesh.Neighbor(mesh.NextAround(v, d));
        slivers.push_back({ true, (points.row(other) - points.row(w)).squaredNorm(), v, d });
      }
      else if (v < w && IsShort(mesh, points, suspects, v, d))
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
