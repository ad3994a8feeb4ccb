// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/RayTree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace cartan
{
namespace
{
/// Quartering 2^31 triangles ends well before.
constexpr int LargestDepth = 17;
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

  /// How far away the ray enters the boxes below a node. The product of 0 and infinity, of a
  /// start on a side that the ray is parallel to, is the comparisons' second
  /// operand and passed over.
  Lanes Enter(const Node& node) const
  {
    Lanes near = Lanes::Zero();
    Lanes far = Lanes::Constant(Nowhere);
    for (int axis = 0; axis < 3; ++axis)
    {
      const bool isUpward = this->Inverse[axis] > 0.0;
      const Lanes& side = isUpward ? node.Low[axis] : node.High[axis];
      const Lanes& beyond = isUpward ? node.High[axis] : node.Low[axis];
      near = near.max((side - this->From[axis]) * this->Inverse[axis]);
      far = far.min((beyond - this->From[axis]) * this->Inverse[axis]);
    }
    return (near <= far).select(near, Nowhere);
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

/// Divides the triangles among nodes and leaves.
struct RayTree::Builder
{
  /// What a node or a leaf holds.
  struct Range
  {
    int Begin;
    int End;

    int Size() const { return this->End - this->Begin; }
  };

  /// In halves along the longest side of the box of the centers. Leaves are full but for one.
  std::pair<Range, Range> Halve(const Range& range)
  {
    Eigen::AlignedBox3d centers;
    for (int i = range.Begin; i < range.End; ++i)
    {
      centers.extend(this->Boxes[this->Ids[i]].center());
    }
    int axis = 0;
    centers.sizes().maxCoeff(&axis);
    const int middle = range.Begin + (range.Size() / 2 + Width - 1) / Width * Width;
    std::nth_element(this->Ids.begin() + range.Begin, this->Ids.begin() + middle,
      this->Ids.begin() + range.End,
      [&](int a, int b) { return this->Boxes[a].center()[axis] < this->Boxes[b].center()[axis]; });
    return { { range.Begin, middle }, { middle, range.End } };
  }

  /// Adds a node with the triangles, and returns their box.
  Eigen::AlignedBox3d AddNode(const Range& range)
  {
    const std::size_t index = this->Tree.Nodes.size();
    Node node;
    node.Child.fill(0);
    for (int axis = 0; axis < 3; ++axis)
    {
      node.Low[axis].setConstant(Nowhere);
      node.High[axis].setConstant(Nowhere);
    }
    this->Tree.Nodes.push_back(node);
    std::vector<Range> ranges = { range };
    for (const std::size_t size : { std::size_t(1), std::size_t(2) })
    {
      for (std::size_t i = 0; i < size && i < ranges.size(); ++i)
      {
        if (ranges[i].Size() > Width)
        {
          const auto [first, second] = this->Halve(ranges[i]);
          ranges[i] = first;
          ranges.push_back(second);
        }
      }
    }
    Eigen::AlignedBox3d all;
    for (std::size_t i = 0; i < ranges.size(); ++i)
    {
      const bool isLeaf = ranges[i].Size() <= Width;
      node.Child[i] = isLeaf ? -1 - static_cast<int>(this->Tree.Leaves.size())
                             : static_cast<int>(this->Tree.Nodes.size());
      const Eigen::AlignedBox3d box = isLeaf ? this->AddLeaf(ranges[i]) : this->AddNode(ranges[i]);
      for (int axis = 0; axis < 3; ++axis)
      {
        node.Low[axis][static_cast<int>(i)] = box.min()[axis] - this->Padding;
        node.High[axis][static_cast<int>(i)] = box.max()[axis] + this->Padding;
      }
      all.extend(box);
    }
    this->Tree.Nodes[index] = node;
    if (range.Size() > TrianglesPerReport)
    {
      // By leaves, since the ranges come out of order; one of them may not be full.
      const double done = static_cast<double>(this->Tree.Leaves.size()) * Width;
      this->Context.Report(std::min(done / static_cast<double>(this->Ids.size()), 1.0));
    }
    return all;
  }

  /// The same with a leaf.
  Eigen::AlignedBox3d AddLeaf(const Range& range)
  {
    Leaf leaf;
    leaf.Ids.fill(-1);
    Eigen::AlignedBox3d all;
    for (int corner = 0; corner < 3; ++corner)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        leaf.Corners[corner][axis].setZero();
        for (int i = range.Begin; i < range.End; ++i)
        {
          leaf.Corners[corner][axis][i - range.Begin] =
            this->Positions(this->Faces(this->Ids[i], corner), axis) - this->Tree.Center[axis];
        }
      }
    }
    for (int i = range.Begin; i < range.End; ++i)
    {
      leaf.Ids[i - range.Begin] = this->Ids[i];
      all.extend(this->Boxes[this->Ids[i]]);
    }
    this->Tree.Leaves.push_back(leaf);
    return all;
  }

  RayTree& Tree;
  const Triangles& Faces;
  const Points& Positions;
  const ExecutionContext& Context;
  double Padding;
  std::vector<Eigen::AlignedBox3d> Boxes; // of the triangles: #T
  std::vector<int> Ids;                   // of the triangles in the order of the leaves: #T
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
  // Far above the rounding of Enter() and MeetLeaf(), so that no box is left out
  // that holds what the ray meets.
  const double padding = 1e-12 * all.diagonal().norm();
  Builder builder{ *this, triangles, points, context, padding,
    std::vector<Eigen::AlignedBox3d>(size), std::vector<int>(size) };
  for (int t = 0; t < size; ++t)
  {
    for (int corner = 0; corner < 3; ++corner)
    {
      builder.Boxes[t].extend(points.row(triangles(t, corner)).transpose() - this->Center);
    }
  }
  std::iota(builder.Ids.begin(), builder.Ids.end(), 0);
  this->Leaves.reserve((size + Width - 1) / Width);
  builder.AddNode({ 0, size });
}

/// The triangles of a leaf that are met before `nearest`, or as near with a smaller id.
void RayTree::MeetLeaf(const Ray& ray, const Leaf& leaf, RayHit& nearest) const
{
  Lanes x[3];
  Lanes y[3];
  Lanes z[3];
  for (int corner = 0; corner < 3; ++corner)
  {
    const Lanes* p = leaf.Corners[corner];
    const Lanes along = p[ray.Z] - ray.From[ray.Z];
    x[corner] = (p[ray.X] - ray.From[ray.X]) - ray.ShearX * along;
    y[corner] = (p[ray.Y] - ray.From[ray.Y]) - ray.ShearY * along;
    z[corner] = along * ray.Scale;
  }
  // Twice the areas between the ray and the edges: barycentric coordinates up
  // to their sum. An edge has the same area in both its triangles but for the
  // sign and, with fused operations, for the rounding, which is allowed for.
  Lanes area[3];
  Lanes sum = Lanes::Zero();
  Lanes least = Lanes::Constant(Nowhere);
  Lanes largest = Lanes::Constant(-Nowhere);
  for (int corner = 0; corner < 3; ++corner)
  {
    const int next = (corner + 1) % 3;
    const int last = (corner + 2) % 3;
    const Lanes plus = x[last] * y[next];
    const Lanes minus = y[last] * x[next];
    const Lanes bound = 2.0 * std::numeric_limits<double>::epsilon() * (plus.abs() + minus.abs());
    area[corner] = plus - minus;
    sum += area[corner];
    least = least.min(area[corner] + bound);
    largest = largest.max(area[corner] - bound);
  }
  for (int i = 0; i < Width; ++i)
  {
    if (!(least[i] >= 0.0 || largest[i] <= 0.0) || sum[i] == 0.0 || leaf.Ids[i] < 0)
    {
      continue;
    }
    const double mean =
      (area[0][i] * z[0][i] + area[1][i] * z[1][i] + area[2][i] * z[2][i]) / sum[i];
    // Rounding must not carry the hit off a triangle that is seen edge-on.
    const auto range = std::minmax({ z[0][i], z[1][i], z[2][i] });
    const double distance = std::min(std::max(mean, range.first), range.second);
    const bool isFirst = nearest.Triangle < 0 || distance < nearest.Distance ||
      (distance == nearest.Distance && leaf.Ids[i] < nearest.Triangle);
    if (distance >= 0.0 && isFirst)
    {
      nearest = { distance, leaf.Ids[i] };
    }
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
  struct Entry
  {
    int Child;
    double Distance;
  };
  std::array<Entry, (Width - 1) * LargestDepth + 1> later;
  int count = 0;
  later[count++] = { 0, 0.0 };
  while (count > 0)
  {
    const Entry entry = later[--count];
    if (hit.Triangle >= 0 && entry.Distance > hit.Distance)
    {
      continue;
    }
    if (entry.Child < 0)
    {
      this->MeetLeaf(ray, this->Leaves[-1 - entry.Child], hit);
      continue;
    }
    const Node& node = this->Nodes[entry.Child];
    const Lanes distances = ray.Enter(node);
    // The nearest last, which is looked at next: what it holds often rules out the others.
    const int first = count;
    for (int i = 0; i < Width; ++i)
    {
      if (distances[i] < Nowhere && (hit.Triangle < 0 || distances[i] <= hit.Distance))
      {
        int place = count++;
        for (; place > first && later[place - 1].Distance < distances[i]; --place)
        {
          later[place] = later[place - 1];
        }
        later[place] = { node.Child[i], distances[i] };
      }
    }
  }
  return hit;
}
}
