// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/GeodesicPath.h"

#include "Mesh/EdgePaths.h"
#include "Mesh/GeodesicDistance.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
/// Nearer to an end of an edge than this part of it is at the end.
constexpr double EndPart = 1e-9;

/// How often the points between are straightened, one after the other.
constexpr int Straightenings = 50;

/// A point in the plane beside an edge: along it from its first end, and off it.
struct BesideEdge
{
  double Along;
  double Off;
};

BesideEdge Beside(
  const Eigen::RowVector3d& x, const Eigen::RowVector3d& a, const Eigen::RowVector3d& b)
{
  const Eigen::RowVector3d edge = (b - a).normalized();
  const double along = (x - a).dot(edge);
  return { along, (x - a - along * edge).norm() };
}

/// Where the straight line between two points on both sides of an edge crosses it, as a part.
double Crossing(const BesideEdge& x, const BesideEdge& y, double length)
{
  const double off = x.Off + y.Off;
  const double along =
    off > 0.0 ? (x.Along * y.Off + y.Along * x.Off) / off : 0.5 * (x.Along + y.Along);
  const double part = along / length;
  return part < EndPart ? 0.0 : part > 1.0 - EndPart ? 1.0 : part;
}

double LengthOf(const std::vector<EdgePoint>& path, const Points& points)
{
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i)
  {
    length += (path[i].In(points) - path[i - 1].In(points)).norm();
  }
  return length;
}

EdgePoint AtVertex(int v)
{
  return { v, v, 0.0 };
}

/// The descent from one vertex to where the distance is 0.
class Descent
{
public:
  Descent(const TriangleMesh& mesh, const Points& points, const Eigen::VectorXd& distances, int to)
    : Mesh(mesh)
    , Positions(points)
    , Distances(distances)
    , End(to)
  {
  }

  /// From a vertex or an edge, across the triangles there; false where none leads on.
  bool Step(std::vector<EdgePoint>& path)
  {
    const EdgePoint at = path.back();
    this->Best = std::numeric_limits<double>::infinity();
    if (at.IsVertex())
    {
      for (int d = this->Mesh.RingBegin(at.From); d < this->Mesh.RingEnd(at.From); ++d)
      {
        this->Offer(at, AtVertex(this->Mesh.Neighbor(d)));
        if (this->Mesh.LeftTriangle(d) >= 0)
        {
          this->Cross(at, this->Mesh.Neighbor(d), this->Mesh.Opposite(d));
        }
      }
    }
    else
    {
      // Its left is the triangle that the path comes from.
      const int apex = this->Mesh.Opposite(this->Mesh.Twin(this->Edge));
      if (apex >= 0)
      {
        this->Cross(at, at.From, apex);
        this->Cross(at, apex, at.To);
        this->Offer(at, AtVertex(apex));
      }
      this->Offer(at, AtVertex(at.From));
      this->Offer(at, AtVertex(at.To));
    }
    if (!std::isfinite(this->Best))
    {
      return false;
    }
    path.push_back(this->Next);
    this->Edge = this->NextEdge;
    return true;
  }

private:
  void Offer(const EdgePoint& at, const EdgePoint& next)
  {
    const double length =
      (next.In(this->Positions) - at.In(this->Positions)).norm() + this->Distances[next.From];
    if (length < this->Best)
    {
      this->Best = length;
      this->Next = next;
    }
  }

  /// To the edge from a to b, beyond which the end is where its distances say.
  void Cross(const EdgePoint& at, int a, int b)
  {
    const double length = (this->Positions.row(b) - this->Positions.row(a)).norm();
    const double fromA = this->Distances[a];
    const double fromB = this->Distances[b];
    if (!(length > 0.0) || !std::isfinite(fromA) || !std::isfinite(fromB) || a == this->End ||
      b == this->End)
    {
      return;
    }
    const BesideEdge here =
      Beside(at.In(this->Positions), this->Positions.row(a), this->Positions.row(b));
    BesideEdge end;
    end.Along = 0.5 * ((fromA * fromA - fromB * fromB) / length + length);
    end.Off = std::sqrt(std::max(0.0, fromA * fromA - end.Along * end.Along));
    const double part = Crossing(here, end, length);
    if (part == 0.0 || part == 1.0)
    {
      return; // offered as a vertex
    }
    const double way = std::hypot(here.Along - part * length, here.Off) +
      std::hypot(end.Along - part * length, end.Off);
    if (way < this->Best)
    {
      this->Best = way;
      this->Next = { a, b, part };
      this->NextEdge = this->EdgeOf(a, b);
    }
  }

  int EdgeOf(int a, int b) const
  {
    int d = this->Mesh.RingBegin(a);
    while (this->Mesh.Neighbor(d) != b)
    {
      ++d;
    }
    return d;
  }

  const TriangleMesh& Mesh;
  const Points& Positions;
  const Eigen::VectorXd& Distances;
  int End;
  double Best = 0.0;
  EdgePoint Next = { 0, 0, 0.0 };
  int NextEdge = 0;
  int Edge = 0; // that the path is on, directed as its point
};

/// Each point between its neighbors, which lie in the triangles beside its edge.
void Straighten(std::vector<EdgePoint>& path, const Points& points)
{
  for (int round = 0; round < Straightenings; ++round)
  {
    for (std::size_t i = 1; i + 1 < path.size(); ++i)
    {
      EdgePoint& at = path[i];
      if (!at.IsVertex())
      {
        const Eigen::RowVector3d a = points.row(at.From);
        const Eigen::RowVector3d b = points.row(at.To);
        at.Part = Crossing(Beside(path[i - 1].In(points), a, b),
          Beside(path[i + 1].In(points), a, b), (b - a).norm());
      }
    }
  }
}

/// Without what is between two occurrences of a vertex, of which the nearer place is kept.
CurveAcross WithoutLoops(const CurveAcross& curve, const Points& points)
{
  const auto distance = [&](int k)
  { return (curve.Places.row(k) - points.row(curve.Vertices[k])).norm(); };
  std::vector<int> kept;
  for (int k = 0; k < static_cast<int>(curve.Vertices.size()); ++k)
  {
    const auto before = std::find_if(kept.begin(), kept.end(),
      [&](int earlier) { return curve.Vertices[earlier] == curve.Vertices[k]; });
    const int nearer = before != kept.end() && distance(*before) <= distance(k) ? *before : k;
    kept.erase(before, kept.end());
    kept.push_back(nearer);
  }
  CurveAcross simple;
  simple.Places.resize(static_cast<Eigen::Index>(kept.size()), 3);
  for (const int k : kept)
  {
    simple.Places.row(static_cast<Eigen::Index>(simple.Vertices.size())) = curve.Places.row(k);
    simple.Vertices.push_back(curve.Vertices[k]);
  }
  return simple;
}

/// The nearer ends of the edges that a path crosses, and where it is nearest to each.
CurveAcross BesidePath(const std::vector<EdgePoint>& path, const Points& points)
{
  CurveAcross curve;
  curve.Places.resize(static_cast<Eigen::Index>(path.size()), 3);
  for (const EdgePoint& at : path)
  {
    const int v = at.Part < 0.5 ? at.From : at.To;
    const Eigen::RowVector3d place = at.In(points);
    const auto last = static_cast<Eigen::Index>(curve.Vertices.size()) - 1;
    if (last < 0 || curve.Vertices.back() != v)
    {
      curve.Vertices.push_back(v);
      curve.Places.row(last + 1) = place;
    }
    else if ((place - points.row(v)).norm() < (curve.Places.row(last) - points.row(v)).norm())
    {
      curve.Places.row(last) = place;
    }
  }
  curve.Places.conservativeResize(static_cast<Eigen::Index>(curve.Vertices.size()), 3);
  return WithoutLoops(curve, points);
}
}

std::vector<EdgePoint> GeodesicPath(
  const TriangleMesh& mesh, const Points& points, int from, int to)
{
  std::vector<EdgePoint> alongEdges;
  for (const int v : ShortestEdgePath(mesh, points, from, to))
  {
    alongEdges.push_back(AtVertex(v));
  }
  const double longest = LengthOf(alongEdges, points);
  if (alongEdges.size() < 3)
  {
    return alongEdges;
  }
  const Eigen::VectorXd distances =
    GeodesicDistance(mesh, points, { to }, (1.0 + EndPart) * longest);
  Descent descent(mesh, points, distances, to);
  std::vector<EdgePoint> path = { AtVertex(from) };
  const auto isEnd = [&] { return path.back().IsVertex() && path.back().From == to; };
  // A path that descends crosses no edge twice.
  while (
    !isEnd() && path.size() < static_cast<std::size_t>(mesh.NumberOfEdges()) && descent.Step(path))
  {
  }
  if (!isEnd())
  {
    return alongEdges;
  }
  Straighten(path, points);
  return LengthOf(path, points) <= longest ? path : alongEdges;
}

CurveAcross GeodesicThrough(
  const TriangleMesh& mesh, const Points& points, const std::vector<int>& picks, bool isClosed)
{
  CurveAcross curve;
  for (std::size_t i = 0; i + (isClosed ? 0 : 1) < picks.size(); ++i)
  {
    const int next = picks[(i + 1) % picks.size()];
    const CurveAcross part = BesidePath(GeodesicPath(mesh, points, picks[i], next), points);
    if (part.Vertices.size() < 2)
    {
      RefusePath(picks[i], next);
    }
    const auto skipped = curve.Vertices.empty() ? 0 : 1;
    const Eigen::Index before = curve.Places.rows();
    curve.Vertices.insert(
      curve.Vertices.end(), part.Vertices.begin() + skipped, part.Vertices.end());
    curve.Places.conservativeResize(static_cast<Eigen::Index>(curve.Vertices.size()), 3);
    curve.Places.bottomRows(curve.Places.rows() - before) =
      part.Places.bottomRows(part.Places.rows() - skipped);
  }
  if (isClosed)
  {
    curve.Vertices.pop_back(); // the first again
    curve.Places.conservativeResize(static_cast<Eigen::Index>(curve.Vertices.size()), 3);
  }
  RequireSimplePath(curve.Vertices, isClosed);
  return curve;
}

Eigen::VectorXd DistanceFromCurve(const TriangleMesh& mesh, const Points& points,
  const CurveAcross& curve, bool isClosed, double limit)
{
  double beside = 0.0;
  const Eigen::Index count = curve.Places.rows();
  for (Eigen::Index i = 0; i < count; ++i)
  {
    beside = std::max(beside, (points.row(curve.Vertices[i]) - curve.Places.row(i)).norm());
  }
  Eigen::VectorXd distances = GeodesicDistance(mesh, points, curve.Vertices, limit + beside);
  for (Eigen::Index v = 0; beside > 0.0 && v < distances.size(); ++v)
  {
    if (!std::isfinite(distances[v]))
    {
      continue;
    }
    double straight = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i + (isClosed ? 0 : 1) < count; ++i)
    {
      const Eigen::RowVector3d edge = curve.Places.row((i + 1) % count) - curve.Places.row(i);
      const Eigen::RowVector3d way = points.row(v) - curve.Places.row(i);
      const double t = edge.isZero(0.0) ? 0.0 : way.dot(edge) / edge.squaredNorm();
      straight = std::min(straight, (way - std::min(std::max(t, 0.0), 1.0) * edge).squaredNorm());
    }
    distances[v] = std::max(distances[v] - beside, std::sqrt(straight));
  }
  return distances;
}
}
