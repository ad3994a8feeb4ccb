// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Types.h"

#include <array>

namespace cartan
{
/// The least RelativeHeight of a triangle that can carry any rider (see Rider).
constexpr double SmallestCarrier = 1e-2;

/// Twice the area in parts of the longest edge squared.
double RelativeHeight(const Points& points, const std::array<int, 3>& corners);

/// Whether a triangle can carry a vertex: one of SmallestCarrier any, a thinner one what lies
/// in it, which then is a mean of the corners.
bool CanCarry(const Points& points, const std::array<int, 3>& corners, int vertex);
}
