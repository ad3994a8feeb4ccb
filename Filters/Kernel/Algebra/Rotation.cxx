// SPDX-License-Identifier: BSD-3-Clause
#include "Algebra/Rotation.h"

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

/// The sum of squares from the first to the last, in this order.
double SquaredLength(const Eigen::Vector3d& v)
{
  return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

/// Newton's method on f(R) = trace(R^T A), which the closest rotation maximizes.
/// With M = R^T A and R turned on by a rotation vector v,
///
///   f(R exp v) = trace M + g.v - v.H v / 2 + ...,
///   g = (M32 - M23, M13 - M31, M21 - M12),  H = trace(M) I - (M + M^T) / 2.
///
/// Where g = 0, M is symmetric, and f has no maximum but the largest: H is
/// positive definite there and nowhere else. So a step that is tiny where H is
/// positive definite proves the result. The third derivative along v vanishes
/// with M - M^T: the error after a step is about the cube of the step.
struct TraceStep
{
  Eigen::Vector3d Half = Eigen::Vector3d::Zero(); ///< of the step H^-1 g
  double Determinant = 0.0;                       ///< of H

  /// False where H is not positive definite, or so little that two rotations are
  /// nearly equally close: decomposition tells better which is closest.
  bool Find(const Eigen::Matrix3d& m)
  {
    const double trace = m.trace();
    const double h00 = trace - m(0, 0);
    const double h11 = trace - m(1, 1);
    const double h22 = trace - m(2, 2);
    const double h01 = -0.5 * (m(0, 1) + m(1, 0));
    const double h02 = -0.5 * (m(0, 2) + m(2, 0));
    const double h12 = -0.5 * (m(1, 2) + m(2, 1));
    const double c00 = h11 * h22 - h12 * h12;
    const double c01 = h02 * h12 - h01 * h22;
    const double c02 = h01 * h12 - h02 * h11;
    const double c11 = h00 * h22 - h02 * h02;
    const double c12 = h01 * h02 - h00 * h12;
    const double c22 = h00 * h11 - h01 * h01;
    this->Determinant = h00 * c00 + h01 * c01 + h02 * c02;
    if (!(trace > 0.0 && h00 > 0.0 && c22 > 0.0 && this->Determinant > 1e-6))
    {
      return false;
    }
    const Eigen::Vector3d g(m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1));
    const double scale = 0.5 / this->Determinant;
    this->Half = { scale * (c00 * g[0] + c01 * g[1] + c02 * g[2]),
      scale * (c01 * g[0] + c11 * g[1] + c12 * g[2]),
      scale * (c02 * g[0] + c12 * g[1] + c22 * g[2]) };
    return true;
  }
};

/// The rotation of the quaternion whose scalar is one and whose vector is `half`,
/// which is about half of its rotation vector.
Eigen::Matrix3d RotationFromQuaternionVector(const Eigen::Vector3d& half)
{
  const double x = half[0];
  const double y = half[1];
  const double z = half[2];
  const double s = 2.0 / (1.0 + SquaredLength(half));
  Eigen::Matrix3d turn;
  turn << 1.0 - s * (y * y + z * z), s * (x * y - z), s * (x * z + y), //
    s * (x * y + z), 1.0 - s * (x * x + z * z), s * (y * z - x),       //
    s * (x * z - y), s * (y * z + x), 1.0 - s * (x * x + y * y);
  return turn;
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
  TraceStep newton;
  for (int step = 0; step < 6 && newton.Find(rotation.transpose() * scaled); ++step)
  {
    rotation = rotation * RotationFromQuaternionVector(newton.Half);
    // The cube of the step over a lower bound of H's smallest eigenvalue.
    const double squaredHalf = SquaredLength(newton.Half);
    if (8.0 * squaredHalf * std::sqrt(squaredHalf) < 1e-16 * newton.Determinant)
    {
      // The products of many updates drift off the rotations by rounding: a
      // step of R <- R (3 I - R^T R) / 2 takes them back.
      return rotation *
        (1.5 * Eigen::Matrix3d::Identity() - 0.5 * (rotation.transpose() * rotation));
    }
  }
  return ProjectOnRotations(a);
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
