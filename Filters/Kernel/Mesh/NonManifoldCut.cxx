// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/NonManifoldCut.h"

#include "Base/DisjointSets.h"
#include "Mesh/EdgeTable.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cartan
{
namespace
{
/// Side `a` goes on at side Mates[a], which runs the other way; -1 where the
/// surface ends or is cut: 3 #T.
using Mates = std::vector<int>;

/// Of a triangle over an edge, in parts of the edge. The angle of a lower one is what
/// rounding makes it a thousand sizes away from the origin.
constexpr double LeastHeight = 1e-10;

bool RunOpposite(const Triangles& triangles, int a, int b)
{
  return SideFrom(triangles, a) != SideFrom(triangles, b);
}

/// Six times the volume that the triangles enclose when they close.
double SignedVolume(const Triangles& triangles, const Points& points)
{
  double volume = 0.0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    const Eigen::RowVector3d center = points.row(triangles(0, 0));
    const Eigen::RowVector3d a = points.row(triangles(t, 0)) - center;
    const Eigen::RowVector3d b = points.row(triangles(t, 1)) - center;
    const Eigen::RowVector3d c = points.row(triangles(t, 2)) - center;
    volume += a.dot(b.cross(c));
  }
  return volume;
}

/// The triangles around an edge from u to v by the angle about it, counter-
/// clockwise seen from v. A triangle that runs from u to v has its outside on the side
/// of larger angles: with alternating directions, a body lies between a triangle
/// that runs from v to u and the next one. Joins those; nothing where directions
/// do not alternate, or where a triangle without area lies at no angle.
void PairAroundEdge(const EdgeTable& edges, int edge, const Triangles& triangles,
  const Points& points, bool isInsideOut, Mates& mates)
{
  const int* begin = edges.Begin(edge);
  const int u = SideFrom(triangles, *begin);
  const Eigen::Vector3d along = (points.row(SideTo(triangles, *begin)) - points.row(u)).transpose();
  const double length = along.norm();
  if (!(length > 0.0))
  {
    return;
  }
  const Eigen::Vector3d axis = along / length;
  const Eigen::Vector3d x = axis.unitOrthogonal();
  const Eigen::Vector3d y = axis.cross(x);
  std::vector<std::pair<double, int>> around;
  for (const int* side = begin; side != edges.End(edge); ++side)
  {
    const Eigen::Vector3d arm =
      (points.row(SideApex(triangles, *side)) - points.row(u)).transpose();
    const double height = std::hypot(arm.dot(x), arm.dot(y));
    if (!(height > LeastHeight * (std::abs(arm.dot(axis)) + length)))
    {
      return;
    }
    around.emplace_back(std::atan2(arm.dot(y), arm.dot(x)), *side);
  }
  std::sort(around.begin(), around.end());
  const std::size_t size = around.size();
  for (std::size_t i = 0; i < size; ++i)
  {
    if (!RunOpposite(triangles, around[i].second, around[(i + 1) % size].second))
    {
      return;
    }
  }
  for (std::size_t i = 0; i < size; ++i)
  {
    const int side = around[i].second;
    const bool opensBody = (SideFrom(triangles, side) != u) != isInsideOut;
    if (opensBody)
    {
      const int next = around[(i + 1) % size].second;
      mates[side] = next;
      mates[next] = side;
    }
  }
}

Mates FindMates(
  const EdgeTable& edges, const Triangles& triangles, const Points& points, NonManifoldCut& report)
{
  Mates mates(triangles.size(), -1);
  const bool isInsideOut = SignedVolume(triangles, points) < 0.0;
  for (int edge = 0; edge < edges.NumberOfEdges(); ++edge)
  {
    const int count = edges.NumberOfSides(edge);
    const int* side = edges.Begin(edge);
    if (count == 2 && RunOpposite(triangles, side[0], side[1]))
    {
      mates[side[0]] = side[1];
      mates[side[1]] = side[0];
    }
    else if (count > 2 && count % 2 == 0)
    {
      PairAroundEdge(edges, edge, triangles, points, isInsideOut, mates);
    }
    report.NumberOfContradictions += count == 2 && mates[side[0]] < 0;
    report.NumberOfEdges += count > 2;
  }
  return mates;
}

/// Numbers the classes of corners and writes them to Faces and CopyOf.
void NumberClasses(
  int numberOfVertices, const Triangles& triangles, const Mates& mates, NonManifoldCut& cut)
{
  const auto size = static_cast<int>(triangles.size());
  const auto next = [](int corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; };
  DisjointSets classes(size);
  for (int side = 0; side < size; ++side)
  {
    if (mates[side] > side)
    {
      classes.Join(side, next(mates[side]));
      classes.Join(next(side), mates[side]);
    }
  }
  cut.Faces.resize(triangles.rows(), 3);
  cut.CopyOf.clear();
  std::vector<char> isTaken(numberOfVertices, 0);
  std::vector<int> idOfClass(size, -1);
  for (int corner = 0; corner < size; ++corner)
  {
    const int v = triangles.data()[corner];
    int& id = idOfClass[classes.Find(corner)];
    if (id < 0 && !isTaken[v])
    {
      isTaken[v] = 1;
      id = v;
    }
    else if (id < 0)
    {
      id = numberOfVertices + static_cast<int>(cut.CopyOf.size());
      cut.CopyOf.push_back(v);
    }
    cut.Faces.data()[corner] = id;
  }
}

/// Takes apart what was paired where an edge still has more than two triangles:
/// there a body touches itself. Returns whether there was any such edge.
bool UnpairCrowdedEdges(int numberOfVertices, const NonManifoldCut& cut, Mates& mates)
{
  const EdgeTable edges(numberOfVertices + static_cast<int>(cut.CopyOf.size()), cut.Faces);
  bool anyCrowded = false;
  for (int edge = 0; edge < edges.NumberOfEdges(); ++edge)
  {
    if (edges.NumberOfSides(edge) <= 2)
    {
      continue;
    }
    for (const int* side = edges.Begin(edge); side != edges.End(edge); ++side)
    {
      if (mates[*side] >= 0)
      {
        mates[mates[*side]] = -1;
        mates[*side] = -1;
        anyCrowded = true;
      }
    }
  }
  return anyCrowded;
}
}

NonManifoldCut CutNonManifold(
  const Triangles& triangles, const Points& points, const ExecutionContext& context)
{
  NonManifoldCut cut;
  const auto numberOfVertices = static_cast<int>(points.rows());
  const EdgeTable edges(numberOfVertices, triangles);
  Mates mates = FindMates(edges, triangles, points, cut);
  // Ends: each round takes at least one pair apart, and without pairs at edges
  // of more than two triangles none is crowded. A fan's two ends are the only
  // triangles of it at such an edge, and they run in opposite directions.
  do
  {
    context.Report(0.5);
    NumberClasses(numberOfVertices, triangles, mates, cut);
  } while (UnpairCrowdedEdges(numberOfVertices, cut, mates));

  std::vector<char> hasCopy(numberOfVertices, 0);
  for (const int v : cut.CopyOf)
  {
    cut.NumberOfPoints += !hasCopy[v];
    hasCopy[v] = 1;
  }
  return cut;
}
}
