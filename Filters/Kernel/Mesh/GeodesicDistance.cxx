// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/GeodesicDistance.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

namespace cartan
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();

/// A path may miss an edge by this part of its length and still counts as
/// running through the end point. A layout's depth is the square root of a
/// difference, so its rounding error is that of 1e-16, and the value of a path
/// that misses by this much is off by its square.
constexpr double EndPointTolerance = 1e-7;

/// A settled vertex is settled again for an improvement by more than this part
/// of its value; less would spread rounding errors around over and over.
constexpr double WorthwhileImprovement = 1e-12;

/// Bounds the work where improvements chase each other around badly shaped
/// triangles. One round is the rule, two are common; among angles above 150
/// degrees some vertices take a hundred, and stopping at eight costs 10 % of
/// accuracy there.
constexpr unsigned char MaximumRounds = 250;

/// A value for a vertex and the source that its path comes from.
struct Candidate
{
  double Distance = Infinity;
  int Source = -1;
};

class Front
{
public:
  Front(const TriangleMesh& mesh, const Points& points, double limit)
    : Mesh(mesh)
    , Positions(points)
    , Limit(limit)
    , Distances(Eigen::VectorXd::Constant(mesh.NumberOfVertices(), Infinity))
    , Sources(mesh.NumberOfVertices(), -1)
    , Rounds(mesh.NumberOfVertices(), 0)
    , IsSettled(mesh.NumberOfVertices(), 0)
  {
  }

  void AddSource(int v)
  {
    this->Distances[v] = 0.0;
    this->Sources[v] = v;
    this->Queue.emplace(0.0, v);
  }

  Eigen::VectorXd March(const ExecutionContext& context)
  {
    int numberOfSteps = 0;
    // Vertices just beyond the limit can still improve those within it through
    // a triangle that they share.
    while (!this->Queue.empty() && this->Queue.top().first <= this->Limit + this->LongestEdge)
    {
      const auto [distance, v] = this->Queue.top();
      this->Queue.pop();
      if (this->IsSettled[v] || distance != this->Distances[v])
      {
        continue; // overtaken by a better entry
      }
      this->Settle(v);
      if (++numberOfSteps % 4096 == 0)
      {
        context.Report(std::min(1.0, static_cast<double>(numberOfSteps) / this->IsSettled.size()));
      }
    }
    for (double& distance : this->Distances)
    {
      distance = distance <= this->Limit ? distance : Infinity;
    }
    return std::move(this->Distances);
  }

private:
  double Length(int v, int w) const
  {
    return (this->Positions.row(v) - this->Positions.row(w)).norm();
  }

  void Settle(int v)
  {
    this->IsSettled[v] = 1;
    ++this->Rounds[v];
    for (int d = this->Mesh.RingBegin(v); d < this->Mesh.RingEnd(v); ++d)
    {
      const int w = this->Mesh.Neighbor(d);
      const double length = this->Length(v, w);
      this->LongestEdge = std::max(this->LongestEdge, length);
      this->Offer(w, { this->Distances[v] + length, this->Sources[v] });

      const int next = this->Mesh.NextAround(v, d);
      if (next >= 0)
      {
        const int u = this->Mesh.Neighbor(next);
        if (this->IsSettled[w])
        {
          this->Offer(u, this->ThroughTriangle(v, w, u));
        }
        if (this->IsSettled[u])
        {
          this->Offer(w, this->ThroughTriangle(v, u, w));
        }
      }
    }
  }

  void Offer(int v, const Candidate& candidate)
  {
    const double current = this->Distances[v];
    if (!(candidate.Distance < current))
    {
      return;
    }
    if (this->IsSettled[v])
    {
      if (candidate.Distance >= current * (1.0 - WorthwhileImprovement) ||
        this->Rounds[v] >= MaximumRounds)
      {
        return;
      }
      this->IsSettled[v] = 0;
    }
    this->Distances[v] = candidate.Distance;
    this->Sources[v] = candidate.Source;
    this->Queue.emplace(candidate.Distance, v);
  }

  /// The value at `v` of a path that enters the triangle (a, b, v) through the
  /// edge (a, b); infinite if the path through v does not cross that edge.
  ///
  /// The triangle is laid out with a at the origin, b at (l, 0) and v at
  /// (x, y), y >= 0; everything else follows from lengths.
  Candidate ThroughTriangle(int a, int b, int v) const
  {
    const double l = this->Length(a, b);
    if (l == 0.0)
    {
      return {};
    }
    const double av = this->Length(a, v);
    const double bv = this->Length(b, v);
    const double x = 0.5 * ((av - bv) * (av + bv) / l + l);
    const double y = std::sqrt(std::max(0.0, (av - x) * (av + x)));

    const bool hasOneSource = this->Sources[a] == this->Sources[b];
    const double distance =
      hasOneSource ? this->FromPoint(a, b, l, x, y) : this->FromLine(a, b, l, x, y);

    // No path is shorter than the straight line. This binds where a or b have
    // too large a value, which displaces the source in the layout.
    Candidate candidate;
    candidate.Source = this->Sources[a];
    double straight = this->Length(this->Sources[a], v);
    if (!hasOneSource)
    {
      const double fromOther = this->Length(this->Sources[b], v);
      if (fromOther < straight)
      {
        straight = fromOther;
        candidate.Source = this->Sources[b];
      }
    }
    candidate.Distance = std::max(distance, straight);
    return candidate;
  }

  /// Circular front: the source lies below the edge, at the distances of a and
  /// b from them.
  double FromPoint(int a, int b, double l, double x, double y) const
  {
    const double da = this->Distances[a];
    const double db = this->Distances[b];
    const double sourceX = 0.5 * ((da - db) * (da + db) / l + l);
    const double depth = std::sqrt(std::max(0.0, (da - sourceX) * (da + sourceX)));
    if (y + depth == 0.0)
    {
      return Infinity;
    }
    const double crossing = sourceX + (x - sourceX) * depth / (y + depth);
    return Crosses(crossing, l) ? std::hypot(x - sourceX, y + depth) : Infinity;
  }

  /// Straight front: the distance has a constant gradient of length 1 whose
  /// part along the edge is (d(b) - d(a)) / l.
  double FromLine(int a, int b, double l, double x, double y) const
  {
    const double alongEdge = (this->Distances[b] - this->Distances[a]) / l;
    if (std::abs(alongEdge) >= 1.0)
    {
      return Infinity;
    }
    const double acrossEdge = std::sqrt((1.0 - alongEdge) * (1.0 + alongEdge));
    const double crossing = x - y * alongEdge / acrossEdge;
    return Crosses(crossing, l) ? this->Distances[a] + alongEdge * x + acrossEdge * y : Infinity;
  }

  static bool Crosses(double crossing, double l)
  {
    return crossing >= -EndPointTolerance * l && crossing <= (1.0 + EndPointTolerance) * l;
  }

  using Entry = std::pair<double, int>;

  const TriangleMesh& Mesh;
  const Points& Positions;
  const double Limit;
  double LongestEdge = 0.0;
  Eigen::VectorXd Distances;
  std::vector<int> Sources; // the source that the path of each vertex ends at
  std::vector<unsigned char> Rounds;
  std::vector<unsigned char> IsSettled;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> Queue;
};
}

Eigen::VectorXd GeodesicDistance(const TriangleMesh& mesh, const Points& points,
  const std::vector<int>& sources, double limit, const ExecutionContext& context)
{
  if (!(limit >= 0.0))
  {
    throw Error(ErrorCode::BadInput,
      "The limit of a geodesic distance is " + std::to_string(limit) +
        "; it must be a number >= 0.");
  }
  IdSample missing;
  Front front(mesh, points, limit);
  for (const int v : sources)
  {
    if (v < 0 || v >= mesh.NumberOfVertices())
    {
      missing.Add(v);
    }
    else
    {
      front.AddSource(v);
    }
  }
  if (!missing.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The sources of a geodesic distance include " +
        missing.Describe("vertex that is", "vertices that are") + " not in the mesh of " +
        std::to_string(mesh.NumberOfVertices()) + " vertices.");
  }
  return front.March(context);
}
}
