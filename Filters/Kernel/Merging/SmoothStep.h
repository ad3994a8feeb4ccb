// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

namespace cartan
{
/// From 0 at t <= 0 to 1 at t >= 1, smooth at both ends: 3 t^2 - 2 t^3.
inline double SmoothStep(double t)
{
  t = std::min(1.0, std::max(0.0, t));
  return t * t * (3.0 - 2.0 * t);
}
}
