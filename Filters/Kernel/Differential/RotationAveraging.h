// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/AnchoredSystem.h"
#include "Base/Bytes.h"

#include <memory>
#include <vector>

namespace cartan
{
/// The frames on the nodes of a graph that fit given transitions over its edges
/// best,
///
///   min over rotations F of sum w |log(F_from C F_to^T)|^2,
///
/// where the transitions C (for example interpolated ones) do not fit together
/// exactly. To first order in small rotations v of all frames a term is
/// |log(F_from C F_to^T) + v_from - v_to|^2, so each step is a linear system
/// with the graph's Laplacian, which does not depend on C (Govindu,
/// Lie-Algebraic Averaging for Globally Consistent Motion Estimation, 2004).
/// The frames stay rotations; those of the linear problem
/// min sum |F_from C - F_to|^2 shrink where transitions disagree.
class RotationAveraging
{
public:
  struct Edge
  {
    int From;
    int To;
    double Weight = 1.0;
  };

  /// `laplacian` is factorized: the matrix sum w (v_from - v_to)^2, with a fixed
  /// node in each component at least. Frames of fixed nodes are kept.
  RotationAveraging(
    int numberOfNodes, std::vector<Edge> edges, std::shared_ptr<const AnchoredSystem> laplacian);

  struct Result
  {
    int Steps;
    double LastTurn; ///< the most that the last step turned a frame, in radians
  };

  /// Improves `frames` (#nodes x 9). `transitions` is #edges x 9; zero ones are
  /// left out. Stops when a step turns no frame by more than 1e-8, or after
  /// MaximumSteps: where gross misfits make it slow, the rest has long settled
  /// then. The steps are the same for the same transitions
  /// in any place, and for those of the reversed motion.
  Result Improve(
    const Matrices& transitions, Matrices& frames, const ExecutionContext& context = {}) const;

  static constexpr int MaximumSteps = 50;

  /// The memory that it holds, the Laplacian included.
  std::size_t GetBytes() const { return BytesOf(this->Edges) + this->Laplacian->GetBytes(); }

private:
  int NodeCount;
  std::vector<Edge> Edges;
  std::shared_ptr<const AnchoredSystem> Laplacian;
};
}
