// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Invariants.h"

namespace fuzz
{
/// Invariants of the filters that sew surfaces together:
/// - stokes: the area vectors of lids on the loops and of the triangles add up to zero,
/// - independent: where the source lies, how it is turned and how large it is changes
///   nothing,
/// - sewn: the result is a manifold, and the target keeps its place,
/// - strength: a coating that is twice as strong moves points twice as far.
std::vector<Invariant> MergeLaws();
}
