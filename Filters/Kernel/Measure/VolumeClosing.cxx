// SPDX-License-Identifier: BSD-3-Clause
#include "Measure/VolumeClosing.h"

#include "Measure/ComponentVolumes.h"
#include "Mesh/Geometry.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cartan
{
namespace
{
/// The relative difference of volumes up to which one counts as closed.
constexpr double ClosingTolerance = 1e-9;

/// c0 + c1 q + c2 q^2 + c3 q^3
using Cubic = std::array<double, 4>;

double Evaluate(const Cubic& cubic, double q)
{
  return cubic[0] + q * (cubic[1] + q * (cubic[2] + q * cubic[3]));
}

/// Volume(x + q u) of each component.
std::vector<Cubic> VolumeCubics(
  const TriangleMesh& mesh, const Points& points, const Points& direction)
{
  // About the centers, which keeps the digits of a component that has gone far.
  const Points origins = ComponentCenters(mesh, points);
  std::vector<Cubic> cubics(mesh.NumberOfComponents(), { 0.0, 0.0, 0.0, 0.0 });
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const int component = mesh.Component(mesh.GetTriangles()(t, 0));
    Eigen::Matrix3d x;
    Eigen::Matrix3d u;
    for (int corner = 0; corner < 3; ++corner)
    {
      x.col(corner) =
        points.row(mesh.GetTriangles()(t, corner)).transpose() - origins.row(component).transpose();
      u.col(corner) = direction.row(mesh.GetTriangles()(t, corner)).transpose();
    }
    auto& cubic = cubics[component];
    const auto determinant = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                               const Eigen::Vector3d& c) { return a.dot(b.cross(c)) / 6.0; };
    cubic[0] += determinant(x.col(0), x.col(1), x.col(2));
    cubic[3] += determinant(u.col(0), u.col(1), u.col(2));
    for (int corner = 0; corner < 3; ++corner)
    {
      const int next = (corner + 1) % 3;
      const int last = (corner + 2) % 3;
      cubic[1] += determinant(u.col(corner), x.col(next), x.col(last));
      cubic[2] += determinant(x.col(corner), u.col(next), u.col(last));
    }
  }
  return cubics;
}

/// Where the cubic has this value, next to 0; 0 if there is no such place.
double NearestRoot(const Cubic& cubic, double value)
{
  if (cubic[1] == 0.0)
  {
    return 0.0;
  }
  double q = 0.0;
  // Newton from 0 finds the nearest root as long as the volume grows with q,
  // which the gradient direction makes sure of near 0.
  for (int round = 0; round < 50; ++round)
  {
    const double error = Evaluate(cubic, q) - value;
    const double slope = cubic[1] + q * (2.0 * cubic[2] + q * 3.0 * cubic[3]);
    if (std::abs(error) <= 1e-15 * std::abs(value) || slope == 0.0)
    {
      break;
    }
    q -= error / slope;
  }
  return std::abs(Evaluate(cubic, q) - value) <= ClosingTolerance * std::abs(value) ? q : 0.0;
}
}

Points VolumeGradient(const TriangleMesh& mesh, const Points& points)
{
  // Of sum a . (b x c) / 6; on a closed surface its derivative by a vertex is a
  // sixth of the sum of the adjacent triangles' doubled area vectors.
  const Points areaVectors = TriangleAreaVectors(points, mesh.GetTriangles());
  Points gradient = Points::Zero(points.rows(), 3);
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    for (int corner = 0; corner < 3; ++corner)
    {
      gradient.row(mesh.GetTriangles()(t, corner)) += areaVectors.row(t) / 6.0;
    }
  }
  return gradient;
}

std::vector<double> VolumeClosingSteps(const TriangleMesh& mesh, const Points& points,
  const Points& direction, const std::vector<char>& takesPart, const std::vector<double>& volumes)
{
  const std::vector<Cubic> cubics = VolumeCubics(mesh, points, direction);
  std::vector<double> steps(mesh.NumberOfComponents(), 0.0);
  for (int c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    steps[c] = takesPart[c] ? NearestRoot(cubics[c], volumes[c]) : 0.0;
  }
  return steps;
}

IdSample CloseVolumes(const TriangleMesh& mesh, const std::vector<char>& takesPart,
  const std::vector<double>& volumes, const std::function<Points(const Points&)>& solve,
  Points& positions)
{
  const Points direction = solve(VolumeGradient(mesh, positions));
  const std::vector<double> steps =
    VolumeClosingSteps(mesh, positions, direction, takesPart, volumes);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v) && steps[mesh.Component(v)] != 0.0)
    {
      positions.row(v) += steps[mesh.Component(v)] * direction.row(v);
    }
  }
  IdSample notClosed;
  bool isAnyOpen = false;
  for (std::size_t c = 0; c < steps.size(); ++c)
  {
    isAnyOpen = isAnyOpen || (takesPart[c] && steps[c] == 0.0);
  }
  if (isAnyOpen)
  {
    const std::vector<ComponentVolume> components = MeasureComponents(mesh, positions);
    for (std::size_t c = 0; c < steps.size(); ++c)
    {
      const double error = std::abs(components[c].Volume - volumes[c]);
      if (takesPart[c] && !(error <= ClosingTolerance * std::abs(volumes[c])))
      {
        notClosed.Add(static_cast<long long>(c));
      }
    }
  }
  return notClosed;
}
}
