// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/FilterRun.h"
#include "Bridge/MatchedSurfaces.h"

namespace cartan
{
/// Several surfaces of the same cells in pieces.
struct MatchedPieces
{
  MatchedSurfaces Matched; ///< without Surfaces; warnings are told
  std::shared_ptr<const PieceSurface> Model;
};

/// That number `model` of the surfaces tells which points of several ranks are one, and how many
/// triangles of others each rank needs for `reach`. Collective. Throws on all ranks what
/// ReadMatchedSurfaces throws, or so that the pieces are gathered, where cells are not triangles.
MatchedPieces ReadMatchedPieces(FilterRun& run, const std::vector<vtkPolyData*>& surfaces,
  const std::vector<std::string>& roles, std::size_t model, const VerticesLookedAt& reach,
  const std::string& advice);
}
