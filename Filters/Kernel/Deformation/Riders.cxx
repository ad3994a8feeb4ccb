// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/Riders.h"

#include "Deformation/HandleProblem.h"

#include <cmath>

namespace cartan
{
namespace
{
/// The area vector, cut to the root of its length: a unit of length that goes with
/// the triangle when it is turned or scaled.
Eigen::Vector3d UnitOfHeight(
  const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
{
  const Eigen::Vector3d areaVector = (b - a).cross(c - a);
  const double size = areaVector.norm();
  return size > 0.0 ? Eigen::Vector3d(areaVector / std::sqrt(size)) : areaVector;
}

}

Rider MakeRider(const Points& points, int vertex, const std::array<int, 3>& corners)
{
  const Eigen::Vector3d a = points.row(corners[0]);
  const Eigen::Vector3d ab = points.row(corners[1]).transpose() - a;
  const Eigen::Vector3d ac = points.row(corners[2]).transpose() - a;
  const Eigen::Vector3d from = points.row(vertex).transpose() - a;
  const Eigen::Vector3d areaVector = ab.cross(ac);
  const double squared = areaVector.squaredNorm();
  const double atB = areaVector.dot(from.cross(ac)) / squared;
  const double atC = areaVector.dot(ab.cross(from)) / squared;
  return { vertex, corners, { 1.0 - atB - atC, atB, atC },
    areaVector.dot(from) / std::pow(squared, 0.75) };
}

void CarryRiders(const std::vector<Rider>& riders, const Points& rest, DeformedSurface& result)
{
  for (auto rider = riders.rbegin(); rider != riders.rend(); ++rider)
  {
    const auto& [a, b, c] = rider->Corners;
    const auto unitOfHeight = [&, a = a, b = b, c = c](const Points& points) -> Eigen::Vector3d
    { return UnitOfHeight(points.row(a), points.row(b), points.row(c)); };
    Points& positions = result.Positions;
    // As a displacement, so that what does not move stays to the last bit.
    Eigen::Vector3d place = rest.row(rider->Vertex);
    place += rider->Height * (unitOfHeight(positions) - unitOfHeight(rest));
    for (int i = 0; i < 3; ++i)
    {
      const int corner = rider->Corners[i];
      place += rider->Weights[i] * (positions.row(corner) - rest.row(corner)).transpose();
    }
    positions.row(rider->Vertex) = place.transpose();
  }
  MeansForRiders(riders, result.Transforms);
  MeansForRiders(riders, result.FrameScale);
}
}
