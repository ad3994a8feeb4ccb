// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

namespace cartan
{
/// How a surface is rounded.
struct HighPassQuality
{
  int Bits = 0;
  int Anchors = 0;
};

/// The fewest bits, 1 to 16, whose `errorOf(bits)` is at most `maximumError`, both in parts
/// of the bounding box's diagonal. `errorOf` is last called with them. Throws
/// Error(BadInput) that says what 16 bits with `numberOfAnchors` reach.
int FewestBits(
  const std::function<double(int bits)>& errorOf, double maximumError, int numberOfAnchors);

/// What a surface has for the search.
struct QualityLimits
{
  int Anchors = 20;     ///< where the search begins
  int LeastAnchors = 1; ///< its components
  int Points = 1;       ///< how many it has, the most anchors
};

/// The bits that FewestBits finds with limits.Anchors, or one less where up to eight times as
/// many anchors allow it and take less than the bit does; then, with the same bits, half the
/// anchors as often as the error allows it. Each number of anchors that is tried is a
/// factorization.
HighPassQuality FewestBitsAndAnchors(const std::function<double(HighPassQuality)>& errorOf,
  double maximumError, const QualityLimits& limits);
}
