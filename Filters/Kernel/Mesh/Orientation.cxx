// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Orientation.h"

#include "Base/Constants.h"
#include "Base/DisjointSets.h"
#include "Base/FloodFill.h"
#include "Mesh/EdgeTable.h"
#include "Mesh/Geometry.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace cartan
{
namespace
{
/// The other triangle's side at edges of exactly two triangles, else -1: 3 #T.
std::vector<int> SidesAcross(const EdgeTable& edges, Eigen::Index numberOfSides)
{
  std::vector<int> across(numberOfSides, -1);
  for (int edge = 0; edge < edges.NumberOfEdges(); ++edge)
  {
    if (edges.NumberOfSides(edge) == 2)
    {
      const int* side = edges.Begin(edge);
      across[side[0]] = side[1];
      across[side[1]] = side[0];
    }
  }
  return across;
}

/// What the winding test needs to know of a component.
struct Component
{
  std::vector<int> TriangleIds;
  Eigen::AlignedBox3d Box;
  double Volume = 0.0;
  double Area = 0.0;
  bool IsClosed = true;

  bool EnclosesVolume() const
  {
    return this->IsClosed && cartan::EnclosesVolume(this->Volume, this->Area);
  }
};

Eigen::Vector3d Centroid(const Triangles& triangles, const Points& points, int t)
{
  return (points.row(triangles(t, 0)) + points.row(triangles(t, 1)) + points.row(triangles(t, 2)))
           .transpose() /
    3.0;
}

std::vector<Component> FindComponents(const Triangles& triangles, const Points& points)
{
  const auto size = static_cast<int>(triangles.rows());
  DisjointSets sets(static_cast<int>(points.rows()));
  for (int t = 0; t < size; ++t)
  {
    sets.Join(triangles(t, 0), triangles(t, 1));
    sets.Join(triangles(t, 1), triangles(t, 2));
  }
  std::vector<int> componentOf(points.rows(), -1);
  std::vector<Component> components;
  for (int t = 0; t < size; ++t)
  {
    int& component = componentOf[sets.Find(triangles(t, 0))];
    if (component < 0)
    {
      component = static_cast<int>(components.size());
      components.emplace_back();
    }
    components[component].TriangleIds.push_back(t);
    for (int corner = 0; corner < 3; ++corner)
    {
      components[component].Box.extend(points.row(triangles(t, corner)).transpose());
    }
  }
  const EdgeTable edges(static_cast<int>(points.rows()), triangles);
  for (int edge = 0; edge < edges.NumberOfEdges(); ++edge)
  {
    const int* side = edges.Begin(edge);
    if (edges.NumberOfSides(edge) != 2 ||
      SideFrom(triangles, side[0]) == SideFrom(triangles, side[1]))
    {
      components[componentOf[sets.Find(SideFrom(triangles, side[0]))]].IsClosed = false;
    }
  }
  for (Component& component : components)
  {
    const Eigen::Vector3d center = component.Box.center();
    for (const int t : component.TriangleIds)
    {
      const Eigen::Vector3d a = points.row(triangles(t, 0)).transpose() - center;
      const Eigen::Vector3d b = points.row(triangles(t, 1)).transpose() - center;
      const Eigen::Vector3d c = points.row(triangles(t, 2)).transpose() - center;
      component.Volume += a.dot(b.cross(c)) / 6.0;
      component.Area += (b - a).cross(c - a).norm() / 2.0;
    }
  }
  return components;
}

/// How often the component winds around the point:
///   tan(Omega / 2) = a . (b x c) / (|a| |b| |c| + a.b |c| + b.c |a| + c.a |b|)
/// summed over its triangles, in units of the full solid angle.
double WindingNumber(const Component& component, const Triangles& triangles, const Points& points,
  const Eigen::Vector3d& from)
{
  double halfAngle = 0.0;
  for (const int t : component.TriangleIds)
  {
    const Eigen::Vector3d a = points.row(triangles(t, 0)).transpose() - from;
    const Eigen::Vector3d b = points.row(triangles(t, 1)).transpose() - from;
    const Eigen::Vector3d c = points.row(triangles(t, 2)).transpose() - from;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    halfAngle +=
      std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return halfAngle / FullTurn;
}

/// Whether `outer` winds an odd number of times around `inner`. Where they touch
/// the winding number is no integer, so that of several triangles decides whose
/// is closest to one.
bool IsInside(
  const Component& inner, const Component& outer, const Triangles& triangles, const Points& points)
{
  constexpr std::size_t samples = 8;
  const std::size_t step = std::max<std::size_t>(1, inner.TriangleIds.size() / samples);
  double best = 0.0;
  double bestError = 1.0;
  for (std::size_t i = 0; i < inner.TriangleIds.size() && bestError > 1e-3; i += step)
  {
    const double number =
      WindingNumber(outer, triangles, points, Centroid(triangles, points, inner.TriangleIds[i]));
    const double error = std::abs(number - std::round(number));
    if (error < bestError)
    {
      bestError = error;
      best = std::round(number);
    }
  }
  return static_cast<long long>(std::abs(best)) % 2 == 1;
}
}

ConsistentOrientation OrientConsistently(
  const Triangles& triangles, const Points& points, const ExecutionContext& context)
{
  const auto size = static_cast<int>(triangles.rows());
  const EdgeTable edges(static_cast<int>(points.rows()), triangles);
  const std::vector<int> across = SidesAcross(edges, triangles.size());
  const Eigen::VectorXd areas = TriangleAreaVectors(points, triangles, context).rowwise().norm();
  ConsistentOrientation result;
  result.IsReversed.assign(size, 0);
  std::vector<char> isSeen(size, 0);
  for (int seed = 0; seed < size; ++seed)
  {
    if (isSeen[seed])
    {
      continue;
    }
    ++result.NumberOfPatches;
    // In the order of distance from the seed: where the fronts of a one-sided
    // patch meet, the contradictions form a short cut.
    double balance = 0.0; // area that keeps its side minus area turned over
    const std::vector<int> patch = FloodFill(
      { seed }, [&isSeen](int t) { return !std::exchange(isSeen[t], 1); },
      [&](int t, const auto& reach)
      {
        balance += result.IsReversed[t] ? -areas[t] : areas[t];
        for (int side = 3 * t; side < 3 * t + 3; ++side)
        {
          const int other = across[side];
          if (other >= 0 && !isSeen[other / 3])
          {
            const bool disagrees = SideFrom(triangles, side) == SideFrom(triangles, other);
            result.IsReversed[other / 3] = static_cast<char>(result.IsReversed[t] != disagrees);
            reach(other / 3);
          }
        }
      });
    for (const int t : patch)
    {
      result.IsReversed[t] = static_cast<char>(result.IsReversed[t] != (balance < 0.0));
    }
  }
  for (int side = 0; side < 3 * size; ++side)
  {
    const int other = across[side];
    if (other > side)
    {
      const bool disagrees = SideFrom(triangles, side) == SideFrom(triangles, other);
      result.NumberOfContradictions +=
        disagrees == (result.IsReversed[side / 3] == result.IsReversed[other / 3]);
    }
  }
  return result;
}

OutwardOrientation OrientOutwards(const Triangles& triangles, const Points& points,
  bool alternatesNested, const ExecutionContext& context)
{
  const std::vector<Component> components = FindComponents(triangles, points);
  OutwardOrientation result;
  result.IsReversed.assign(triangles.rows(), 0);
  for (std::size_t i = 0; i < components.size(); ++i)
  {
    context.Report(static_cast<double>(i) / static_cast<double>(components.size()));
    const Component& component = components[i];
    if (!component.EnclosesVolume())
    {
      continue;
    }
    bool facesInwards = false;
    for (std::size_t j = 0; alternatesNested && j < components.size(); ++j)
    {
      const Component& outer = components[j];
      if (j != i && outer.EnclosesVolume() && outer.Box.contains(component.Box) &&
        IsInside(component, outer, triangles, points))
      {
        facesInwards = !facesInwards;
      }
    }
    if ((component.Volume < 0.0) != facesInwards)
    {
      ++result.NumberOfReversedComponents;
      for (const int t : component.TriangleIds)
      {
        result.IsReversed[t] = 1;
      }
    }
  }
  return result;
}

void ReverseTriangles(Triangles& triangles, const std::vector<char>& isReversed)
{
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    if (isReversed[t])
    {
      std::swap(triangles(t, 1), triangles(t, 2));
    }
  }
}
}
