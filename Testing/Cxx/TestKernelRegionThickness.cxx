// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Deformation/RegionThickness.h"

#include "TestShapes.h"

#include <gtest/gtest.h>

using cartan::RegionThickness;
using shapes::Shape;

namespace
{
/// Of the vertices that `isInside` says yes to; all triangles at them count.
template <typename IsInside>
double ThicknessOf(const Shape& shape, const IsInside& isInside)
{
  std::vector<char> inside;
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    inside.push_back(isInside(Eigen::Vector3d(shape.Positions.row(v))) ? 1 : 0);
  }
  return RegionThickness(
    cartan::TriangleMesh(shape.NumberOfVertices(), shape.Faces), shape.Positions, inside);
}

bool All(const Eigen::Vector3d&)
{
  return true;
}

TEST(RegionThickness, BarsAreAsThickAsTheirSides)
{
  for (const double length : { 6.0, 12.0 })
  {
    const Shape bar = shapes::Bar(20, 20, 120, { 1.0, 1.0, length });
    const auto isMiddle = [length](const Eigen::Vector3d& p)
    { return p.z() > 0.15 * length && p.z() < 0.85 * length; };
    EXPECT_NEAR(ThicknessOf(bar, isMiddle), 1.0, 1e-12);
    EXPECT_NEAR(ThicknessOf(shapes::Inverted(bar), isMiddle), 1.0, 1e-12);
    // Both ends count as well: 4 V / A.
    EXPECT_NEAR(ThicknessOf(bar, All), 4.0 * length / (4.0 * length + 2.0), 1e-12);
    // Two parts of one body, of two bodies, and of two that show different sides.
    const auto areTwo = [&](const Eigen::Vector3d& p)
    { return isMiddle(p) && std::abs(p.z() - 0.5 * length) > 0.1 * length; };
    EXPECT_NEAR(ThicknessOf(bar, areTwo), 1.0, 1e-12);
    Shape far = bar;
    far.Positions.rowwise() += Eigen::RowVector3d(1e4, 2e4, 0.0);
    EXPECT_NEAR(ThicknessOf(shapes::Union(bar, far), isMiddle), 1.0, 1e-7);
    EXPECT_NEAR(ThicknessOf(shapes::Union(bar, shapes::Inverted(far)), isMiddle), 1.0, 1e-7);
  }
}

TEST(RegionThickness, TubesAreAsThickAsTheirDiameters)
{
  // Open at both ends: as if they were closed. A polygon of n sides has 2 cos(pi / n) of
  // the radius.
  const Shape tube = shapes::OpenCylinder(40, 60, 0.5, 6.0);
  EXPECT_NEAR(ThicknessOf(tube, All), std::cos(shapes::Pi / 40.0), 1e-12);
  const Shape sphere = shapes::Icosphere(4, 3.0);
  EXPECT_NEAR(ThicknessOf(sphere, All), 4.0, 0.02);
}

TEST(RegionThickness, SheetsAreSixEdgesThick)
{
  const Shape plane = shapes::Plane(20, 4.0);
  const double edge = std::sqrt((0.04 + 0.04 + 0.08) / 3.0);
  EXPECT_NEAR(ThicknessOf(plane, All), 6.0 * edge, 1e-12);
  const auto isRing = [](const Eigen::Vector3d& p)
  { return p.head<2>().norm() > 0.5 && p.head<2>().norm() < 1.5; };
  EXPECT_NEAR(ThicknessOf(plane, isRing), 6.0 * edge, 1e-12);
  EXPECT_EQ(ThicknessOf(plane, [](const Eigen::Vector3d&) { return false; }), 0.0);
}
}
