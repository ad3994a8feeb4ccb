// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace cartan
{
/// Whether one rotation is the closest to A (see ProjectOnRotations) also when A changes by
/// rounding: the two smaller singular values, the last with the sign of det A, add up to
/// more than 1e-9 of the largest. Not so where A turns the space inside out evenly, as -I,
/// or leaves a line or nothing of it.
bool HasClosestRotation(const Eigen::Matrix3d& a);

/// The rotation closest to a transform; the identity where several are equally close, or
/// less than 1e-9 is left of lengths, so that rounding does not choose.
Eigen::Matrix3d ClosestRotationOrNone(const Eigen::Matrix3d& transform);

/// The rotation closest to A where rounding does not choose it (HasClosestRotation), and else,
/// of those that are about equally close, the one nearest to `guess`: all of them take the
/// first right singular vector of A to the first left one, so it is the guess turned on by the
/// least turn that does. As fast as ProjectOnRotations from a guess.
Eigen::Matrix3d ClosestRotationNear(const Eigen::Matrix3d& a, const Eigen::Matrix3d& guess);
}
