// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/HoleFilling.h"

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
/// An edge, whatever its direction, as one number.
std::uint64_t EdgeKey(int a, int b)
{
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 |
    static_cast<std::uint64_t>(std::max(a, b));
}

/// The border of a surface: from each border vertex to the next one around its
/// hole, and the triangle across that step.
struct Border
{
  std::vector<int> Next;                   // #V, -1 where there is none, -2 where there are several
  std::vector<int> Triangle;               // #V
  std::unordered_set<std::uint64_t> Edges; // between border vertices
};

Border FindBorder(const Triangles& triangles, int numberOfVertices)
{
  const EdgeTable edges(numberOfVertices, triangles);
  Border border{ std::vector<int>(numberOfVertices, -1), std::vector<int>(numberOfVertices, -1),
    {} };
  for (int edge = 0; edge < edges.NumberOfEdges(); ++edge)
  {
    if (edges.NumberOfSides(edge) == 1)
    {
      // Around the hole the step runs against the triangle's side.
      const int side = *edges.Begin(edge);
      const int from = SideTo(triangles, side);
      border.Next[from] = border.Next[from] == -1 ? SideFrom(triangles, side) : -2;
      border.Triangle[from] = side / 3;
    }
  }
  for (int edge = 0; edge < edges.NumberOfEdges(); ++edge)
  {
    const int a = SideFrom(triangles, *edges.Begin(edge));
    const int b = SideTo(triangles, *edges.Begin(edge));
    if (border.Next[a] != -1 && border.Next[b] != -1)
    {
      border.Edges.insert(EdgeKey(a, b));
    }
  }
  return border;
}

/// What a triangulation costs: first the largest angle between neighbors'
/// normals, as 1 - cos, then the area.
struct Cost
{
  double Bend = 0.0;
  double Area = 0.0;

  bool operator<(const Cost& other) const
  {
    return this->Bend != other.Bend ? this->Bend < other.Bend : this->Area < other.Area;
  }
  Cost operator+(const Cost& other) const
  {
    return { std::max(this->Bend, other.Bend), this->Area + other.Area };
  }
};

constexpr double Impossible = 1e300;

/// The unit normal; zero for a triangle without area.
Eigen::Vector3d UnitNormal(
  const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
{
  const Eigen::Vector3d areaVector = (b - a).cross(c - a);
  return HasArea(areaVector.norm(), LongestEdgeSquared(a, b, c))
    ? Eigen::Vector3d(areaVector.normalized())
    : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

/// The best triangulation of one loop.
class LoopTriangulation
{
public:
  LoopTriangulation(const std::vector<int>& loop, const Border& border, const Triangles& triangles,
    const Points& points)
    : Loop(loop)
    , Surface(border)
    , Positions(points)
    , Size(static_cast<int>(loop.size()))
    , Costs(loop.size() * loop.size())
    , Middles(loop.size() * loop.size(), -1)
  {
    for (const int v : loop)
    {
      const auto corners = triangles.row(border.Triangle[v]);
      this->Outside.push_back(
        UnitNormal(points.row(corners[0]), points.row(corners[1]), points.row(corners[2])));
    }
  }

  /// Adds the triangles; false if there is no triangulation without an edge that
  /// exists already.
  bool Run(std::vector<std::array<int, 3>>& faces, const ExecutionContext& context)
  {
    for (int span = 2; span < this->Size; ++span)
    {
      context.Report(0.5);
      for (int i = 0; i + span < this->Size; ++i)
      {
        this->Choose(i, i + span);
      }
    }
    if (!(this->Costs[this->At(0, this->Size - 1)].Bend < Impossible))
    {
      return false;
    }
    std::vector<std::array<int, 2>> parts = { { 0, this->Size - 1 } };
    while (!parts.empty())
    {
      const auto [i, j] = parts.back();
      parts.pop_back();
      if (j - i > 1)
      {
        const int k = this->Middles[this->At(i, j)];
        faces.push_back({ this->Loop[i], this->Loop[k], this->Loop[j] });
        parts.push_back({ i, k });
        parts.push_back({ k, j });
      }
    }
    return true;
  }

private:
  std::size_t At(int i, int j) const { return static_cast<std::size_t>(i) * this->Size + j; }

  Eigen::Vector3d Point(int i) const { return this->Positions.row(this->Loop[i]); }

  /// The normal of what is already on the far side of the chord from i to j.
  Eigen::Vector3d NormalAcross(int i, int j) const
  {
    const int k = this->Middles[this->At(i, j)];
    return j - i == 1 ? this->Outside[i]
                      : UnitNormal(this->Point(i), this->Point(k), this->Point(j));
  }

  /// W(i, j) = min over k of W(i, k) + W(k, j) + the triangle (i, k, j).
  void Choose(int i, int j)
  {
    Cost& best = this->Costs[this->At(i, j)];
    best = { Impossible, 0.0 };
    const bool closesLoop = i == 0 && j == this->Size - 1;
    if (!closesLoop && this->Surface.Edges.count(EdgeKey(this->Loop[i], this->Loop[j])) > 0)
    {
      return;
    }
    for (int k = i + 1; k < j; ++k)
    {
      const Cost sides = this->Costs[this->At(i, k)] + this->Costs[this->At(k, j)];
      if (!(sides < best))
      {
        continue;
      }
      const Eigen::Vector3d a = this->Point(i);
      const Eigen::Vector3d b = this->Point(k);
      const Eigen::Vector3d c = this->Point(j);
      const Eigen::Vector3d normal = UnitNormal(a, b, c);
      Cost triangle{ std::max(this->Bend(normal, this->NormalAcross(i, k)),
                       this->Bend(normal, this->NormalAcross(k, j))),
        (b - a).cross(c - a).norm() / 2.0 };
      if (closesLoop)
      {
        triangle.Bend = std::max(triangle.Bend, this->Bend(normal, this->Outside[j]));
      }
      const Cost total = sides + triangle;
      if (total < best)
      {
        best = total;
        this->Middles[this->At(i, j)] = k;
      }
    }
  }

  /// A filling triangle without area counts as folded over; what a neighbor
  /// without area has for a normal does not matter.
  double Bend(const Eigen::Vector3d& normal, const Eigen::Vector3d& across) const
  {
    return normal.isZero(0.0) ? 2.0 : across.isZero(0.0) ? 0.0 : 1.0 - normal.dot(across);
  }

  const std::vector<int>& Loop;
  const Border& Surface;
  const Points& Positions;
  int Size;
  std::vector<Eigen::Vector3d> Outside; // normals across the steps of the loop
  std::vector<Cost> Costs;              // i * n + j, of the part from i to j
  std::vector<int> Middles;
};

/// The loop that starts at v; empty if it meets a vertex of several holes.
std::vector<int> FollowLoop(const Border& border, int v, std::vector<char>& isSeen)
{
  std::vector<int> loop;
  int w = v;
  do
  {
    isSeen[w] = 1;
    loop.push_back(w);
    w = border.Next[w];
  } while (w >= 0 && !isSeen[w]);
  return w == v ? loop : std::vector<int>();
}

double LoopLength(const std::vector<int>& loop, const Points& points)
{
  double length = 0.0;
  for (std::size_t i = 0; i < loop.size(); ++i)
  {
    length += (points.row(loop[i]) - points.row(loop[(i + 1) % loop.size()])).norm();
  }
  return length;
}

/// A triangle on its own is no hole: filling its border would double it.
bool IsSingleTriangle(const std::vector<int>& loop, const Border& border)
{
  return loop.size() == 3 && border.Triangle[loop[0]] == border.Triangle[loop[1]] &&
    border.Triangle[loop[1]] == border.Triangle[loop[2]];
}
}

HoleFill FillHoles(const Triangles& triangles, const Points& points, const HoleOptions& options,
  const ExecutionContext& context)
{
  const auto numberOfVertices = static_cast<int>(points.rows());
  const Border border = FindBorder(triangles, numberOfVertices);
  const auto limit = static_cast<std::size_t>(std::min(options.MaximumEdges, LargestHole));
  std::vector<char> isSeen(numberOfVertices, 0);
  std::vector<std::array<int, 3>> faces;
  HoleFill fill;
  for (int v = 0; v < numberOfVertices; ++v)
  {
    if (border.Next[v] < 0 || isSeen[v])
    {
      continue;
    }
    const std::vector<int> loop = FollowLoop(border, v, isSeen);
    const bool isFilled = loop.size() >= 3 && loop.size() <= limit &&
      LoopLength(loop, points) <= options.MaximumLength && !IsSingleTriangle(loop, border) &&
      LoopTriangulation(loop, border, triangles, points).Run(faces, context);
    ++(isFilled ? fill.NumberOfHoles : fill.NumberOfOpen);
  }
  fill.Faces.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (std::size_t t = 0; t < faces.size(); ++t)
  {
    for (int corner = 0; corner < 3; ++corner)
    {
      fill.Faces(static_cast<Eigen::Index>(t), corner) = faces[t][corner];
    }
  }
  return fill;
}
}
