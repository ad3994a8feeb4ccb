// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/CoincidentPoints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>

namespace cartan
{
namespace
{
/// How often loops over points look for an abort.
constexpr int ReportEvery = 1 << 15;

/// In lexicographic order, points of equal coordinates are neighbors.
std::vector<int> FindEqualPoints(const Points& points, const std::vector<char>& takesPart)
{
  std::vector<int> order;
  for (int v = 0; v < points.rows(); ++v)
  {
    if (takesPart[v])
    {
      order.push_back(v);
    }
  }
  const auto compare = [&points](int a, int b)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      if (points(a, axis) != points(b, axis))
      {
        return points(a, axis) < points(b, axis) ? -1 : 1;
      }
    }
    return 0;
  };
  std::sort(order.begin(), order.end(),
    [&compare](int a, int b)
    {
      const int sign = compare(a, b);
      return sign != 0 ? sign < 0 : a < b;
    });
  std::vector<int> first(points.rows());
  std::iota(first.begin(), first.end(), 0);
  for (std::size_t i = 1; i < order.size(); ++i)
  {
    if (compare(order[i - 1], order[i]) == 0)
    {
      first[order[i]] = first[order[i - 1]];
    }
  }
  return first;
}

/// Points in cubes with edges twice as long as the tolerance: what is within the
/// tolerance of a point is in its cube or one of the seven next to its corner.
class Grid
{
public:
  Grid(const Points& points, const Eigen::Vector3d& origin, double tolerance)
    : Positions(points)
    , Origin(origin)
    , Tolerance(tolerance)
    , Next(points.rows(), -1)
  {
  }

  void Insert(int v)
  {
    const auto found = this->Heads.emplace(this->CellOf(v), v);
    if (!found.second)
    {
      this->Next[v] = found.first->second;
      found.first->second = v;
    }
  }

  /// The nearest inserted point within the tolerance; -1 if there is none.
  int Nearest(int v) const
  {
    int nearest = -1;
    double best = this->Tolerance * this->Tolerance;
    const Cell center = this->CellOf(v);
    const Cell side = this->NearerSides(v, center);
    for (int i = 0; i < 8; ++i)
    {
      const auto head = this->Heads.find({ center[0] + (i & 1 ? side[0] : 0),
        center[1] + (i & 2 ? side[1] : 0), center[2] + (i & 4 ? side[2] : 0) });
      for (int w = head == this->Heads.end() ? -1 : head->second; w >= 0; w = this->Next[w])
      {
        const double distance = (this->Positions.row(w) - this->Positions.row(v)).squaredNorm();
        if (distance < best || (distance == best && (nearest < 0 || w < nearest)))
        {
          best = distance;
          nearest = w;
        }
      }
    }
    return nearest;
  }

private:
  using Cell = std::array<std::int64_t, 3>;
  struct Hash
  {
    std::size_t operator()(const Cell& cell) const
    {
      std::uint64_t hash = 0;
      for (const std::int64_t i : cell)
      {
        // The odd constant of splitmix64 and a shift spread neighboring cells.
        hash = (hash ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15ULL;
        hash ^= hash >> 29;
      }
      return static_cast<std::size_t>(hash);
    }
  };

  double InCells(int v, int axis) const
  {
    return (this->Positions(v, axis) - this->Origin[axis]) / (2.0 * this->Tolerance);
  }

  Cell CellOf(int v) const
  {
    Cell cell;
    for (int axis = 0; axis < 3; ++axis)
    {
      cell[axis] = static_cast<std::int64_t>(std::floor(this->InCells(v, axis)));
    }
    return cell;
  }

  /// -1 or 1 per axis: where the nearer neighbor of the point's cell is.
  Cell NearerSides(int v, const Cell& cell) const
  {
    Cell sides;
    for (int axis = 0; axis < 3; ++axis)
    {
      sides[axis] = this->InCells(v, axis) - static_cast<double>(cell[axis]) < 0.5 ? -1 : 1;
    }
    return sides;
  }

  const Points& Positions;
  Eigen::Vector3d Origin;
  double Tolerance;
  std::unordered_map<Cell, int, Hash> Heads; // the last point inserted into a cell
  std::vector<int> Next;                     // the one before it in the same cell, or -1
};
}

std::vector<int> FindCoincidentPoints(const Points& points, const std::vector<char>& takesPart,
  double tolerance, const ExecutionContext& context)
{
  Eigen::AlignedBox3d box;
  for (int v = 0; v < points.rows(); ++v)
  {
    if (takesPart[v])
    {
      box.extend(points.row(v).transpose());
    }
  }
  context.Report(0.0);
  if (box.isEmpty() || !(tolerance > 1e-15 * box.diagonal().norm()))
  {
    return FindEqualPoints(points, takesPart);
  }
  std::vector<int> first(points.rows());
  std::iota(first.begin(), first.end(), 0);
  Grid grid(points, box.min(), tolerance);
  for (int v = 0; v < points.rows(); ++v)
  {
    if (v % ReportEvery == 0)
    {
      context.Report(static_cast<double>(v) / static_cast<double>(points.rows()));
    }
    if (takesPart[v])
    {
      const int nearest = grid.Nearest(v);
      if (nearest >= 0)
      {
        first[v] = nearest;
      }
      else
      {
        grid.Insert(v);
      }
    }
  }
  return first;
}
}
