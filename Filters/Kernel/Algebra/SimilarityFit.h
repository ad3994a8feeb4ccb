// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Types.h"

namespace cartan
{
/// The similarity x -> s R x + t, or with `scales` off the rigid motion, that takes the rows
/// of `from` closest to those of `to`, in the least squares (Umeyama, Least-squares Estimation
/// of Transformation Parameters Between Two Point Patterns, 1991): 4 x 4.
Eigen::Matrix4d FitSimilarity(const Points& from, const Points& to, bool scales = true);

/// Whether points determine a similarity: three or more, not on one line up to rounding.
bool SpanPlane(const Points& points);

/// The points after a similarity (4 x 4), or any other affine map.
Points Moved(const Points& points, const Eigen::Matrix4d& motion);
}
