// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/MotionBlend.h"

#include "Algebra/Rotation.h"
#include "Base/Error.h"

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

Field MotionBlend::Coordinates() const
{
  const auto count = static_cast<Eigen::Index>(this->RotationVectors.size());
  Field coordinates(count, this->HasStretches ? 12 : 3);
  for (Eigen::Index k = 0; k < count; ++k)
  {
    coordinates.row(k).head<3>() = this->RotationVectors[k].transpose();
    if (this->HasStretches)
    {
      Eigen::Map<Eigen::Matrix3d>(coordinates.row(k).data() + 3) = this->Stretches[k];
    }
  }
  return coordinates;
}

Eigen::Matrix3d MotionBlend::FromCoordinates(const Blend& blend)
{
  const Eigen::Matrix3d rotation = RotationFromVector(blend.head<3>().transpose());
  if (blend.size() == 3)
  {
    return rotation;
  }
  return rotation *
    (Eigen::Matrix3d::Identity() + Eigen::Map<const Eigen::Matrix3d>(blend.data() + 3));
}

void RequireMotions(const HandleTargets& targets, const std::string& method)
{
  if (targets.IsPerVertex() || targets.RotationVectors.rows())
  {
    throw Error(ErrorCode::BadInput,
      method +
        " interpolates one motion per handle, not arrays of positions, rotations or "
        "transforms: give each handle a motion, or choose another method.");
  }
}
}
