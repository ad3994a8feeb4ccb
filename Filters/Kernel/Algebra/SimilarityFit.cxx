// SPDX-License-Identifier: BSD-3-Clause
#include "Algebra/SimilarityFit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace cartan
{
Eigen::Matrix4d FitSimilarity(const Points& from, const Points& to, bool scales)
{
  return Eigen::umeyama(
    Eigen::Matrix3Xd(from.transpose()), Eigen::Matrix3Xd(to.transpose()), scales);
}

bool SpanPlane(const Points& points)
{
  if (points.rows() < 3)
  {
    return false;
  }
  const Points centered = points.rowwise() - Eigen::RowVector3d(points.colwise().mean());
  const Eigen::Vector3d squares =
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(centered.transpose() * centered).eigenvalues();
  // Squares of extents, so that rounding is below this part.
  return squares[1] > 1e-14 * squares[2];
}

Points Moved(const Points& points, const Eigen::Matrix4d& motion)
{
  return (points * motion.topLeftCorner<3, 3>().transpose()).rowwise() +
    motion.topRightCorner<3, 1>().transpose();
}
}
