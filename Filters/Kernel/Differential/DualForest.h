// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Differential/Hinges.h"

namespace cartan
{
/// A spanning tree of each component's dual graph, in which triangles are nodes
/// and hinges are arcs, as the order of a walk from the middle of its longest
/// path. From there all nodes are as near as possible, so that rounding errors
/// accumulate least.
struct DualForest
{
  struct Step
  {
    int Triangle;
    int Parent; ///< -1 where a tree begins
    int Hinge;  ///< between both; -1 where a tree begins
  };

  DualForest() = default;

  /// The trees of the smallest sum of `weights`, one per hinge (Kruskal's).
  /// Hinges of the same weight are taken in their order. O(#T log #T).
  DualForest(const HingeTopology& topology, const Eigen::VectorXd& weights);

  std::vector<Step> Steps;   ///< #T, parents before children, tree after tree
  std::vector<int> Tree;     ///< #T, the number of a triangle's tree, from 0
  std::vector<char> IsWhole; ///< per tree: whether all hinges are in it, none left out
  std::size_t GetBytes() const { return TotalBytes(this->Steps, this->Tree, this->IsWhole); }
  int NumberOfTrees() const { return static_cast<int>(this->IsWhole.size()); }
};

/// The frames that `transitions` (see HingeTransitions) give when the trees are
/// walked, each from the identity: #T x 9. Rotations to rounding, however long
/// the walk.
Matrices WalkFrames(
  const HingeTopology& topology, const DualForest& forest, const Matrices& transitions);
}
