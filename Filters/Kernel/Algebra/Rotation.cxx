// SPDX-License-Identifier: BSD-3-Clause
#include "Algebra/Rotation.h"

#include "Algebra/RotationNewton.h"
#include "Base/Constants.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
Eigen::Matrix3d ProjectBySingularValues(const Eigen::Matrix3d& a)
{
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0.0)
  {
    u.col(2) = -u.col(2);
  }
  return u * svd.matrixV().transpose();
}

/// The transposed inverse times the determinant.
Eigen::Matrix3d Cofactors(const Eigen::Matrix3d& a)
{
  Eigen::Matrix3d cofactors;
  cofactors.col(0) = a.col(1).cross(a.col(2));
  cofactors.col(1) = a.col(2).cross(a.col(0));
  cofactors.col(2) = a.col(0).cross(a.col(1));
  return cofactors;
}

}

Eigen::Matrix3d ProjectOnRotations(const Eigen::Matrix3d& a)
{
  const double size = a.norm();
  if (!(size > 0.0))
  {
    return Eigen::Matrix3d::Identity();
  }
  // Newton's iteration X <- (g X + X^-T / g) / 2 for the polar factor, with the
  // scaling g of Higham, Computing the Polar Decomposition, 1986. It converges
  // quadratically and costs a few cross products a step, a tenth of a singular
  // value decomposition, which stays for the matrices it cannot treat: those
  // that are singular or turn the space inside out.
  Eigen::Matrix3d x = a / size;
  for (int step = 0; step < 20; ++step)
  {
    const Eigen::Matrix3d cofactors = Cofactors(x);
    const double determinant = x.col(0).dot(cofactors.col(0));
    // Inverting a matrix that is closer to singular would lose more than the
    // last three digits.
    if (determinant < 1e-3)
    {
      break;
    }
    // |X^-1| / |X| = |cofactors| / (det |X|).
    const double scale =
      std::sqrt(std::sqrt(cofactors.squaredNorm() / x.squaredNorm()) / determinant);
    const Eigen::Matrix3d next = (0.5 * scale) * x + (0.5 / (scale * determinant)) * cofactors;
    const double change = (next - x).squaredNorm();
    x = next;
    // The error after a step is about the square of the change before it.
    if (change < 1e-15)
    {
      return x;
    }
  }
  return ProjectBySingularValues(a / size);
}

Eigen::Matrix3d ProjectOnRotations(const Eigen::Matrix3d& a, const Eigen::Matrix3d& guess)
{
  const double size = a.norm();
  if (!(size > 1e-300)) // its inverse would overflow
  {
    return ProjectOnRotations(a);
  }
  const Eigen::Matrix3d scaled = (1.0 / size) * a;
  Eigen::Matrix3d rotation = guess;
  return ClimbToClosestRotation(scaled, rotation) ? rotation : ProjectOnRotations(a);
}

Eigen::Matrix3d RotationFromVector(const Eigen::Vector3d& rotationVector)
{
  const double angle = rotationVector.norm();
  return angle > 0.0 ? Eigen::AngleAxisd(angle, rotationVector / angle).toRotationMatrix()
                     : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

bool FindSharedAxis(const std::vector<Eigen::Vector3d>& rotationVectors, Eigen::Vector3d& axis)
{
  axis.setZero();
  for (const Eigen::Vector3d& vector : rotationVectors)
  {
    if (vector.squaredNorm() > axis.squaredNorm())
    {
      axis = vector;
    }
  }
  if (axis.isZero(0.0))
  {
    axis = Eigen::Vector3d::UnitX();
    return true;
  }
  axis.normalize();
  return std::all_of(rotationVectors.begin(), rotationVectors.end(),
    [&axis](const Eigen::Vector3d& vector)
    { return vector.cross(axis).norm() <= 1e-6 * vector.norm(); });
}

Eigen::Vector3d VectorFromRotation(const Eigen::Matrix3d& rotation)
{
  // Through the quaternion, whose conversion from a matrix is accurate for all
  // angles; AngleAxis takes the half angle from atan2.
  Eigen::Quaterniond quaternion(rotation);
  quaternion.normalize();
  const Eigen::AngleAxisd angleAxis(quaternion);
  return angleAxis.angle() * angleAxis.axis();
}

Eigen::Vector3d VectorFromRotation(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& guess)
{
  const Eigen::Vector3d vector = VectorFromRotation(rotation);
  const double angle = vector.norm();
  // No turn has any axis.
  const Eigen::Vector3d axis = angle > 0.0 ? Eigen::Vector3d(vector / angle) : guess.normalized();
  return (angle + FullTurn * std::round((guess.dot(axis) - angle) / FullTurn)) * axis;
}
}
