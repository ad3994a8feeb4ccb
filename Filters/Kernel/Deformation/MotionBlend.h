// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/HandleProblem.h"

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

  /// `weights` has one entry per motion.
  Eigen::Matrix3d At(const double* weights) const;

private:
  std::vector<Eigen::Vector3d> RotationVectors;
  std::vector<Eigen::Matrix3d> Stretches; ///< S_k - I
  bool HasStretches = false;
};
}
