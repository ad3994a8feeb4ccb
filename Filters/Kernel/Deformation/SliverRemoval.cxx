// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/SliverRemoval.h"

#include "Mesh/EdgeFlips.h"
#include "Mesh/TriangleShape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

/// Of twice the area in parts of the longest edge squared: what can carry a rider.
constexpr double SmallestCarrier = 1e-2;

/// How far triangles may turn when a vertex of theirs moves by a short edge.
const double LeastCosine = 0.5;

/// What flips may do; see WithoutSlivers.
constexpr FlipOptions Flips{ 0.5236, 1e-2 };

double RelativeHeight(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
{
  return (b - a).cross(c - a).norm() / LongestEdgeSquared(a, b, c);
}

double CosineOfNormals(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
  const Eigen::Vector3d& moved, const Eigen::Vector3d& apex)
{
  const Eigen::Vector3d before = (b - apex).cross(a - apex);
  const Eigen::Vector3d after = (b - moved).cross(a - moved);
  const double product = before.norm() * after.norm();
  return product > 0.0 ? before.dot(after) / product : 1.0;
}

/// Takes slivers out of a mesh, pass by pass. A pass leaves alone what touches a
/// change that it has made already.
class SliverRemoval
{
public:
  explicit SliverRemoval(const HandleProblem& problem)
    : Mesh(problem.Mesh)
    , Rest(*problem.Rest)
    , Handle(problem.Handle)
    , IsFirst(Mesh->NumberOfComponents() > 0 ? problem.Handle.size() : 0, 0)
  {
    std::vector<char> isSeen(this->Mesh->NumberOfComponents(), 0);
    for (int v = 0; v < this->Mesh->NumberOfVertices(); ++v)
    {
      const int component = this->Mesh->Component(v);
      if (component >= 0 && !isSeen[component])
      {
        isSeen[component] = 1;
        this->IsFirst[v] = 1;
      }
    }
  }

  /// Whether something has changed.
  bool Pass()
  {
    const int count = this->Mesh->NumberOfVertices();
    this->IsLocked.assign(count, 0);
    this->Changed = this->Mesh->GetTriangles();
    this->HasChanged = false;
    this->MeasureRings();
    for (int v = 0; v < count; ++v)
    {
      for (int d = this->Mesh->RingBegin(v); d < this->Mesh->RingEnd(v); ++d)
      {
        if (this->IsCap(v, d))
        {
          this->TakeOutCap(v, d);
        }
        else if (v < this->Mesh->Neighbor(d) && this->IsShort(v, d))
        {
          this->Collapse(v, d);
        }
      }
    }
    if (this->HasChanged)
    {
      this->Rebuild();
    }
    return this->HasChanged;
  }

  const std::shared_ptr<const TriangleMesh>& GetMesh() const { return this->Mesh; }
  std::vector<Rider> TakeRiders() { return std::move(this->Riders); }

private:
  Eigen::Vector3d At(int v) const { return this->Rest.row(v); }

  void MeasureRings()
  {
    this->LongestAt.assign(this->Mesh->NumberOfVertices(), 0.0);
    for (int v = 0; v < this->Mesh->NumberOfVertices(); ++v)
    {
      for (int d = this->Mesh->RingBegin(v); d < this->Mesh->RingEnd(v); ++d)
      {
        this->LongestAt[v] = std::max(
          this->LongestAt[v], (this->At(this->Mesh->Neighbor(d)) - this->At(v)).squaredNorm());
      }
    }
  }

  /// The edge across from the origin of d in its left triangle, seen from outside
  /// of that: from the triangle's third vertex to its second.
  int Across(int d) const { return this->Mesh->Next(this->Mesh->Twin(this->Mesh->Next(d))); }

  /// Whether v is low over the edge across from it in the triangle on the left of d.
  bool IsCap(int v, int d) const
  {
    const int next = this->Mesh->NextAround(v, d);
    if (next < 0)
    {
      return false;
    }
    const Eigen::Vector3d apex = this->At(v);
    const Eigen::Vector3d a = this->At(this->Mesh->Neighbor(d));
    const Eigen::Vector3d b = this->At(this->Mesh->Neighbor(next));
    const double squared = (b - a).squaredNorm();
    const double along = (apex - a).dot(b - a);
    // Nearer to an end than it is high, it is a needle's.
    return (a - apex).cross(b - apex).squaredNorm() < LargestCap * LargestCap * squared * squared &&
      along > ShortEdge * squared && along < (1.0 - ShortEdge) * squared;
  }

  bool IsShort(int v, int d) const
  {
    const int w = this->Mesh->Neighbor(d);
    const double squared = (this->At(w) - this->At(v)).squaredNorm();
    double triangles = std::numeric_limits<double>::infinity();
    for (const int side : { d, this->Mesh->Twin(d) })
    {
      const int apex = this->Mesh->Opposite(side);
      if (apex >= 0)
      {
        triangles =
          std::min(triangles, LongestEdgeSquared(this->At(v), this->At(w), this->At(apex)));
      }
    }
    return squared < ShortEdge * ShortEdge * triangles ||
      squared < TinyEdge * TinyEdge * std::max(this->LongestAt[v], this->LongestAt[w]);
  }

  bool MayGo(int v) const { return this->Handle[v] == 0 && !this->IsFirst[v]; }

  bool IsRingLocked(int v) const
  {
    bool isLocked = this->IsLocked[v] != 0;
    for (int d = this->Mesh->RingBegin(v); d < this->Mesh->RingEnd(v); ++d)
    {
      isLocked = isLocked || this->IsLocked[this->Mesh->Neighbor(d)];
    }
    return isLocked;
  }

  void LockRing(int v)
  {
    this->IsLocked[v] = 1;
    for (int d = this->Mesh->RingBegin(v); d < this->Mesh->RingEnd(v); ++d)
    {
      this->IsLocked[this->Mesh->Neighbor(d)] = 1;
    }
    this->HasChanged = true;
  }

  bool AreNeighbors(int v, int w) const
  {
    for (int d = this->Mesh->RingBegin(v); d < this->Mesh->RingEnd(v); ++d)
    {
      if (this->Mesh->Neighbor(d) == w)
      {
        return true;
      }
    }
    return false;
  }

  void Remove(int triangle) { this->Changed.row(triangle).setConstant(-1); }

  void TakeOutCap(int v, int d)
  {
    const int across = this->Across(d);
    if (!this->IsRingLocked(v) && !this->RideInTriangle(v))
    {
      if (this->Mesh->LeftTriangle(across) < 0)
      {
        this->LeaveOut(v, d);
      }
      else
      {
        this->Flip(v, d, this->Mesh->Opposite(across));
      }
    }
  }

  /// The three triangles around v become one, which carries it.
  bool RideInTriangle(int v)
  {
    const int begin = this->Mesh->RingBegin(v);
    if (this->Mesh->Valence(v) != 3 || this->Mesh->IsBoundary(v) || !this->MayGo(v))
    {
      return false;
    }
    std::array<int, 3> corners;
    for (int i = 0; i < 3; ++i)
    {
      corners[i] = this->Mesh->Neighbor(begin + i);
      // Not the top of a tetrahedron.
      if (this->Mesh->Opposite(this->Across(begin + i)) ==
        this->Mesh->Neighbor(begin + (i + 2) % 3))
      {
        return false;
      }
    }
    if (!this->CanCarry(corners))
    {
      return false;
    }
    this->Riders.push_back(MakeRider(this->Rest, v, corners));
    this->Changed.row(this->Mesh->LeftTriangle(begin)) << corners[0], corners[1], corners[2];
    this->Remove(this->Mesh->LeftTriangle(begin + 1));
    this->Remove(this->Mesh->LeftTriangle(begin + 2));
    this->LockRing(v);
    return true;
  }

  /// A cap whose long edge is on the border: its other edges are the border then.
  void LeaveOut(int v, int d)
  {
    const int a = this->Mesh->Neighbor(d);
    const int b = this->Mesh->Neighbor(this->Mesh->NextAround(v, d));
    if (!this->Mesh->IsBoundary(v) && this->Mesh->Valence(a) > 2 && this->Mesh->Valence(b) > 2)
    {
      this->Remove(this->Mesh->LeftTriangle(d));
      this->LockRing(v);
    }
  }

  /// (v, a, b) and (b, a, apex) become (v, a, apex) and (apex, b, v).
  void Flip(int v, int d, int apex)
  {
    const int a = this->Mesh->Neighbor(d);
    const int b = this->Mesh->Neighbor(this->Mesh->NextAround(v, d));
    if (this->IsLocked[apex] || apex == v || this->AreNeighbors(v, apex) ||
      !FlipImproves(this->At(a), this->At(b), this->At(v), this->At(apex), Flips))
    {
      return;
    }
    this->Changed.row(this->Mesh->LeftTriangle(d)) << v, a, apex;
    this->Changed.row(this->Mesh->LeftTriangle(this->Across(d))) << apex, b, v;
    this->LockRing(v);
    this->IsLocked[apex] = 1;
  }

  /// Merges one end of d into the other, if the mesh stays a manifold of the same
  /// shape.
  void Collapse(int v, int d)
  {
    const int w = this->Mesh->Neighbor(d);
    if (this->IsRingLocked(v) || this->IsRingLocked(w))
    {
      return;
    }
    for (const auto& [goes, stays] : { std::pair(w, v), std::pair(v, w) })
    {
      if (this->CanMerge(goes, stays, d) && this->Merge(goes, stays))
      {
        return;
      }
    }
  }

  bool CanMerge(int goes, int stays, int edge) const
  {
    const int triangles = (this->Mesh->LeftTriangle(edge) >= 0) +
      (this->Mesh->LeftTriangle(this->Mesh->Twin(edge)) >= 0);
    if (!this->MayGo(goes) || (this->Mesh->IsBoundary(goes) && triangles == 2))
    {
      return false;
    }
    // Dey et al., Topology Preserving Edge Contraction, 1999: the link condition.
    int shared = 0;
    for (int d = this->Mesh->RingBegin(goes); d < this->Mesh->RingEnd(goes); ++d)
    {
      const int neighbor = this->Mesh->Neighbor(d);
      shared += neighbor != stays && this->AreNeighbors(neighbor, stays);
    }
    return shared == triangles;
  }

  /// The triangles around `goes` without `stays` hang on `stays` then, unless that
  /// turns one of them away. The best around both carries.
  bool Merge(int goes, int stays)
  {
    std::array<int, 3> best = { -1, -1, -1 };
    double bestHeight = SmallestCarrier;
    for (const int center : { goes, stays })
    {
      for (int d = this->Mesh->RingBegin(center); d < this->Mesh->RingEnd(center); ++d)
      {
        const int next = this->Mesh->NextAround(center, d);
        const int x = this->Mesh->Neighbor(d);
        const int y = next < 0 ? stays : this->Mesh->Neighbor(next);
        if (x == goes || x == stays || y == goes || y == stays || this->IsNear(goes, stays, x, y))
        {
          continue;
        }
        if (CosineOfNormals(this->At(x), this->At(y), this->At(stays), this->At(center)) <
          LeastCosine)
        {
          return false;
        }
        const double height = RelativeHeight(this->At(stays), this->At(x), this->At(y));
        if (height > bestHeight)
        {
          bestHeight = height;
          best = { stays, x, y };
        }
      }
    }
    if (best[0] < 0)
    {
      return false;
    }
    this->Riders.push_back(MakeRider(this->Rest, goes, best));
    this->LockRing(goes);
    this->LockRing(stays);
    this->Rename(goes, stays);
    return true;
  }

  /// Whether one of two vertices is about as near as those that are merged: a
  /// triangle with it is a sliver itself, and its normal says nothing.
  bool IsNear(int goes, int stays, int x, int y) const
  {
    const double merged = (this->At(goes) - this->At(stays)).squaredNorm();
    const double nearest = std::min(
      (this->At(x) - this->At(goes)).squaredNorm(), (this->At(y) - this->At(goes)).squaredNorm());
    return nearest < 100.0 * merged;
  }

  void Rename(int goes, int stays)
  {
    for (int d = this->Mesh->RingBegin(goes); d < this->Mesh->RingEnd(goes); ++d)
    {
      const int t = this->Mesh->LeftTriangle(d);
      if (t < 0)
      {
        continue;
      }
      if ((this->Changed.row(t).array() == stays).any())
      {
        this->Remove(t);
      }
      else
      {
        std::replace(this->Changed.row(t).begin(), this->Changed.row(t).end(), goes, stays);
      }
    }
  }

  bool CanCarry(const std::array<int, 3>& corners) const
  {
    return RelativeHeight(this->At(corners[0]), this->At(corners[1]), this->At(corners[2])) >
      SmallestCarrier;
  }

  void Rebuild()
  {
    Triangles left(this->Changed.rows(), 3);
    Eigen::Index count = 0;
    for (Eigen::Index t = 0; t < this->Changed.rows(); ++t)
    {
      if (this->Changed(t, 0) >= 0)
      {
        left.row(count++) = this->Changed.row(t);
      }
    }
    left.conservativeResize(count, 3);
    this->Mesh =
      std::make_shared<const TriangleMesh>(this->Mesh->NumberOfVertices(), std::move(left));
  }

  std::shared_ptr<const TriangleMesh> Mesh;
  const Points& Rest;
  const std::vector<int>& Handle;
  std::vector<char> IsFirst;     // of a component, which gives it its number
  std::vector<double> LongestAt; // squared length of the longest edge at a vertex
  std::vector<char> IsLocked;
  Triangles Changed; // -1 where one goes
  bool HasChanged = false;
  std::vector<Rider> Riders;
};
}

HandleProblem WithoutSlivers(HandleProblem problem, const ExecutionContext& context)
{
  SliverRemoval removal(problem);
  while (removal.Pass())
  {
    context.Report(0.5);
  }
  if (removal.GetMesh() != problem.Mesh)
  {
    problem.Whole = std::exchange(problem.Mesh, removal.GetMesh());
    problem.Riders = removal.TakeRiders();
  }
  return problem;
}
}
