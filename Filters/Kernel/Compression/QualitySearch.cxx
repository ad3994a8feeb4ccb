// SPDX-License-Identifier: BSD-3-Clause
#include "Compression/QualitySearch.h"

#include "Base/Error.h"
#include "Compression/HighPassQuantization.h"

#include <algorithm>
#include <sstream>

namespace cartan
{
int FewestBits(
  const std::function<double(int bits)>& errorOf, double maximumError, int numberOfAnchors)
{
  constexpr int MostBits = 16;
  double reached = 0.0;
  for (int bits = 1; bits <= MostBits; ++bits)
  {
    reached = errorOf(bits);
    if (reached <= maximumError)
    {
      return bits;
    }
  }
  std::ostringstream text;
  text << MostBits << " bits with " << numberOfAnchors << " anchors reach a visual error of "
       << reached << " of the diagonal, not " << maximumError << "; allow a larger MaximumError.";
  throw Error(ErrorCode::BadInput, text.str());
}

HighPassQuality FewestBitsAndAnchors(const std::function<double(HighPassQuality)>& errorOf,
  double maximumError, const QualityLimits& limits)
{
  HighPassQuality best;
  best.Anchors = std::clamp(limits.Anchors, limits.LeastAnchors, limits.Points);
  best.Bits = FewestBits(
    [&](int bits) {
      return errorOf({ bits, best.Anchors });
    },
    maximumError, best.Anchors);

  // A bit less saves one per coordinate, an anchor takes three positions.
  const auto mostAnchors =
    std::min<long long>(limits.Points / HighPassCode::AnchorBits, 8LL * best.Anchors);
  for (int anchors = 2 * best.Anchors; best.Bits > 1 && anchors <= mostAnchors; anchors *= 2)
  {
    if (errorOf({ best.Bits - 1, anchors }) <= maximumError)
    {
      return { best.Bits - 1, anchors };
    }
  }
  for (int anchors = best.Anchors / 2; anchors >= limits.LeastAnchors; anchors /= 2)
  {
    if (errorOf({ best.Bits, anchors }) > maximumError)
    {
      break;
    }
    best.Anchors = anchors;
  }
  return best;
}
}
