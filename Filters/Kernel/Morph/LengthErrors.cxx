// SPDX-License-Identifier: BSD-3-Clause
#include "Morph/LengthErrors.h"

#include "Base/Error.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
std::string DescribeLengthErrors(double t,
  const Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor>& edges,
  const Eigen::VectorXd& lengths, const Points& positions)
{
  const double negligible = lengths.size() ? 1e-4 * lengths.mean() : 0.0;
  IdSample ends;
  double worst = 0.0;
  Eigen::Index worstEdge = 0;
  for (Eigen::Index e = 0; e < lengths.size(); ++e)
  {
    const double length = (positions.row(edges(e, 1)) - positions.row(edges(e, 0))).norm();
    const double error = std::abs(length - lengths[e]) / std::max(lengths[e], negligible);
    if (error > LargestLengthError)
    {
      ends.Add(edges(e, 0));
    }
    if (error > worst)
    {
      worst = error;
      worstEdge = e;
    }
  }
  return ends.IsEmpty()
    ? std::string()
    : "At the parameter " + std::to_string(t) + " the length of " + ends.Describe("edge", "edges") +
      ", ids of the first end points, is off that between the key frames by more than " +
      std::to_string(std::lround(100.0 * LargestLengthError)) + " %; from point " +
      std::to_string(edges(worstEdge, 0)) + " to point " + std::to_string(edges(worstEdge, 1)) +
      " it is by " + std::to_string(std::lround(100.0 * worst)) + " %.";
}
}
