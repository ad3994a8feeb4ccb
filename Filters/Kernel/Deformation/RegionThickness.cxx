// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/RegionThickness.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cartan
{
namespace
{
/// Below so many edges a body is a sheet.
constexpr double EdgesOfSheet = 6.0;

/// Six times the volume between a triangle and the origin.
double SixfoldVolume(
  const Eigen::RowVector3d& a, const Eigen::RowVector3d& b, const Eigen::RowVector3d& c)
{
  return a.dot(b.cross(c));
}

/// An edge of an opening, with the region on its left.
struct OpenEdge
{
  int From;
  int To;
};

/// Of each vertex, the first of those that edges of openings connect it with: #V.
std::vector<int> OpeningOfVertices(int numberOfVertices, const std::vector<OpenEdge>& edges)
{
  std::vector<int> parents(numberOfVertices);
  std::iota(parents.begin(), parents.end(), 0);
  const auto find = [&parents](int v)
  {
    while (parents[v] != v)
    {
      v = parents[v] = parents[parents[v]];
    }
    return v;
  };
  for (const OpenEdge& edge : edges)
  {
    const int a = find(edge.From);
    const int b = find(edge.To);
    parents[std::max(a, b)] = std::min(a, b);
  }
  for (int v = 0; v < numberOfVertices; ++v)
  {
    parents[v] = find(v);
  }
  return parents;
}
}

double RegionThickness(
  const TriangleMesh& mesh, const Points& points, const std::vector<char>& isInside)
{
  const Triangles& triangles = mesh.GetTriangles();
  const auto isPart = [&](int t)
  { return t >= 0 && (triangles.row(t).unaryExpr([&](int v) { return int(isInside[v]); })).any(); };
  Eigen::VectorXd volumes = Eigen::VectorXd::Zero(mesh.NumberOfComponents());
  double area = 0.0;
  double squares = 0.0;
  int count = 0;
  Eigen::RowVector3d origin = Eigen::RowVector3d::Zero();
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    if (!isPart(t))
    {
      continue;
    }
    if (count++ == 0)
    {
      origin = points.row(triangles(t, 0));
    }
    const Eigen::RowVector3d a = points.row(triangles(t, 0)) - origin;
    const Eigen::RowVector3d b = points.row(triangles(t, 1)) - origin;
    const Eigen::RowVector3d c = points.row(triangles(t, 2)) - origin;
    volumes[mesh.Component(triangles(t, 0))] += SixfoldVolume(a, b, c) / 6.0;
    area += 0.5 * (b - a).cross(c - a).norm();
    squares += ((b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm()) / 3.0;
  }
  if (!(area > 0.0))
  {
    return 0.0;
  }
  std::vector<OpenEdge> edges;
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    if (isPart(mesh.LeftTriangle(d)) && !isPart(mesh.LeftTriangle(mesh.Twin(d))))
    {
      edges.push_back({ mesh.Origin(d), mesh.Neighbor(d) });
    }
  }
  const std::vector<int> openings = OpeningOfVertices(mesh.NumberOfVertices(), edges);
  Points centers = Points::Zero(mesh.NumberOfVertices(), 3);
  std::vector<int> sizes(mesh.NumberOfVertices(), 0);
  for (const OpenEdge& edge : edges)
  {
    centers.row(openings[edge.From]) += points.row(edge.From) - origin;
    ++sizes[openings[edge.From]];
  }
  for (const OpenEdge& edge : edges)
  {
    const int opening = openings[edge.From];
    volumes[mesh.Component(edge.From)] +=
      SixfoldVolume(points.row(edge.To) - origin, points.row(edge.From) - origin,
        centers.row(opening) / sizes[opening]) /
      6.0;
  }
  return std::max(4.0 * volumes.cwiseAbs().sum() / area, EdgesOfSheet * std::sqrt(squares / count));
}
}
