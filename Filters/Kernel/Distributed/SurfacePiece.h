// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Ranks.h"

#include <memory>

namespace cartan
{
/// The part of a surface that one rank holds: its own points, all triangles around them,
/// and copies (*ghosts*) of the other points of these. More triangles and ghosts do no harm.
/// A rank may have nothing.
struct SurfacePiece
{
  std::shared_ptr<const Ranks> Group;
  Points Positions;                    ///< #P x 3, owned points and ghosts in any order
  Triangles Corners;                   ///< #T x 3, rows of Positions
  std::vector<std::int64_t> GlobalIds; ///< #P, >= 0: the same on all ranks, no two alike on one
  std::vector<int> Owners;             ///< #P, the rank that owns the point: one for each
};
}
