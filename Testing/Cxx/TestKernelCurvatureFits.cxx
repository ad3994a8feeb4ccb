// SPDX-License-Identifier: BSD-3-Clause
// Curvatures of what is deformed from a kept reference.
#include "Kernel/Differential/Curvature.h"

#include "TestShapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

using namespace cartan;

namespace
{
std::shared_ptr<const TriangleMesh> MeshOf(const shapes::Shape& shape)
{
  return std::make_shared<const TriangleMesh>(shape.NumberOfVertices(), shape.Faces);
}

using Map = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

Points Mapped(const Points& points, const Map& map)
{
  Points images(points.rows(), 3);
  for (Eigen::Index v = 0; v < points.rows(); ++v)
  {
    images.row(v) = map(points.row(v).transpose()).transpose();
  }
  return images;
}

/// From the plane around the origin, isometric.
Eigen::Vector3d RollToCylinder(const Eigen::Vector3d& p, double radius)
{
  const double angle = p[0] / radius;
  return { radius * std::sin(angle), p[1], radius * (std::cos(angle) - 1.0) };
}

/// From the plane, isometric: distances from (-2, 0) are those from the apex, and angles about it
/// grow by two.
Eigen::Vector3d RollToCone(const Eigen::Vector3d& p)
{
  const double distance = std::hypot(p[0] + 2.0, p[1]);
  const double angle = 2.0 * std::atan2(p[1], p[0] + 2.0);
  return { 0.5 * distance * std::cos(angle), 0.5 * distance * std::sin(angle),
    -std::sqrt(0.75) * distance };
}

/// By angles, not isometric: along the meridians only.
Eigen::Vector3d BendToSphere(const Eigen::Vector3d& p)
{
  return { std::sin(p[0]) * std::cos(p[1]), std::sin(p[1]), std::cos(p[0]) * std::cos(p[1]) };
}

Eigen::Vector3d BendToTorus(const Eigen::Vector3d& p)
{
  const double around = 2.0 + 0.7 * std::cos(p[1] / 0.7);
  return { around * std::sin(p[0] / 2.7), 0.7 * std::sin(p[1] / 0.7),
    around * std::cos(p[0] / 2.7) };
}

/// Of waist 1, conformal.
Eigen::Vector3d BendToCatenoid(const Eigen::Vector3d& p)
{
  return { std::cosh(p[1]) * std::sin(p[0]), p[1], std::cosh(p[1]) * std::cos(p[0]) };
}

Eigen::Vector3d Wave(const Eigen::Vector3d& p)
{
  return p +
    0.1 *
    Eigen::Vector3d(std::sin(1.3 * p[1]), std::cos(1.1 * p[2] + 0.4), std::sin(1.2 * p[0] + 0.3));
}

struct PrincipalCurvatures
{
  double Maximum;
  double Minimum;
};

/// The largest error of the principal curvatures, relative to the larger of them.
double LargestError(const Curvatures& curvatures, const Points& reference,
  const std::function<PrincipalCurvatures(const Eigen::Vector3d&)>& exact)
{
  double largest = 0.0;
  for (Eigen::Index v = 0; v < reference.rows(); ++v)
  {
    const PrincipalCurvatures expected = exact(reference.row(v).transpose());
    const double size = std::max(std::abs(expected.Maximum), std::abs(expected.Minimum));
    largest = std::max({ largest, std::abs(curvatures.Maximum[v] - expected.Maximum) / size,
      std::abs(curvatures.Minimum[v] - expected.Minimum) / size });
  }
  return largest;
}

/// The largest difference of principal curvatures, times a length.
double LargestDifference(const Curvatures& a, const Curvatures& b, double length)
{
  return length *
    std::max(
      (a.Maximum - b.Maximum).cwiseAbs().maxCoeff(), (a.Minimum - b.Minimum).cwiseAbs().maxCoeff());
}
}

TEST(CurvatureFits, OfTheReferenceIsFitCurvatures)
{
  for (const shapes::Shape& shape : { shapes::Torus(24, 16), shapes::UvSphere(60, 20, 2.0),
         shapes::OpenCylinder(6, 5), shapes::OpenCylinder(30, 1), shapes::Saddle(12, 2.0, 0.3),
         shapes::Bar(3, 3, 9, { 1.0, 1.0, 3.0 }), shapes::Icosphere(0) })
  {
    const Curvatures expected = FitCurvatures(*MeshOf(shape), shape.Positions);
    const Curvatures found = CurvatureFits(MeshOf(shape), shape.Positions).Measure(shape.Positions);
    EXPECT_LT(LargestDifference(expected, found, 1.0), 1e-7);
    EXPECT_EQ(expected.States, found.States);
  }
}

TEST(CurvatureFits, RolledAndBentPlanesHaveTheirClosedFormulas)
{
  for (const double jitter : { 0.0, 0.3 })
  {
    const shapes::Shape plane = shapes::Plane(24, 0.8, jitter);
    const auto mesh = MeshOf(plane);
    const CurvatureFits fits(mesh, plane.Positions);
    const auto error =
      [&](const Map& map, const std::function<PrincipalCurvatures(const Eigen::Vector3d&)>& exact)
    {
      const Points current = Mapped(plane.Positions, map);
      const double found = LargestError(fits.Measure(current), plane.Positions, exact);
      // The same fit, from another start.
      EXPECT_LT(
        found, 1.02 * LargestError(FitCurvatures(*mesh, current), plane.Positions, exact) + 1e-5);
      return found;
    };
    for (const double radius : { 100.0, 1.0, 0.3 })
    {
      EXPECT_LT(error([&](const Eigen::Vector3d& p) { return RollToCylinder(p, radius); },
                  [&](const Eigen::Vector3d&) {
                    return PrincipalCurvatures{ 1.0 / radius, 0.0 };
                  }),
        1e-3);
    }
    EXPECT_LT(error(RollToCone,
                [](const Eigen::Vector3d& p) {
                  return PrincipalCurvatures{ std::sqrt(3.0) / std::hypot(p[0] + 2.0, p[1]), 0.0 };
                }),
      0.05);
    EXPECT_LT(error(BendToSphere,
                [](const Eigen::Vector3d&) {
                  return PrincipalCurvatures{ 1.0, 1.0 };
                }),
      1e-5);
    EXPECT_LT(error(BendToTorus,
                [](const Eigen::Vector3d& p)
                {
                  const double cosine = std::cos(p[1] / 0.7);
                  return PrincipalCurvatures{ 1.0 / 0.7, cosine / (2.0 + 0.7 * cosine) };
                }),
      0.05);
    EXPECT_LT(error(BendToCatenoid,
                [](const Eigen::Vector3d& p)
                {
                  const double curvature = 1.0 / (std::cosh(p[1]) * std::cosh(p[1]));
                  return PrincipalCurvatures{ curvature, -curvature };
                }),
      0.05);
  }
}

TEST(CurvatureFits, AgreeWithFitsToPointsOfTheSurfaceItself)
{
  // Wherever both choose the same points, which regular grids make them do.
  const shapes::Shape torus = shapes::Torus(60, 30);
  const CurvatureFits fits(MeshOf(torus), torus.Positions);
  const Points waved = Mapped(torus.Positions, Wave);
  const Curvatures expected = FitCurvatures(*MeshOf(torus), waved);
  EXPECT_LT(LargestDifference(expected, fits.Measure(waved), 0.7), 0.02);
  Eigen::VectorXd differences = (expected.Mean - fits.Measure(waved).Mean).cwiseAbs();
  std::sort(differences.begin(), differences.end());
  EXPECT_LT(0.7 * differences[differences.size() / 2], 1e-3);
}

TEST(CurvatureFits, StretchedCylindersStayExact)
{
  // Twice as long: the points of the reference. Five times: those of the surface itself.
  const shapes::Shape cylinder = shapes::OpenCylinder(48, 24);
  const CurvatureFits fits(MeshOf(cylinder), cylinder.Positions);
  for (const double factor : { 1.9, 5.0, 0.2 })
  {
    const Curvatures found = fits.Measure(Mapped(cylinder.Positions,
      [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
        return { p[0], p[1], factor * p[2] };
      }));
    EXPECT_LT((found.Maximum.array() - 1.0).abs().maxCoeff(), 2e-3) << factor;
    EXPECT_LT(found.Minimum.cwiseAbs().maxCoeff(), 2e-3) << factor;
  }
}

TEST(CurvatureFits, FollowRigidMotionsAndUnits)
{
  const shapes::Shape torus = shapes::Torus(24, 16);
  const CurvatureFits fits(MeshOf(torus), torus.Positions);
  const Points waved = Mapped(torus.Positions, Wave);
  const Curvatures expected = fits.Measure(waved);
  shapes::Shape moved{ waved, torus.Faces };
  moved = shapes::RandomRigidMotion(5)(moved);
  const Curvatures turned = fits.Measure(moved.Positions);
  EXPECT_LT(LargestDifference(expected, turned, 1.0), 1e-6);
  EXPECT_EQ(expected.States, turned.States);
  const CurvatureFits small(MeshOf(torus), 1e-6 * torus.Positions);
  Curvatures scaled = small.Measure(1e-6 * waved);
  scaled.Maximum *= 1e-6;
  scaled.Minimum *= 1e-6;
  EXPECT_LT(LargestDifference(expected, scaled, 1.0), 1e-6);
  EXPECT_EQ(expected.States, scaled.States);
}

TEST(CurvatureFits, DoNotDependOnWhatWasMeasuredBefore)
{
  const shapes::Shape torus = shapes::Torus(24, 16);
  const CurvatureFits fits(MeshOf(torus), torus.Positions);
  const Points waved = Mapped(torus.Positions, Wave);
  const Curvatures first = fits.Measure(waved);
  fits.Measure(Points::Zero(waved.rows(), 3));
  fits.Measure(torus.Positions);
  const Curvatures again = fits.Measure(waved);
  EXPECT_EQ(first.Maximum, again.Maximum);
  EXPECT_EQ(first.Minimum, again.Minimum);
  EXPECT_EQ(first.States, again.States);
}

TEST(CurvatureFits, PointsThatLeaveTheFormOpenAreCollectedAnew)
{
  // A strip rolled to a prism of six sides has two rows of points where the plane had many.
  const shapes::Shape plane = shapes::Plane(6, 6.0);
  const Points rolled = Mapped(
    plane.Positions, [](const Eigen::Vector3d& p) { return RollToCylinder(p, 3.0 / shapes::Pi); });
  const Curvatures expected = FitCurvatures(*MeshOf(plane), rolled);
  const Curvatures found = CurvatureFits(MeshOf(plane), plane.Positions).Measure(rolled);
  EXPECT_LT(LargestDifference(expected, found, 1.0), 1e-9);
  EXPECT_EQ(expected.States, found.States);
}

TEST(CurvatureFits, CollapsedSurfacesHaveTheStatesOfFitCurvatures)
{
  const shapes::Shape torus = shapes::Torus(12, 8);
  const CurvatureFits fits(MeshOf(torus), torus.Positions);
  for (const Map& map : { Map([](const Eigen::Vector3d&) { return Eigen::Vector3d::Zero(); }),
         Map([](const Eigen::Vector3d& p) { return Eigen::Vector3d(p[0], 0.0, 0.0); }),
         Map([](const Eigen::Vector3d& p) { return Eigen::Vector3d(p[0], p[1], 0.0); }) })
  {
    const Points current = Mapped(torus.Positions, map);
    const Curvatures expected = FitCurvatures(*MeshOf(torus), current);
    const Curvatures found = fits.Measure(current);
    EXPECT_TRUE(found.Mean.allFinite() && found.Gaussian.allFinite());
    EXPECT_TRUE(found.MaximumDirections.allFinite());
    EXPECT_EQ(expected.States, found.States);
  }
}
