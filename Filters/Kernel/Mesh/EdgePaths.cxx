// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/EdgePaths.h"

#include "Mesh/Geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_map>
#include <utility>

namespace cartan
{
namespace
{
/// Marks borders, and edges whose left and right area vectors `cuts` says yes to.
template <typename Cuts>
EdgeMask MarkEdges(const TriangleMesh& mesh, const Points& points, const Cuts& cuts)
{
  const Points areas = TriangleAreaVectors(points, mesh.GetTriangles());
  EdgeMask mask(mesh.NumberOfDirectedEdges(), 0);
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    const int left = mesh.LeftTriangle(d);
    const int right = mesh.LeftTriangle(mesh.Twin(d));
    mask[d] = left < 0 || right < 0 ||
      cuts(Eigen::Vector3d(areas.row(left)), Eigen::Vector3d(areas.row(right)));
  }
  return mask;
}

[[noreturn]] void RefuseChain(std::size_t count, const IdSample& branches, bool isClosed)
{
  const std::string where =
    branches.IsEmpty() ? "" : ": it branches at " + branches.Describe("point", "points");
  throw Error(ErrorCode::BadInput,
    "The " + std::to_string(count) + " selected points are not one " +
      (isClosed ? "ring" : "line") + " of edges" + where +
      (isClosed ? ". Select the points of one ring, turn ClosedCurve off, or set Source to the "
                  "shortest path between three points of it or more in their order."
                : ". Select the points of one line, or set Source to the shortest path between "
                  "points of it in their order."));
}
}

EdgeMask FeatureEdges(const TriangleMesh& mesh, const Points& points, double angle)
{
  return MarkEdges(mesh, points,
    [angle](const Eigen::Vector3d& left, const Eigen::Vector3d& right)
    { return std::atan2(left.cross(right).norm(), left.dot(right)) > angle; });
}

EdgeMask SilhouetteEdges(
  const TriangleMesh& mesh, const Points& points, const Eigen::Vector3d& direction)
{
  return MarkEdges(mesh, points,
    [&direction](const Eigen::Vector3d& left, const Eigen::Vector3d& right)
    { return (left.dot(direction) > 0.0) != (right.dot(direction) > 0.0); });
}

std::vector<int> ShortestEdgePath(
  const TriangleMesh& mesh, const Points& points, int from, int to, const EdgeMask& allowed)
{
  std::vector<double> lengths(mesh.NumberOfVertices(), std::numeric_limits<double>::infinity());
  std::vector<int> before(mesh.NumberOfVertices(), -1);
  std::set<std::pair<double, int>> front = { { 0.0, from } };
  lengths[from] = 0.0;
  while (!front.empty() && front.begin()->second != to)
  {
    const int v = front.begin()->second;
    front.erase(front.begin());
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      const int w = mesh.Neighbor(d);
      const double length = lengths[v] + (points.row(w) - points.row(v)).norm();
      if ((allowed.empty() || allowed[d]) && length < lengths[w])
      {
        front.erase({ lengths[w], w });
        front.emplace(length, w);
        lengths[w] = length;
        before[w] = v;
      }
    }
  }
  std::vector<int> path;
  for (int v = std::isfinite(lengths[to]) ? to : -1; v >= 0; v = before[v])
  {
    path.push_back(v);
  }
  std::reverse(path.begin(), path.end());
  return path;
}

int NearestOnEdges(
  const TriangleMesh& mesh, const Points& points, int vertex, const EdgeMask& allowed)
{
  int nearest = -1;
  double shortest = std::numeric_limits<double>::infinity();
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    const int v = mesh.Origin(d);
    const double distance = (points.row(v) - points.row(vertex)).norm();
    if (allowed[d] && mesh.Component(v) == mesh.Component(vertex) && distance < shortest)
    {
      nearest = v;
      shortest = distance;
    }
  }
  return nearest;
}

void RefusePath(int from, int to)
{
  throw Error(ErrorCode::BadInput,
    "There is no path along the edges of Source from point " + std::to_string(from) + " to point " +
      std::to_string(to) +
      ": choose two points of one such line, another FeatureAngle or ViewDirection, or set "
      "Source to the shortest path.");
}

void RequireSimplePath(const std::vector<int>& path, bool isClosed)
{
  std::vector<int> sorted = path;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end())
  {
    throw Error(ErrorCode::BadInput,
      "The source curve passes point " + std::to_string(*twice) +
        (isClosed ? " twice: choose PointIds in the order of a curve that does not cross itself, "
                    "three or more around it."
                  : " twice: choose PointIds in the order of a curve that does not cross itself."));
  }
}

std::vector<int> PathThrough(const TriangleMesh& mesh, const Points& points,
  const std::vector<int>& picks, const EdgeMask& allowed, bool isClosed)
{
  const auto place = [&](int v)
  { return allowed.empty() ? v : NearestOnEdges(mesh, points, v, allowed); };
  std::vector<int> path;
  for (std::size_t i = 0; i + (isClosed ? 0 : 1) < picks.size(); ++i)
  {
    const int next = picks[(i + 1) % picks.size()];
    const int from = place(picks[i]);
    const int to = place(next);
    const std::vector<int> part =
      from < 0 || to < 0 ? std::vector<int>() : ShortestEdgePath(mesh, points, from, to, allowed);
    if (part.size() < 2)
    {
      RefusePath(picks[i], next);
    }
    path.insert(path.end(), part.begin() + (path.empty() ? 0 : 1), part.end());
  }
  if (isClosed)
  {
    path.pop_back(); // the first again
  }
  RequireSimplePath(path, isClosed);
  return path;
}

std::vector<int> RingThrough(
  const TriangleMesh& mesh, const Points& points, int pick, const EdgeMask& allowed)
{
  const int start = NearestOnEdges(mesh, points, pick, allowed);
  std::vector<int> ring;
  double shortest = std::numeric_limits<double>::infinity();
  for (int d = start < 0 ? 0 : mesh.RingBegin(start); start >= 0 && d < mesh.RingEnd(start); ++d)
  {
    if (!allowed[d])
    {
      continue;
    }
    // The way back without the edge.
    EdgeMask others = allowed;
    others[d] = others[mesh.Twin(d)] = 0;
    const std::vector<int> back = ShortestEdgePath(mesh, points, mesh.Neighbor(d), start, others);
    double length = (points.row(mesh.Neighbor(d)) - points.row(start)).norm();
    for (std::size_t i = 0; i + 1 < back.size(); ++i)
    {
      length += (points.row(back[i + 1]) - points.row(back[i])).norm();
    }
    if (!back.empty() && length < shortest)
    {
      shortest = length;
      ring.assign(1, start);
      ring.insert(ring.end(), back.begin(), back.end() - 1);
    }
  }
  if (ring.empty())
  {
    throw Error(ErrorCode::BadInput,
      "No ring of the edges of Source passes near point " + std::to_string(pick) +
        ": choose another point, FeatureAngle or ViewDirection, or three PointIds or more around "
        "the ring.");
  }
  return ring;
}

namespace
{
/// Vertices in the order in which they are named, each once.
class ChainedVertices
{
public:
  explicit ChainedVertices(const std::vector<int>& vertices)
  {
    for (const int v : vertices)
    {
      if (this->Places.emplace(v, this->Places.size()).second)
      {
        this->Vertices.push_back(v);
      }
    }
  }

  const std::vector<int>& GetVertices() const { return this->Vertices; }

  /// Those of them that an edge joins with v, the one that is named first before others: their
  /// ids decide nothing.
  std::vector<int> NeighborsOf(const TriangleMesh& mesh, int v) const
  {
    std::vector<int> found;
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      if (this->Places.count(mesh.Neighbor(d)) > 0)
      {
        found.push_back(mesh.Neighbor(d));
      }
    }
    std::sort(found.begin(), found.end(),
      [this](int a, int b) { return this->Places.at(a) < this->Places.at(b); });
    return found;
  }

private:
  std::vector<int> Vertices;
  std::unordered_map<int, std::size_t> Places;
};
}

std::vector<int> ChainVertices(
  const TriangleMesh& mesh, const std::vector<int>& vertices, bool isClosed)
{
  const ChainedVertices named(vertices);
  IdSample branches;
  int first = -1;
  bool hasEnds = false;
  for (const int v : named.GetVertices())
  {
    const std::size_t count = named.NeighborsOf(mesh, v).size();
    hasEnds = hasEnds || count < 2;
    if (count > 2)
    {
      branches.Add(v);
    }
    first = first < 0 && count == 1 ? v : first;
  }
  if (isClosed)
  {
    first = hasEnds || vertices.empty() ? -1 : vertices.front();
  }
  std::vector<int> chain;
  int before = -1;
  for (int v = branches.IsEmpty() ? first : -1; v >= 0;)
  {
    chain.push_back(v);
    const std::vector<int> neighbors = named.NeighborsOf(mesh, v);
    const auto next =
      std::find_if(neighbors.begin(), neighbors.end(), [before](int w) { return w != before; });
    before = v;
    v = next == neighbors.end() || (isClosed && *next == first) ? -1 : *next;
  }
  if (chain.size() < 2 || chain.size() < named.GetVertices().size())
  {
    RefuseChain(named.GetVertices().size(), branches, isClosed);
  }
  return chain;
}
}
