// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Types.h"

#include <string>

namespace cartan
{
/// The part by which an edge may miss its length without a word: more is seen as a
/// dent or a fold.
constexpr double LargestLengthError = 0.25;

/// Says which edges of `positions` (#V x 3) are further off their `lengths` (#E) than
/// LargestLengthError, and which one the most; empty if none is. `edges` is #E x 2.
/// Edges shorter than 1e-4 of the mean count as that long. `t` is the parameter.
std::string DescribeLengthErrors(double t,
  const Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor>& edges,
  const Eigen::VectorXd& lengths, const Points& positions);
}
