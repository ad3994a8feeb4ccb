// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/HandleProblem.h"

#include <vector>

namespace cartan
{
/// Whether a pinned handle holds anything in the components of moving ones.
bool HasPinnedHandle(const HandleProblem& problem);

/// The *regions* between handles: the connected parts of the vertices that are
/// solved for, cut where handles hold exactly. A region sees the handles that
/// hold its vertices or border on it, and no others: beyond a handle that ends
/// a region the surface turns as if that handle were alone.
class HandleRegions
{
public:
  /// Stands for all pinned handles in lists of handles.
  static constexpr int Pinned = -1;

  explicit HandleRegions(const HandleProblem& problem);

  int NumberOfRegions() const { return static_cast<int>(this->Handles.size()); }

  /// The region of a vertex; -1 where nothing is solved for.
  int OfVertex(int v) const { return this->Regions[v]; }

  /// Whether a vertex can move: it belongs to a moving handle or to a region.
  bool IsReached(int v) const { return this->Moving[v] >= 0 || this->Regions[v] >= 0; }

  /// The moving handles of the vertices, #V: index in HandleProblem::Moving, -1
  /// at others.
  const std::vector<int>& GetMoving() const { return this->Moving; }

  /// The handles that a region sees, Pinned or an index in
  /// HandleProblem::Moving, in increasing order.
  const std::vector<int>& GetHandles(int region) const { return this->Handles[region]; }

  std::size_t GetBytes() const { return TotalBytes(this->Regions, this->Moving, this->Handles); }

private:
  void FindOnPieces(const HandleProblem& problem, const std::vector<char>& isUnknown);

  std::vector<int> Regions; ///< #V
  std::vector<int> Moving;  ///< #V
  std::vector<std::vector<int>> Handles;
};
}
