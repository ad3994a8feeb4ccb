// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// Vertices that are to move by given vectors, each up to its accuracy.
struct LandmarkTargets
{
  std::vector<int> Vertices;  ///< #L, each once
  Points Displacements;       ///< #L x 3, length units
  Eigen::VectorXd Accuracies; ///< #L, length units, >= 0; 0: exactly
};

/// How softly landmarks may be held, as weights of HandleProblem::SoftWeights: #L,
/// infinity where the accuracy is 0. They are w_k = s / a_k with the smallest s (up to a
/// factor of some percent) for which the harmonic displacement
///
///   min sum over both directions of edges of c_ij |u_i - u_j|^2 + sum_k w_k^2 |u_k - d_k|^2
///
/// misses no d_k by more than MissedShare of its accuracy a_k. c_ij are cotangent weights;
/// u is zero at `pinned` vertices (#V, non-zero where pinned) and in components without a
/// landmark. 1 / miss is nearly linear in s^2, as it is exactly for one landmark, so s^2 is
/// found by the secant method, a factorization for each step.
///
/// Methods that turn details with the surface store less energy than this displacement, so
/// their landmarks are pulled away with smaller forces.
Eigen::VectorXd LandmarkWeights(const TriangleMesh& mesh, const Points& points,
  const std::vector<char>& pinned, const LandmarkTargets& landmarks,
  const ExecutionContext& context = {});

/// What part of the accuracy the harmonic displacement uses: the rest is for methods whose
/// energy is another one.
constexpr double MissedShare = 0.5;
}
