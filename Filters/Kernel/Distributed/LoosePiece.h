// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/SurfacePiece.h"

#include <string>

namespace cartan
{
/// What a rank has of a surface when it comes: triangles that no other rank has, and points
/// that others may have too.
struct LoosePiece
{
  std::shared_ptr<const Ranks> Group;
  Points Positions;  ///< #P x 3
  Triangles Corners; ///< #T x 3, rows of Positions
  /// #P, >= 0, or none: then points of several ranks are one where they are in the same place.
  std::vector<std::int64_t> GlobalIds;
};

/// A piece that knows its neighbors.
struct FittedPiece
{
  /// The points and triangles of the loose piece come first, in their order. Then the triangles
  /// of other ranks at these points, and the other points of those. A point is where its owner
  /// has it. Without global ids, those of the first rank are 0, 1, 2 ..., those of the next one
  /// go on counting, and a point of several ranks has the id of its owner's.
  SurfacePiece Piece;
  bool HasGivenIds = false; ///< whether all ranks with points had global ids
  /// Why it cannot be told which points are one, a part of a sentence and the same on all
  /// ranks; empty where it can.
  std::string Obstacle;
};

/// Collective. Finds the points of other ranks that are one with this rank's, and its owner: the
/// lowest rank with a triangle at it. Throws Error(BadInput) for negative global ids, and for
/// those that are in places apart by more than 1e-5 of the size.
FittedPiece FitPiece(const LoosePiece& loose);
}
