// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Types.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
/// The height of a triangle over its longest edge, in parts of that edge, below
/// which rounding leaves it neither a normal nor angles.
constexpr double SmallestHeight = 1e-12;

/// Whether a triangle with this squared longest edge is higher than that.
inline bool HasArea(
  double twiceArea, double longestEdgeSquared, double smallestHeight = SmallestHeight)
{
  return twiceArea > smallestHeight * longestEdgeSquared;
}

inline double LongestEdgeSquared(
  const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
{
  return std::max({ (b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm() });
}

/// The cotangent of the angle between two edges of a triangle with this dot
/// product; that of an equilateral triangle where there is no area, which keeps
/// it finite and of the usual sign.
inline double Cotangent(double dotProduct, double twiceArea, double longestEdgeSquared,
  double smallestHeight = SmallestHeight)
{
  return HasArea(twiceArea, longestEdgeSquared, smallestHeight) ? dotProduct / twiceArea
                                                                : 1.0 / std::sqrt(3.0);
}

/// The cotangents of the angles at a, b and c.
inline Eigen::Vector3d Cotangents(
  const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
{
  const double twiceArea = (b - a).cross(c - a).norm();
  const double longest = LongestEdgeSquared(a, b, c);
  return { Cotangent((b - a).dot(c - a), twiceArea, longest),
    Cotangent((c - b).dot(a - b), twiceArea, longest),
    Cotangent((a - c).dot(b - c), twiceArea, longest) };
}
}
