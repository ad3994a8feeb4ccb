// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/SliverRemoval.h"

#include "Deformation/Carriers.h"
#include "Deformation/Slivers.h"
#include "Mesh/EdgeFlips.h"
#include "Mesh/TriangleShape.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace cartan
{
namespace
{
/// How far triangles may turn when a vertex of theirs moves by a short edge.
const double LeastCosine = 0.5;

/// What flips may do; see WithoutSlivers.
constexpr FlipOptions Flips{ 0.5236, 1e-2 };

double CosineOfNormals(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
  const Eigen::Vector3d& moved, const Eigen::Vector3d& apex)
{
  const Eigen::Vector3d before = (b - apex).cross(a - apex);
  const Eigen::Vector3d after = (b - moved).cross(a - moved);
  const double product = before.norm() * after.norm();
  return product > 0.0 ? before.dot(after) / product : 1.0;
}

/// Whether a pass has changed something around a vertex.
enum Lock : char
{
  Free,
  BesideFlip,
  BesideRemoval
};

/// Takes slivers out of a mesh, pass by pass. A pass leaves alone what touches a
/// change that it has made already. Flips touch each other when they share a
/// triangle, so that those of a regular mesh are done all in one pass: the order of its
/// equal edges decides nothing.
class SliverRemoval
{
public:
  explicit SliverRemoval(const HandleProblem& problem)
    : Mesh(problem.Mesh)
    , Rest(*problem.Rest)
    , Handle(problem.Handle)
    , JoinedWith(problem.JoinedWith)
    , IsSoft(problem.SoftWeights.size() > 0)
  {
    if (!this->JoinedWith.empty())
    {
      this->IsJoined.assign(this->JoinedWith.size(), 0);
    }
    for (std::size_t v = 0; v < this->JoinedWith.size(); ++v)
    {
      const int first = this->JoinedWith[v];
      const bool isJoined = first != static_cast<int>(v);
      this->IsJoined[v] = this->IsJoined[v] || isJoined;
      this->IsJoined[first] = this->IsJoined[first] || isJoined;
    }
  }

  /// Whether something has changed. Vertices that split a triangle go before anything
  /// else: the triangle is there again then, whatever lies beside it.
  bool Pass()
  {
    this->Locks.assign(this->Mesh->NumberOfVertices(), Free);
    this->NewEdges.clear();
    this->Changed = this->Mesh->GetTriangles();
    this->HasChanged = false;
    const std::vector<Sliver> slivers = FindSlivers(*this->Mesh, this->Rest);
    for (const Sliver& sliver : slivers)
    {
      if (sliver.IsCap && !this->IsRingLocked(sliver.Vertex))
      {
        this->RideInTriangle(sliver.Vertex, sliver.Edge);
      }
    }
    const bool isDone = this->HasChanged;
    for (std::size_t i = 0; i < slivers.size() && !isDone; ++i)
    {
      const Sliver& sliver = slivers[i];
      sliver.IsCap ? this->TakeOutCap(sliver.Vertex, sliver.Edge)
                   : this->Collapse(sliver.Vertex, sliver.Edge);
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

  /// The edge across from the origin of d in its left triangle, seen from outside
  /// of that: from the triangle's third vertex to its second.
  int Across(int d) const { return this->Mesh->Next(this->Mesh->Twin(this->Mesh->Next(d))); }

  bool MayGo(int v) const
  {
    return this->Handle[v] == 0 && (this->IsJoined.empty() || !this->IsJoined[v]);
  }

  /// Whether vertices are one for the method, so that no edge may run between them.
  bool AreOne(int v, int w) const
  {
    return v == w || (!this->IsJoined.empty() && this->JoinedWith[v] == this->JoinedWith[w]);
  }

  bool IsRingLocked(int v) const
  {
    bool isLocked = this->Locks[v] != Free;
    for (int d = this->Mesh->RingBegin(v); d < this->Mesh->RingEnd(v); ++d)
    {
      isLocked = isLocked || this->Locks[this->Mesh->Neighbor(d)] != Free;
    }
    return isLocked;
  }

  void LockRing(int v)
  {
    this->Locks[v] = BesideRemoval;
    for (int d = this->Mesh->RingBegin(v); d < this->Mesh->RingEnd(v); ++d)
    {
      this->Locks[this->Mesh->Neighbor(d)] = BesideRemoval;
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
    if (this->Mesh->LeftTriangle(across) >= 0)
    {
      this->Flip(v, d, this->Mesh->Opposite(across));
    }
    else if (!this->IsRingLocked(v))
    {
      this->LeaveOut(v, d);
    }
  }

  /// Whether a cap's low vertex is held where its long edge is held anyway.
  bool IsHeldByEdge(int v, int d) const
  {
    const int a = this->Mesh->Neighbor(d);
    const int b = this->Mesh->Neighbor(this->Mesh->NextAround(v, d));
    return !this->IsSoft && (this->IsJoined.empty() || !this->IsJoined[v]) &&
      this->Handle[v] == this->Handle[a] && this->Handle[v] == this->Handle[b];
  }

  /// The three triangles around v, one of which is a cap on the left of d, become one,
  /// which carries it.
  void RideInTriangle(int v, int d)
  {
    const int begin = this->Mesh->RingBegin(v);
    if (this->Mesh->Valence(v) != 3 || this->Mesh->IsBoundary(v) ||
      !(this->MayGo(v) || this->IsHeldByEdge(v, d)))
    {
      return;
    }
    std::array<int, 3> corners;
    for (int i = 0; i < 3; ++i)
    {
      corners[i] = this->Mesh->Neighbor(begin + i);
      // Not the top of a tetrahedron.
      if (this->Mesh->Opposite(this->Across(begin + i)) ==
        this->Mesh->Neighbor(begin + (i + 2) % 3))
      {
        return;
      }
    }
    if (!CanCarry(this->Rest, corners, v))
    {
      return;
    }
    this->Riders.push_back(MakeRider(this->Rest, v, corners));
    this->Changed.row(this->Mesh->LeftTriangle(begin)) << corners[0], corners[1], corners[2];
    this->Remove(this->Mesh->LeftTriangle(begin + 1));
    this->Remove(this->Mesh->LeftTriangle(begin + 2));
    this->LockRing(v);
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

  bool IsAsBefore(int triangle) const
  {
    return this->Changed.row(triangle) == this->Mesh->GetTriangles().row(triangle);
  }

  /// (v, a, b) and (b, a, apex) become (v, a, apex) and (apex, b, v).
  void Flip(int v, int d, int apex)
  {
    const int a = this->Mesh->Neighbor(d);
    const int b = this->Mesh->Neighbor(this->Mesh->NextAround(v, d));
    const int left = this->Mesh->LeftTriangle(d);
    const int right = this->Mesh->LeftTriangle(this->Across(d));
    const std::pair<int, int> edge = std::minmax(v, apex);
    if (!this->IsAsBefore(left) || !this->IsAsBefore(right) || this->Locks[v] == BesideRemoval ||
      this->Locks[apex] == BesideRemoval || this->AreOne(apex, v) || this->AreNeighbors(v, apex) ||
      this->NewEdges.count(edge) > 0 ||
      !FlipImproves(this->At(a), this->At(b), this->At(v), this->At(apex), Flips))
    {
      return;
    }
    this->Changed.row(left) << v, a, apex;
    this->Changed.row(right) << apex, b, v;
    this->NewEdges.insert(edge);
    this->HasChanged = true;
    for (const int vertex : { v, a, b, apex })
    {
      this->Locks[vertex] = std::max(this->Locks[vertex], BesideFlip);
    }
  }

  double RingLength(int v) const
  {
    double length = 0.0;
    for (int d = this->Mesh->RingBegin(v); d < this->Mesh->RingEnd(v); ++d)
    {
      length += (this->At(this->Mesh->Neighbor(d)) - this->At(v)).norm();
    }
    return length;
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
    // First the one that less of the surface hangs on.
    const bool isSmaller = this->RingLength(v) < this->RingLength(w);
    const std::pair<int, int> first = isSmaller ? std::pair(v, w) : std::pair(w, v);
    for (const auto& [goes, stays] : { first, std::pair(first.second, first.first) })
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
      if (neighbor != stays && this->AreOne(neighbor, stays))
      {
        return false;
      }
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
        const double height = RelativeHeight(this->Rest, { stays, x, y });
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
  const std::vector<int>& JoinedWith;
  std::vector<char> IsJoined; // with others; empty where all vertices are alone
  bool IsSoft;
  std::vector<Lock> Locks;
  std::set<std::pair<int, int>> NewEdges; // of the flips of a pass
  Triangles Changed;                      // -1 where one goes
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

std::vector<long long> ComponentsInWhole(const HandleProblem& problem)
{
  const TriangleMesh& mesh = *problem.GetParted();
  std::vector<long long> numbers(mesh.NumberOfComponents());
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v))
    {
      numbers[mesh.Component(v)] = problem.GetWhole()->Component(v);
    }
  }
  return numbers;
}
}
