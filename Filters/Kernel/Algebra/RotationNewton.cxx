// SPDX-License-Identifier: BSD-3-Clause
#include "Algebra/RotationNewton.h"

#include <cmath>

namespace cartan
{
namespace
{
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

bool ClimbToClosestRotation(const Eigen::Matrix3d& a, Eigen::Matrix3d& rotation)
{
  TraceStep newton;
  for (int step = 0; step < 6 && newton.Find(rotation.transpose() * a); ++step)
  {
    rotation = rotation * RotationFromQuaternionVector(newton.Half);
    // The cube of the step over a lower bound of H's smallest eigenvalue.
    const double squaredHalf = SquaredLength(newton.Half);
    if (8.0 * squaredHalf * std::sqrt(squaredHalf) < 1e-16 * newton.Determinant)
    {
      // The products of many updates drift off the rotations by rounding: a
      // step of R <- R (3 I - R^T R) / 2 takes them back.
      rotation =
        rotation * (1.5 * Eigen::Matrix3d::Identity() - 0.5 * (rotation.transpose() * rotation));
      return true;
    }
  }
  return false;
}
}
