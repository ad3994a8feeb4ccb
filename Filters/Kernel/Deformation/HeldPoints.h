// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Types.h"

#include <Eigen/Eigenvalues>

#include <vector>

namespace cartan
{
/// Whether points are not all in one plane. An affine map that keeps held
/// positions costs nothing, so they must leave only the identity.
inline bool SpansSpace(const Points& rest, const std::vector<int>& vertices)
{
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const int v : vertices)
  {
    mean += rest.row(v).transpose() / static_cast<double>(vertices.size());
  }
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const int v : vertices)
  {
    const Eigen::Vector3d difference = rest.row(v).transpose() - mean;
    moments += difference * difference.transpose();
  }
  const Eigen::Vector3d eigenvalues =
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments, Eigen::EigenvaluesOnly).eigenvalues();
  return eigenvalues[0] > 1e-10 * eigenvalues[2];
}
}
