// SPDX-License-Identifier: BSD-3-Clause
#include "Deformed.h"

#include <cmath>

namespace fuzz
{
std::vector<Eigen::Vector3d> Deformed(const std::vector<Eigen::Vector3d>& points, Random& random)
{
  const double size = Size(points);
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points)
  {
    center = point.allFinite() ? point : center;
  }
  const Eigen::Matrix3d frame = random.Rotation();
  const double bend = random.Real(-3.0, 3.0);
  const double stretch = random.Chance(0.5) ? 1.0 : random.Log(0.6, 1.7);
  const Motion motion{ 1.0, random.Rotation(), center + size * random.Vector() };
  std::vector<Eigen::Vector3d> deformed;
  for (const Eigen::Vector3d& point : points)
  {
    const Eigen::Vector3d x = frame * (point - center) / size;
    const double angle = bend * x.x();
    const Eigen::Vector3d turned(stretch * x.x(), std::cos(angle) * x.y() - std::sin(angle) * x.z(),
      std::sin(angle) * x.y() + std::cos(angle) * x.z());
    deformed.push_back(motion(size * turned));
  }
  return deformed;
}
}
