// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Invariants.h"

namespace fuzz
{
/// Invariants of filters that are steered by landmarks, curves or a surface:
/// - carried: points on the surface go to its points, and all with a rigid motion of it,
/// - landmarks: each point's target is off by what its landmark moves, and a deformation
///   meets it within the accuracy,
/// - drawn: a curve that is its path, shifted, shifts what hangs on it.
std::vector<Invariant> SteeringLaws();
}
