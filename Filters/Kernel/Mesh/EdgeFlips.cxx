// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/EdgeFlips.h"

#include "Mesh/EdgeTable.h"
#include "Mesh/TriangleShape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_set>
#include <vector>

namespace cartan
{
namespace
{
/// A flip must raise the smallest angle by more than rounding.
constexpr double Improvement = 1e-9;

/// How often the loop looks for an abort.
constexpr std::size_t ReportEvery = 1 << 14;

int NextSide(int side)
{
  return side % 3 == 2 ? side - 2 : side + 1;
}
int LastSide(int side)
{
  return side % 3 == 0 ? side + 2 : side - 1;
}

double Angle(const Eigen::Vector3d& u, const Eigen::Vector3d& v)
{
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

double SmallestAngle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
{
  return std::min({ Angle(b - a, c - a), Angle(c - b, a - b), Angle(a - c, b - c) });
}

/// The unit normal; zero for a cap or needle too thin to have one.
Eigen::Vector3d Normal(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
  const FlipOptions& options)
{
  const Eigen::Vector3d areaVector = (b - a).cross(c - a);
  const double area = areaVector.norm();
  const double longest = LongestEdgeSquared(a, b, c);
  return HasArea(area, longest) && area > options.CapHeight * longest
    ? Eigen::Vector3d(areaVector / area)
    : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

/// Whether all normals that there are lie within `angle` of each other.
bool AreWithin(const std::array<Eigen::Vector3d, 4>& normals, double angle)
{
  const double least = std::cos(angle);
  for (int i = 0; i < 4; ++i)
  {
    for (int j = 0; j < i; ++j)
    {
      if (!normals[i].isZero(0.0) && !normals[j].isZero(0.0) && normals[i].dot(normals[j]) < least)
      {
        return false;
      }
    }
  }
  return true;
}

/// Triangles that are flipped in place. Side `s` lies against side Across[s].
class FlipMesh
{
public:
  FlipMesh(Triangles& triangles, const Points& points, const FlipOptions& options)
    : Corners(triangles)
    , Positions(points)
    , Options(options)
    , Across(triangles.size(), -1)
  {
    const EdgeTable edges(static_cast<int>(points.rows()), triangles);
    for (int edge = 0; edge < edges.NumberOfEdges(); ++edge)
    {
      const int* side = edges.Begin(edge);
      this->Edges.insert(this->Key(SideFrom(triangles, *side), SideTo(triangles, *side)));
      if (edges.NumberOfSides(edge) == 2 &&
        SideFrom(triangles, side[0]) != SideFrom(triangles, side[1]))
      {
        this->Across[side[0]] = side[1];
        this->Across[side[1]] = side[0];
      }
    }
  }

  bool IsInner(int side) const { return this->Across[side] >= 0; }

  /// Whether the flip of the edge from a to b, with c on its left and d on its
  /// right, to one from d to c is allowed and makes angles better.
  bool ShouldFlip(int side) const
  {
    const int c = SideApex(this->Corners, side);
    const int d = SideApex(this->Corners, this->Across[side]);
    if (c == d || this->Edges.count(this->Key(c, d)) > 0)
    {
      return false;
    }
    return FlipImproves(this->Positions.row(SideFrom(this->Corners, side)),
      this->Positions.row(SideTo(this->Corners, side)), this->Positions.row(c),
      this->Positions.row(d), this->Options);
  }

  /// The triangles (a, b, c) and (b, a, d) become (c, a, d) and (d, b, c).
  /// Returns the four sides around them.
  std::array<int, 4> Flip(int side)
  {
    const int other = this->Across[side];
    const int a = SideFrom(this->Corners, side);
    const int b = SideTo(this->Corners, side);
    const int c = SideApex(this->Corners, side);
    const int d = SideApex(this->Corners, other);
    const int bc = this->Across[NextSide(side)];
    const int ca = this->Across[LastSide(side)];
    const int ad = this->Across[NextSide(other)];
    const int db = this->Across[LastSide(other)];
    this->Edges.erase(this->Key(a, b));
    this->Edges.insert(this->Key(c, d));
    const int t = side - side % 3;
    const int u = other - other % 3;
    this->Corners.row(t / 3) << c, a, d;
    this->Corners.row(u / 3) << d, b, c;
    this->Connect(t, ca);
    this->Connect(t + 1, ad);
    this->Connect(t + 2, u + 2);
    this->Connect(u, db);
    this->Connect(u + 1, bc);
    return { t, t + 1, u, u + 1 };
  }

private:
  static std::uint64_t Key(int a, int b)
  {
    return static_cast<std::uint64_t>(std::min(a, b)) << 32 |
      static_cast<std::uint64_t>(std::max(a, b));
  }

  void Connect(int side, int other)
  {
    this->Across[side] = other;
    if (other >= 0)
    {
      this->Across[other] = side;
    }
  }

  Triangles& Corners;
  const Points& Positions;
  FlipOptions Options;
  std::vector<int> Across;                 // 3 #T, -1 at borders
  std::unordered_set<std::uint64_t> Edges; // that exist
};
}

bool FlipImproves(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
  const Eigen::Vector3d& d, const FlipOptions& options)
{
  const double before = std::min(SmallestAngle(a, b, c), SmallestAngle(b, a, d));
  const double after = std::min(SmallestAngle(d, c, a), SmallestAngle(c, d, b));
  return after > before + Improvement &&
    AreWithin({ Normal(a, b, c, options), Normal(b, a, d, options), Normal(c, a, d, options),
                Normal(d, b, c, options) },
      options.MaximumAngle);
}

int FlipEdges(Triangles& triangles, const Points& points, const FlipOptions& options,
  const ExecutionContext& context)
{
  FlipMesh mesh(triangles, points, options);
  std::vector<int> queue;
  std::vector<char> isQueued(triangles.size(), 0);
  const auto enqueue = [&](int side)
  {
    if (mesh.IsInner(side) && !isQueued[side])
    {
      isQueued[side] = 1;
      queue.push_back(side);
    }
  };
  for (int side = static_cast<int>(triangles.size()) - 1; side >= 0; --side)
  {
    enqueue(side);
  }
  int flips = 0;
  for (std::size_t step = 0; !queue.empty(); ++step)
  {
    if (step % ReportEvery == 0)
    {
      context.Report(0.5);
    }
    const int side = queue.back();
    queue.pop_back();
    isQueued[side] = 0;
    if (mesh.IsInner(side) && mesh.ShouldFlip(side))
    {
      ++flips;
      for (const int around : mesh.Flip(side))
      {
        enqueue(around);
      }
    }
  }
  return flips;
}
}
