// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/Carriers.h"

#include "Deformation/Riders.h"
#include "Mesh/TriangleShape.h"

#include <cmath>

namespace cartan
{
namespace
{
/// Below this relative height, barycentric coordinates have too few digits.
constexpr double ThinnestCarrier = 1e-6;

/// How far outside of a thin triangle and above it a vertex still lies in it: a part of the
/// triangle.
constexpr double LargestOverhang = 1e-2;
}

double RelativeHeight(const Points& points, const std::array<int, 3>& corners)
{
  const Eigen::Vector3d a = points.row(corners[0]);
  const Eigen::Vector3d b = points.row(corners[1]);
  const Eigen::Vector3d c = points.row(corners[2]);
  return (b - a).cross(c - a).norm() / LongestEdgeSquared(a, b, c);
}

bool CanCarry(const Points& points, const std::array<int, 3>& corners, int vertex)
{
  const double height = RelativeHeight(points, corners);
  if (!(height > ThinnestCarrier))
  {
    return false;
  }
  const Rider rider = MakeRider(points, vertex, corners);
  return height > SmallestCarrier ||
    (rider.Weights.minCoeff() > -LargestOverhang && std::abs(rider.Height) < LargestOverhang);
}
}
