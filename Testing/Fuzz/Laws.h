// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Invariants.h"

namespace fuzz
{
/// Invariants of single filters:
/// - common: handles that move together, rigidly, take the surface with them; a morph
///   between surfaces that differ by a rigid motion is rigid,
/// - caps: thin triangles added leave the other points where they were,
/// - keys: a morph meets its key frames,
/// - roundtrip: the forms of a surface give the surface back,
/// - joined: copies of a point that are joined stay together,
/// - prepared: what Prepare Surface makes is accepted,
/// - restored: Restore Surface of what did not move is the original.
std::vector<Invariant> Laws();
}
