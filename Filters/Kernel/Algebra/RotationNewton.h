// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace cartan
{
/// Turns a rotation that is near to the one closest to `a`, of norm 1, into that. False where
/// it does not get there, or where two rotations are nearly equally close: `rotation` is any
/// then.
bool ClimbToClosestRotation(const Eigen::Matrix3d& a, Eigen::Matrix3d& rotation);
}
