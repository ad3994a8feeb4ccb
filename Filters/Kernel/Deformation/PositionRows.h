// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

namespace cartan
{
/// Positions that are sums over kept fields, computed where they are used: writes those of a
/// range of vertices, three numbers each. Several threads may ask at once. Ranges as long as
/// PositionBlock stay in the processor's cache.
using PositionRows = std::function<void(int begin, int end, double* rows)>;

constexpr int PositionBlock = 512;
}
