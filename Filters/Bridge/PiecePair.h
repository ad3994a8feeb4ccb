// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/FilterRun.h"
#include "Bridge/SurfacePair.h"

namespace cartan
{
/// The surface on port 0 and its reference on port 1, both in pieces, with so many triangles of
/// other ranks that owned vertices see all that they look at in the reference. The reference
/// tells which points are one. Collective. Throws on all ranks what ReadMatchedSurfaces throws,
/// or so that the pieces are gathered, where cells are not triangles.
SurfacePair ReadPiecePair(FilterRun& run, const VerticesLookedAt& reach, const std::string& advice);
}
