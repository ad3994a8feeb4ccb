// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/FilterRun.h"
#include "Bridge/SelectionReader.h"

namespace cartan
{
/// Throws, so that pieces are gathered, where points are held together (JoinedPoints).
/// Collective.
void RequireNoJoinedPoints(FilterRun& run);

/// Marks what so many rings of neighbors of the marked points reach on all pieces. Collective.
void GrowOverPieces(FilterRun& run, int rings, PointMask& mask);
}
