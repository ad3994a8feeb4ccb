// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <vector>

namespace cartan
{
/// The rotation closest to A in the Frobenius norm: the orthogonal factor of
/// the polar decomposition, and where det A < 0 the closest one of determinant
/// +1 (the direction of the smallest singular value is flipped). Where several
/// are equally close (rank below two) one of them; the identity for A = 0.
Eigen::Matrix3d ProjectOnRotations(const Eigen::Matrix3d& a);

/// The same from a rotation that is near it, such as that of the iterate before:
/// as exact, and several times faster for the matrices that surfaces make, whose
/// smallest singular value is next to zero. The result does not depend on
/// `guess` beyond rounding; a poor one costs time only.
Eigen::Matrix3d ProjectOnRotations(const Eigen::Matrix3d& a, const Eigen::Matrix3d& guess);

/// The rotation about the axis of `rotationVector` by its length in radians,
/// of any size.
Eigen::Matrix3d RotationFromVector(const Eigen::Vector3d& rotationVector);

/// Whether rotation vectors are all parallel, to a microradian (above what
/// users' numbers and Euler angles round to); zero vectors fit any axis. Sets
/// the unit axis, that of the longest; the x axis if all are zero.
bool FindSharedAxis(const std::vector<Eigen::Vector3d>& rotationVectors, Eigen::Vector3d& axis);

/// Axis times angle in radians, the angle in [0, pi]. Accurate near 0 and pi;
/// at pi one of the two opposite axes.
Eigen::Vector3d VectorFromRotation(const Eigen::Matrix3d& rotation);

/// Of the rotation vectors that mean this rotation, whole turns about its axis
/// apart, the one nearest to `guess`: of any length.
Eigen::Vector3d VectorFromRotation(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& guess);
}
