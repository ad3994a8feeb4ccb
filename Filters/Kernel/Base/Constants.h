// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace cartan
{
constexpr double Pi = 3.14159265358979323846;
constexpr double FullTurn = 2.0 * Pi; ///< in radians
}
