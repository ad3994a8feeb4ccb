// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/RayTree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace cartan
{
namespace
{
constexpr int TrianglesPerLeaf = 4;
/// Halving 2^31 triangles ends well before.
constexpr int LargestDepth = 32;
/// Reports progress after so many triangles.
constexpr int TrianglesPerReport = 1 << 15;
constexpr double Nowhere = std::numeric_limits<double>::infinity();
}

/// A ray with what its tests share. Its triangle test is that of Woop, Benthin
/// and Wald, Watertight Ray/Triangle Intersection, 2013: along the axis z in
/// which the direction is largest, space is sheared until the ray is that axis.
struct RayTree::Ray
{
  Ray(const Eigen::Vector3d& from, const Eigen::Vector3d& direction)
    : From(from)
    , Inverse(direction.cwiseInverse())
  {
    direction.cwiseAbs().maxCoeff(&this->Z);
    this->X = (this->Z + 1) % 3;
    this->Y = (this->Z + 2) % 3;
    this->Scale = 1.0 / direction[this->Z];
    this->ShearX = direction[this->X] * this->Scale;
    this->ShearY = direction[this->Y] * this->Scale;
  }

  /// How far away the ray enters the box. The product of 0 and infinity, of a
  /// start on a side that the ray is parallel to, is the comparisons' second
  /// operand and passed over.
  double Enter(const Eigen::AlignedBox3d& box) const
  {
    double near = 0.0;
    double far = Nowhere;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double a = (box.min()[axis] - this->From[axis]) * this->Inverse[axis];
      const double b = (box.max()[axis] - this->From[axis]) * this->Inverse[axis];
      near = std::max(near, std::min(a, b));
      far = std::min(far, std::max(a, b));
    }
    return near <= far ? near : Nowhere;
  }

  /// How far away the ray meets the triangle; negative if it does not.
  double Meet(const Eigen::Matrix3d& corners) const
  {
    std::array<double, 3> x;
    std::array<double, 3> y;
    std::array<double, 3> z;
    for (int corner = 0; corner < 3; ++corner)
    {
      const Eigen::Vector3d p = corners.col(corner) - this->From;
      x[corner] = p[this->X] - this->ShearX * p[this->Z];
      y[corner] = p[this->Y] - this->ShearY * p[this->Z];
      z[corner] = p[this->Z] * this->Scale;
    }
    // Twice the areas between the ray and the edges: barycentric coordinates up
    // to their sum. An edge has the same area in both its triangles but for the
    // sign and, with fused operations, for the rounding, which is allowed for.
    std::array<double, 3> area;
    double sum = 0.0;
    bool isLeft = true;
    bool isRight = true;
    for (int corner = 0; corner < 3; ++corner)
    {
      const int next = (corner + 1) % 3;
      const int last = (corner + 2) % 3;
      const double plus = x[last] * y[next];
      const double minus = y[last] * x[next];
      const double bound =
        2.0 * std::numeric_limits<double>::epsilon() * (std::abs(plus) + std::abs(minus));
      area[corner] = plus - minus;
      sum += area[corner];
      isLeft = isLeft && area[corner] >= -bound;
      isRight = isRight && area[corner] <= bound;
    }
    if (!(isLeft || isRight) || sum == 0.0)
    {
      return -1.0;
    }
    const double distance = (area[0] * z[0] + area[1] * z[1] + area[2] * z[2]) / sum;
    // Rounding must not carry the hit off a triangle that is seen edge-on.
    const auto range = std::minmax({ z[0], z[1], z[2] });
    return std::min(std::max(distance, range.first), range.second);
  }

  Eigen::Vector3d From;
  Eigen::Vector3d Inverse; // of the direction, per component
  double Scale = 0.0;
  double ShearX = 0.0;
  double ShearY = 0.0;
  int X = 0;
  int Y = 1;
  int Z = 2;
};

RayTree::RayTree(const Triangles& triangles, const Points& points, const ExecutionContext& context)
  : Center(Eigen::Vector3d::Zero())
{
  const auto size = static_cast<int>(triangles.rows());
  if (size == 0)
  {
    return;
  }
  // Relative to the middle, or the padding would be lost far from the origin.
  Eigen::AlignedBox3d all;
  for (Eigen::Index v = 0; v < points.rows(); ++v)
  {
    all.extend(points.row(v).transpose());
  }
  this->Center = all.center();
  std::vector<Eigen::AlignedBox3d> boxes(size);
  for (int t = 0; t < size; ++t)
  {
    for (int corner = 0; corner < 3; ++corner)
    {
      boxes[t].extend(points.row(triangles(t, corner)).transpose() - this->Center);
    }
  }
  this->Ids.resize(size);
  std::iota(this->Ids.begin(), this->Ids.end(), 0);
  // Far above the rounding of Enter() and Meet(), so that no box is left out
  // that holds what the ray meets.
  this->Build(boxes, 0, size, 1e-12 * all.diagonal().norm(), context);
  this->Corners.resize(size);
  for (int i = 0; i < size; ++i)
  {
    for (int corner = 0; corner < 3; ++corner)
    {
      this->Corners[i].col(corner) =
        points.row(triangles(this->Ids[i], corner)).transpose() - this->Center;
    }
  }
}

void RayTree::Build(std::vector<Eigen::AlignedBox3d>& boxes, int begin, int end, double padding,
  const ExecutionContext& context)
{
  Node node;
  Eigen::AlignedBox3d centers;
  for (int i = begin; i < end; ++i)
  {
    node.Box.extend(boxes[this->Ids[i]]);
    centers.extend(boxes[this->Ids[i]].center());
  }
  node.Box.min().array() -= padding;
  node.Box.max().array() += padding;
  const std::size_t index = this->Nodes.size();
  if (end - begin <= TrianglesPerLeaf)
  {
    node.First = begin;
    node.Count = end - begin;
    this->Nodes.push_back(node);
    return;
  }
  this->Nodes.push_back(node);
  int axis = 0;
  centers.sizes().maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(this->Ids.begin() + begin, this->Ids.begin() + middle, this->Ids.begin() + end,
    [&](int a, int b) { return boxes[a].center()[axis] < boxes[b].center()[axis]; });
  this->Build(boxes, begin, middle, padding, context);
  this->Nodes[index].First = static_cast<int>(this->Nodes.size());
  this->Build(boxes, middle, end, padding, context);
  if (end - begin > TrianglesPerReport && middle - begin <= TrianglesPerReport)
  {
    context.Report(static_cast<double>(end) / static_cast<double>(boxes.size()));
  }
}

RayHit RayTree::FirstHit(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const
{
  RayHit hit;
  if (this->Nodes.empty())
  {
    return hit;
  }
  const Ray ray(from - this->Center, direction);
  double nearest = Nowhere;
  struct Entry
  {
    int Node;
    double Distance;
  };
  std::array<Entry, LargestDepth> later;
  int numberOfLater = 0;
  Entry entry = { 0, ray.Enter(this->Nodes[0].Box) };
  while (true)
  {
    if (entry.Distance <= nearest && entry.Distance < Nowhere)
    {
      const Node& node = this->Nodes[entry.Node];
      if (node.Count == 0)
      {
        // The nearer child first: what it holds often rules out the other.
        Entry other = { node.First, ray.Enter(this->Nodes[node.First].Box) };
        entry = { entry.Node + 1, ray.Enter(this->Nodes[entry.Node + 1].Box) };
        if (other.Distance < entry.Distance)
        {
          std::swap(entry, other);
        }
        if (other.Distance <= nearest && other.Distance < Nowhere)
        {
          later[numberOfLater++] = other;
        }
        continue;
      }
      for (int i = node.First; i < node.First + node.Count; ++i)
      {
        const double distance = ray.Meet(this->Corners[i]);
        if (distance >= 0.0 &&
          (distance < nearest || (distance == nearest && this->Ids[i] < hit.Triangle)))
        {
          nearest = distance;
          hit = { distance, this->Ids[i] };
        }
      }
    }
    if (numberOfLater == 0)
    {
      return hit;
    }
    entry = later[--numberOfLater];
  }
}
}
