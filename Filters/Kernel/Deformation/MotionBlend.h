// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/HandleProblem.h"

#include <string>

namespace cartan
{
/// Weighted means of handles' linear maps and the identity. Each map A is split
/// into its rotation R = exp(r), with the rotation vector r as the user gave
/// it, full turns included, and the remainder S = R^-1 A; the mean is
///
///   exp(sum w_k r_k) (I + sum w_k (S_k - I)).
///
/// The angle is exact if all rotations share an axis.
class MotionBlend
{
public:
  explicit MotionBlend(const std::vector<HandleMotion>& motions);

  /// What is blended, r_k and, unless all are zero, the entries of S_k - I:
  /// #motions x 3 or 12.
  Field Coordinates() const;

  /// The mean from the blend of the coordinates.
  using Blend = Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, 12>;
  static Eigen::Matrix3d FromCoordinates(const Blend& blend);

private:
  std::vector<Eigen::Vector3d> RotationVectors;
  std::vector<Eigen::Matrix3d> Stretches; ///< S_k - I
  bool HasStretches = false;
};

/// Throws Error(BadInput) for targets that are not one motion per handle.
void RequireMotions(const HandleTargets& targets, const std::string& method);
}
