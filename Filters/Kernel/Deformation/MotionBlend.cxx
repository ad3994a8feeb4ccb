// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/MotionBlend.h"

#include "Algebra/Rotation.h"

namespace cartan
{
MotionBlend::MotionBlend(const std::vector<HandleMotion>& motions)
{
  for (const HandleMotion& motion : motions)
  {
    this->RotationVectors.push_back(motion.RotationVector);
    this->Stretches.emplace_back(
      RotationFromVector(motion.RotationVector).transpose() * motion.Linear -
      Eigen::Matrix3d::Identity());
    this->HasStretches = this->HasStretches || !this->Stretches.back().isZero(1e-12);
  }
}

Eigen::Matrix3d MotionBlend::At(const double* weights) const
{
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < this->RotationVectors.size(); ++k)
  {
    vector += weights[k] * this->RotationVectors[k];
  }
  const Eigen::Matrix3d rotation = RotationFromVector(vector);
  if (!this->HasStretches)
  {
    return rotation;
  }
  Eigen::Matrix3d stretch = Eigen::Matrix3d::Identity();
  for (std::size_t k = 0; k < this->Stretches.size(); ++k)
  {
    stretch += weights[k] * this->Stretches[k];
  }
  return rotation * stretch;
}
}
