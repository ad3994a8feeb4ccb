// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Merging/MeshMerge.h"
#include "Mesh/BoundaryLoops.h"

#include <string>
#include <vector>

namespace cartan
{
/// The boundary of one of two surfaces that are to be sewn together.
struct MergeBoundary
{
  MergeInput Surface;
  std::string Role; ///< "target" or "source", in messages
  /// #V: equal numbers >= 1 on both surfaces belong together, 0 is no key.
  std::vector<int> Keys;
};

/// Which loops are sewn together, and what is known of how.
struct PairedLoops
{
  std::vector<LoopPair> Pairs;
  std::vector<std::vector<LoopKey>> Keys; ///< at least one per pair
  std::vector<int> GivenKeys;             ///< how many of a pair's keys are the user's
  std::string Warning;                    ///< in sentences; empty if nothing is odd
};

/// Up to so many loops without keys are paired by trying all ways.
constexpr int MostLoopsWithoutKeys = 6;

/// With keys, the loops that have equal ones, in the order of the source's; the others
/// stay open. Without, one loop each needs nothing; equal numbers of loops are paired so
/// that their centers and planes are closest, with a warning that says which. The first
/// key of a pair without is that of FindFirstKey.
///
/// Throws Error(BadInput) for a closed surface, a key at a vertex that is not on the
/// boundary, on one surface only or twice on one, keys that join a loop to several, and
/// different numbers of loops, or too many, without keys.
PairedLoops PairLoops(
  const MergeBoundary& target, const MergeBoundary& source, LoopAlignment alignment);
}
