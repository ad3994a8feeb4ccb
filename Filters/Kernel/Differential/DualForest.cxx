// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/DualForest.h"

#include "Base/CountingSort.h"
#include "Base/DisjointSets.h"

#include <algorithm>
#include <numeric>

namespace cartan
{
namespace
{
/// The hinges at each triangle, those of a forest only.
struct Arcs
{
  Arcs(const HingeTopology& topology, const std::vector<int>& hinges)
  {
    CountingSort(
      topology.NumberOfTriangles(),
      [&](const auto& visit)
      {
        for (const int h : hinges)
        {
          visit(topology.Hinges[h].Left, h);
          visit(topology.Hinges[h].Right, h);
        }
      },
      this->Offsets, this->Hinges);
  }

  std::vector<int> Offsets; // #T + 1
  std::vector<int> Hinges;
};

/// Appends the tree of `root` to `steps`, breadth first.
void Walk(
  const HingeTopology& topology, const Arcs& arcs, int root, std::vector<DualForest::Step>& steps)
{
  std::size_t next = steps.size();
  for (steps.push_back({ root, -1, -1 }); next < steps.size(); ++next)
  {
    const DualForest::Step step = steps[next];
    for (int i = arcs.Offsets[step.Triangle]; i < arcs.Offsets[step.Triangle + 1]; ++i)
    {
      const int h = arcs.Hinges[i];
      if (h != step.Hinge)
      {
        steps.push_back({ topology.Hinges[h].OtherTriangle(step.Triangle), step.Triangle, h });
      }
    }
  }
}

/// The hinges of the smallest spanning trees.
std::vector<int> SpanningHinges(const HingeTopology& topology, const Eigen::VectorXd& weights)
{
  std::vector<int> order(topology.NumberOfHinges());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(
    order.begin(), order.end(), [&weights](int a, int b) { return weights[a] < weights[b]; });
  DisjointSets trees(topology.NumberOfTriangles());
  std::vector<int> hinges;
  for (const int h : order)
  {
    if (trees.Join(topology.Hinges[h].Left, topology.Hinges[h].Right))
    {
      hinges.push_back(h);
    }
  }
  return hinges;
}
}

DualForest::DualForest(const HingeTopology& topology, const Eigen::VectorXd& weights)
  : Tree(topology.NumberOfTriangles(), -1)
{
  const std::vector<int> hinges = SpanningHinges(topology, weights);
  const Arcs arcs(topology, hinges);
  std::vector<Step> search;
  std::vector<int> parent(topology.NumberOfTriangles());
  this->Steps.reserve(topology.NumberOfTriangles());
  for (int seed = 0; seed < topology.NumberOfTriangles(); ++seed)
  {
    if (this->Tree[seed] >= 0)
    {
      continue;
    }
    // A triangle farthest from any is one end of a longest path, one farthest
    // from that the other.
    search.clear();
    Walk(topology, arcs, seed, search);
    const int end = search.back().Triangle;
    search.clear();
    Walk(topology, arcs, end, search);
    int length = 0;
    for (const Step& step : search)
    {
      parent[step.Triangle] = step.Parent;
    }
    for (int t = search.back().Triangle; t >= 0; t = parent[t])
    {
      ++length;
    }
    int middle = search.back().Triangle;
    for (int i = 0; i < length / 2; ++i)
    {
      middle = parent[middle];
    }
    Walk(topology, arcs, middle, this->Steps);
    for (const Step& step : search)
    {
      this->Tree[step.Triangle] = this->NumberOfTrees();
    }
    this->IsWhole.push_back(1);
  }

  std::vector<char> isInTree(topology.NumberOfHinges(), 0);
  for (const int h : hinges)
  {
    isInTree[h] = 1;
  }
  for (int h = 0; h < topology.NumberOfHinges(); ++h)
  {
    if (!isInTree[h])
    {
      this->IsWhole[this->Tree[topology.Hinges[h].Left]] = 0;
    }
  }
}

Matrices WalkFrames(
  const HingeTopology& topology, const DualForest& forest, const Matrices& transitions)
{
  Matrices frames(topology.NumberOfTriangles(), 9);
  for (const DualForest::Step& step : forest.Steps)
  {
    auto frame = MatrixAt(frames, step.Triangle);
    if (step.Parent < 0)
    {
      frame.setIdentity();
      continue;
    }
    const auto transition = MatrixAt(transitions, step.Hinge);
    if (topology.Hinges[step.Hinge].Left == step.Parent)
    {
      frame.noalias() = MatrixAt(frames, step.Parent) * transition;
    }
    else
    {
      frame.noalias() = MatrixAt(frames, step.Parent) * transition.transpose();
    }
    // Products of thousands of rotations drift away from the rotations.
    frame.col(2).normalize();
    frame.col(0) -= frame.col(2) * frame.col(2).dot(frame.col(0));
    frame.col(0).normalize();
    frame.col(1) = frame.col(2).cross(frame.col(0));
  }
  return frames;
}
}
