// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/TriangleTree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace cartan
{
namespace
{
/// The closest point of a segment: the weight of its end.
double ClosestOnSegment(
  const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& point)
{
  const Eigen::Vector3d along = to - from;
  const double squared = along.squaredNorm();
  return squared > 0.0 ? std::clamp(along.dot(point - from) / squared, 0.0, 1.0) : 0.0;
}
}

ClosestPoint ClosestOnTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
  const Eigen::Vector3d& c, const Eigen::Vector3d& point)
{
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double squared = normal.squaredNorm();
  ClosestPoint best;
  if (squared > 0.0)
  {
    best.Weights[1] = normal.dot((point - a).cross(c - a)) / squared;
    best.Weights[2] = normal.dot((b - a).cross(point - a)) / squared;
    best.Weights[0] = 1.0 - best.Weights[1] - best.Weights[2];
    if (best.Weights.minCoeff() >= 0.0)
    {
      best.Distance = (a + best.Weights[1] * (b - a) + best.Weights[2] * (c - a) - point).norm();
      return best;
    }
  }
  best.Distance = std::numeric_limits<double>::infinity();
  const std::array<const Eigen::Vector3d*, 3> corners = { &a, &b, &c };
  for (int i = 0; i < 3; ++i)
  {
    const int j = (i + 1) % 3;
    const double t = ClosestOnSegment(*corners[i], *corners[j], point);
    const double distance = (*corners[i] + t * (*corners[j] - *corners[i]) - point).norm();
    if (distance < best.Distance)
    {
      best.Distance = distance;
      best.Weights.setZero();
      best.Weights[i] = 1.0 - t;
      best.Weights[j] = t;
    }
  }
  return best;
}

TriangleTree::TriangleTree(const Triangles& triangles, const Points& points)
  : Faces(triangles)
  , Positions(points)
{
  Points centers(triangles.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    centers.row(t) =
      (points.row(triangles(t, 0)) + points.row(triangles(t, 1)) + points.row(triangles(t, 2))) /
      3.0;
  }
  std::vector<int> ids(triangles.rows());
  std::iota(ids.begin(), ids.end(), 0);
  this->Nodes.reserve(2 * ids.size());
  this->Build(ids, centers, 0, static_cast<int>(ids.size()));
}

void TriangleTree::Build(std::vector<int>& ids, const Points& centers, int begin, int end)
{
  const std::size_t node = this->Nodes.size();
  this->Nodes.emplace_back();
  if (end - begin == 1)
  {
    Node& leaf = this->Nodes[node];
    leaf.Triangle = ids[begin];
    const auto corner = [&](int i) -> Eigen::Vector3d
    { return this->Positions.row(this->Faces(leaf.Triangle, i)).transpose(); };
    leaf.Area = 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
    for (int i = 0; i < 3; ++i)
    {
      leaf.Box.extend(corner(i));
    }
    return;
  }
  Eigen::AlignedBox3d box;
  for (int i = begin; i < end; ++i)
  {
    box.extend(centers.row(ids[i]).transpose());
  }
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  // Ties by id, so that the tree is the same everywhere.
  std::nth_element(ids.begin() + begin, ids.begin() + middle, ids.begin() + end,
    [&](int s, int t)
    { return centers(s, axis) != centers(t, axis) ? centers(s, axis) < centers(t, axis) : s < t; });
  this->Build(ids, centers, begin, middle);
  const std::size_t second = this->Nodes.size();
  this->Build(ids, centers, middle, end);
  Node& parent = this->Nodes[node];
  parent.Second = static_cast<int>(second);
  parent.Box = this->Nodes[node + 1].Box.merged(this->Nodes[second].Box);
  parent.Area = this->Nodes[node + 1].Area + this->Nodes[second].Area;
}

ClosestPoint TriangleTree::ClosestOn(int triangle, const Eigen::Vector3d& point) const
{
  const auto corner = [&](int i) -> Eigen::Vector3d
  { return this->Positions.row(this->Faces(triangle, i)).transpose(); };
  return ClosestOnTriangle(corner(0), corner(1), corner(2), point);
}

std::pair<int, ClosestPoint> TriangleTree::Closest(const Eigen::Vector3d& point) const
{
  std::pair<int, ClosestPoint> best{ -1, {} };
  best.second.Distance = std::numeric_limits<double>::infinity();
  std::vector<int> open = { 0 };
  while (!open.empty())
  {
    const int i = open.back();
    open.pop_back();
    const Node& node = this->Nodes[i];
    if (!(node.Box.exteriorDistance(point) < best.second.Distance))
    {
      continue;
    }
    if (node.Triangle >= 0)
    {
      const ClosestPoint found = this->ClosestOn(node.Triangle, point);
      if (found.Distance < best.second.Distance)
      {
        best = { node.Triangle, found };
      }
      continue;
    }
    // The nearer child is looked at first.
    const bool isFirstNearer = this->Nodes[i + 1].Box.squaredExteriorDistance(point) <=
      this->Nodes[node.Second].Box.squaredExteriorDistance(point);
    open.push_back(isFirstNearer ? node.Second : i + 1);
    open.push_back(isFirstNearer ? i + 1 : node.Second);
  }
  return best;
}
}
