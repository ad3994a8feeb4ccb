// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Base/Types.h"

#include <vector>

namespace cartan
{
/// Brings the edges of a surface closer to given lengths, by `rounds` rounds of
/// the damped Gauss-Newton method (Levenberg, A Method for the Solution of Certain
/// Non-linear Problems in Least Squares, 1944) on
///
///   sum over edges of (|x_j - x_i| / l - 1)^2.
///
/// `edges` is #E x 2, `lengths` #E and positive, `points` #V x 3. Those of
/// `isHeld` (#V) stay. A round that helps nothing changes nothing. Its linear
/// system is solved by conjugate gradients, which need little memory and can be
/// stopped after each step.
void PolishLengths(const Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor>& edges,
  const Eigen::VectorXd& lengths, const std::vector<char>& isHeld, int rounds, Points& points,
  const ExecutionContext& context = {});
}
