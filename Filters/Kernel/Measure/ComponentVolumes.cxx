// SPDX-License-Identifier: BSD-3-Clause
#include "Measure/ComponentVolumes.h"

#include "Mesh/Geometry.h"
#include "Mesh/RayTree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace cartan
{
namespace
{
Eigen::Vector3d Corner(const TriangleMesh& mesh, const Points& points, int t, int corner)
{
  return points.row(mesh.GetTriangles()(t, corner)).transpose();
}

int ComponentOfTriangle(const TriangleMesh& mesh, int t)
{
  return mesh.Component(mesh.GetTriangles()(t, 0));
}

std::vector<Eigen::AlignedBox3d> ComponentBoxes(
  const TriangleMesh& mesh, const Points& points, const SurfaceComponents& parts)
{
  constexpr double Infinity = std::numeric_limits<double>::infinity();
  const Eigen::Index count = parts.GetCount();
  Eigen::VectorXd extremes = Eigen::VectorXd::Constant(6 * count, -Infinity); // of x and -x
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (parts.CountsVertex(v))
    {
      auto box = extremes.segment<6>(6 * parts.OfVertex(v));
      const Eigen::Vector3d point = points.row(v).transpose();
      box.head<3>() = box.head<3>().cwiseMax(point);
      box.tail<3>() = box.tail<3>().cwiseMax(-point);
    }
  }
  parts.Max(extremes);
  std::vector<Eigen::AlignedBox3d> boxes;
  for (Eigen::Index c = 0; c < count; ++c)
  {
    boxes.emplace_back(-extremes.segment<3>(6 * c + 3), extremes.segment<3>(6 * c));
  }
  return boxes;
}

/// Whether the box of a component that encloses volume is inside of another's.
/// Sorted by their sizes along x, so that few pairs are looked at.
bool IsAnyBoxInside(
  const std::vector<Eigen::AlignedBox3d>& boxes, const std::vector<ComponentVolume>& components)
{
  std::vector<int> order;
  for (std::size_t c = 0; c < boxes.size(); ++c)
  {
    if (components[c].EnclosesVolume())
    {
      order.push_back(static_cast<int>(c));
    }
  }
  std::sort(order.begin(), order.end(),
    [&boxes](int a, int b) { return boxes[a].min()[0] < boxes[b].min()[0]; });
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    const Eigen::AlignedBox3d& box = boxes[order[i]];
    for (std::size_t j = i + 1; j < order.size() && boxes[order[j]].min()[0] <= box.max()[0]; ++j)
    {
      if (box.contains(boxes[order[j]]) || boxes[order[j]].contains(box))
      {
        return true;
      }
    }
  }
  return false;
}

/// The triangles of the components that enclose volume.
Triangles EnclosingTriangles(
  const TriangleMesh& mesh, const std::vector<ComponentVolume>& components)
{
  std::vector<int> kept;
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    if (components[ComponentOfTriangle(mesh, t)].EnclosesVolume())
    {
      kept.push_back(t);
    }
  }
  Triangles triangles(static_cast<Eigen::Index>(kept.size()), 3);
  for (std::size_t i = 0; i < kept.size(); ++i)
  {
    triangles.row(static_cast<Eigen::Index>(i)) = mesh.GetTriangles().row(kept[i]);
  }
  return triangles;
}

/// What rays in one direction find.
std::vector<int> EnclosingAlong(const Eigen::Vector3d& direction, const TriangleMesh& mesh,
  const Points& points, const std::vector<ComponentVolume>& components, const Triangles& triangles,
  const RayTree& tree)
{
  std::vector<int> farthest(components.size(), -1);
  const Eigen::VectorXd distances = points * direction;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v))
    {
      int& vertex = farthest[mesh.Component(v)];
      vertex = vertex < 0 || distances[v] > distances[vertex] ? v : vertex;
    }
  }
  std::vector<int> order(components.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
    [&](int a, int b) { return distances[farthest[a]] > distances[farthest[b]]; });
  // Off the component's own triangles, all of which are behind.
  const double offset = 1e-9 * BoundingDiagonal(points);
  std::vector<int> enclosing(components.size(), -1);
  for (const int c : order)
  {
    if (!components[c].EnclosesVolume())
    {
      continue;
    }
    const Eigen::Vector3d start = points.row(farthest[c]).transpose() + offset * direction;
    const RayHit hit = tree.FirstHit(start, direction);
    if (hit.Triangle < 0)
    {
      continue;
    }
    const Eigen::Vector3d p = points.row(triangles(hit.Triangle, 0));
    const Eigen::Vector3d q = points.row(triangles(hit.Triangle, 1));
    const Eigen::Vector3d r = points.row(triangles(hit.Triangle, 2));
    const int other = mesh.Component(triangles(hit.Triangle, 0));
    const bool isLeaving = (q - p).cross(r - p).dot(direction) * components[other].Volume > 0.0;
    // What is met reaches farther than c, so its own answer is known.
    enclosing[c] = isLeaving ? other : enclosing[other];
  }
  return enclosing;
}
}

bool ComponentVolume::EnclosesVolume() const
{
  return this->IsClosed && cartan::EnclosesVolume(this->Volume, this->Area);
}

std::vector<ComponentVolume> MeasureComponents(const TriangleMesh& mesh, const Points& points)
{
  return MeasureComponents(mesh, points, SurfaceComponents(mesh));
}

std::vector<ComponentVolume> MeasureComponents(
  const TriangleMesh& mesh, const Points& points, const SurfaceComponents& parts)
{
  const Eigen::Index count = parts.GetCount();
  // Of each component the sum of its vertices, their number, and that of its border's.
  Eigen::VectorXd ofVertices = Eigen::VectorXd::Zero(5 * count);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (parts.CountsVertex(v))
    {
      auto sums = ofVertices.segment<5>(5 * parts.OfVertex(v));
      sums.head<3>() += points.row(v).transpose();
      sums[3] += 1.0;
      sums[4] += mesh.IsBoundary(v) ? 1.0 : 0.0;
    }
  }
  parts.Sum(ofVertices);
  Eigen::VectorXd ofTriangles = Eigen::VectorXd::Zero(2 * count);
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    if (!parts.CountsTriangle(t))
    {
      continue;
    }
    const Eigen::Index component = parts.OfTriangle(t);
    const auto sums = ofVertices.segment<5>(5 * component);
    const Eigen::Vector3d center = sums.head<3>() / sums[3];
    const Eigen::Vector3d a = Corner(mesh, points, t, 0) - center;
    const Eigen::Vector3d b = Corner(mesh, points, t, 1) - center;
    const Eigen::Vector3d c = Corner(mesh, points, t, 2) - center;
    // The tetrahedron between the triangle and the center.
    ofTriangles[2 * component] += a.dot(b.cross(c)) / 6.0;
    ofTriangles[2 * component + 1] += 0.5 * (b - a).cross(c - a).norm();
  }
  parts.Sum(ofTriangles);
  std::vector<ComponentVolume> components;
  for (Eigen::Index c = 0; c < count; ++c)
  {
    components.push_back(
      { ofTriangles[2 * c], ofTriangles[2 * c + 1], ofVertices[5 * c + 4] == 0.0 });
  }
  return components;
}

bool MayEncloseEachOther(const TriangleMesh& mesh, const Points& points,
  const std::vector<ComponentVolume>& components, const SurfaceComponents& parts)
{
  return parts.GetCount() > 1 && IsAnyBoxInside(ComponentBoxes(mesh, points, parts), components);
}

std::vector<int> EnclosingComponents(
  const TriangleMesh& mesh, const Points& points, const std::vector<ComponentVolume>& components)
{
  std::vector<int> enclosing(components.size(), -1);
  if (!MayEncloseEachOther(mesh, points, components, SurfaceComponents(mesh)))
  {
    return enclosing;
  }
  const Triangles triangles = EnclosingTriangles(mesh, components);
  const RayTree tree(triangles, points);
  // In no plane of symmetry that a surface is likely to have.
  std::vector<int> found[3];
  for (int i = 0; i < 3; ++i)
  {
    const Eigen::Vector3d direction =
      Eigen::Vector3d(0.5377 - 0.9 * i, 0.8339 - 0.41 * i * i, 0.1247 + 0.77 * i).normalized();
    found[i] = EnclosingAlong(direction, mesh, points, components, triangles, tree);
  }
  for (std::size_t c = 0; c < components.size(); ++c)
  {
    enclosing[c] = found[1][c] == found[2][c] ? found[1][c] : found[0][c];
  }
  return enclosing;
}

Points ComponentCenters(
  const TriangleMesh& mesh, const Points& points, const Eigen::VectorXd& weights)
{
  Points centers = Points::Zero(mesh.NumberOfComponents(), 3);
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(mesh.NumberOfComponents());
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v))
    {
      const double weight = weights.size() ? weights[v] : 1.0;
      centers.row(mesh.Component(v)) += weight * points.row(v);
      sums[mesh.Component(v)] += weight;
    }
  }
  return sums.cwiseInverse().asDiagonal() * centers;
}
}
