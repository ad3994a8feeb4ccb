// SPDX-License-Identifier: BSD-3-Clause
#include "Algebra/ClosestRotation.h"

#include "Algebra/Rotation.h"
#include "Algebra/RotationNewton.h"

#include <Eigen/LU>
#include <Eigen/SVD>

#include <cmath>

namespace cartan
{
bool HasClosestRotation(const Eigen::Matrix3d& a)
{
  const double size = a.norm();
  if (!(size > 0.0))
  {
    return false;
  }
  const Eigen::Matrix3d scaled = a / size;
  const double determinant = scaled.determinant();
  if (determinant > 1e-3) // the product of the singular values, which are at most 1
  {
    return true;
  }
  const Eigen::Vector3d values = Eigen::JacobiSVD<Eigen::Matrix3d>(scaled).singularValues();
  return values[1] + std::copysign(values[2], determinant) > 1e-9 * values[0];
}

Eigen::Matrix3d ClosestRotationOrNone(const Eigen::Matrix3d& transform)
{
  constexpr double crushed = 1e-9;
  return transform.norm() > crushed && HasClosestRotation(transform)
    ? ProjectOnRotations(transform)
    : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

Eigen::Matrix3d ClosestRotationNear(const Eigen::Matrix3d& a, const Eigen::Matrix3d& guess)
{
  const double size = a.norm();
  if (!(size > 1e-300)) // its inverse would overflow
  {
    return guess;
  }
  const Eigen::Matrix3d scaled = (1.0 / size) * a;
  Eigen::Matrix3d rotation = guess;
  if (ClimbToClosestRotation(scaled, rotation))
  {
    return rotation;
  }
  if (HasClosestRotation(scaled))
  {
    return ProjectOnRotations(scaled);
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(scaled, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d from = guess * svd.matrixV().col(0);
  const Eigen::Vector3d to = svd.matrixU().col(0);
  return Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix() * guess;
}
}
