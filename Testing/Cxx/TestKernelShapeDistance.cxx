// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Measure/ShapeDistance.h"

#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Measure/Areas.h"
#include "MeasureShapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

using namespace cartan;
using shapes::BentBar;
using shapes::MakeMesh;
using shapes::Pi;
using shapes::Rolled;
using shapes::Shape;

namespace
{
constexpr double TubeRadius = 0.4;

/// Twists space about z, then bends it about y: neither keeps lengths.
Eigen::Vector3d TwistedAndBent(const Eigen::Vector3d& x)
{
  constexpr double radius = 3.0;
  const double twist = 0.6 * x[2];
  const double side = radius + std::cos(twist) * x[0] - std::sin(twist) * x[1];
  const double turn = x[2] / radius;
  return { side * std::cos(turn) - radius, std::sin(twist) * x[0] + std::cos(twist) * x[1],
    side * std::sin(turn) };
}

Points TwistedAndBent(const Points& points)
{
  Points moved(points.rows(), 3);
  for (Eigen::Index v = 0; v < points.rows(); ++v)
  {
    moved.row(v) = TwistedAndBent(Eigen::Vector3d(points.row(v))).transpose();
  }
  return moved;
}

Eigen::Vector3d OnTorus(double u, double v)
{
  const double distance = 1.0 + TubeRadius * std::cos(v);
  return { distance * std::cos(u), distance * std::sin(u), TubeRadius * std::sin(v) };
}

double TorusField(const Eigen::Vector3d& x)
{
  return std::hypot(std::hypot(x[0], x[1]) - 1.0, x[2]) - TubeRadius;
}

/// Dist of the torus by quadrature: exact tangents by small differences of the
/// formulas, the polar factor of their map, and differences of that.
double ExactDistance()
{
  const auto frame = [](double u, double v, bool isMoved)
  {
    constexpr double step = 1e-5;
    const auto at = [isMoved](double a, double b)
    { return isMoved ? TwistedAndBent(OnTorus(a, b)) : OnTorus(a, b); };
    const Eigen::Vector3d first = (at(u + step, v) - at(u - step, v)) / (2.0 * step);
    const Eigen::Vector3d second = (at(u, v + step) - at(u, v - step)) / (2.0 * step);
    Eigen::Matrix3d columns;
    columns << first, second, first.cross(second).normalized();
    return columns;
  };
  const auto rotation = [&frame](double u, double v) -> Eigen::Matrix3d
  { return ProjectOnRotations(frame(u, v, true) * frame(u, v, false).inverse()); };
  constexpr int count = 100;
  constexpr double step = 1e-3;
  double sum = 0.0;
  for (int i = 0; i < count * count; ++i)
  {
    const double u = 2.0 * Pi * (i % count) / count;
    const double v = 2.0 * Pi * (i / count) / count;
    const Eigen::Matrix3d du = (rotation(u + step, v) - rotation(u - step, v)) / (2.0 * step);
    const Eigen::Matrix3d dv = (rotation(u, v + step) - rotation(u, v - step)) / (2.0 * step);
    // The parameter lines are orthogonal.
    const Eigen::Matrix3d tangents = frame(u, v, false);
    const double lengthU = tangents.col(0).norm();
    const double lengthV = tangents.col(1).norm();
    sum += 0.5 * (du.squaredNorm() / (lengthU * lengthU) + dv.squaredNorm() / (lengthV * lengthV)) *
      lengthU * lengthV;
  }
  return sum * 4.0 * Pi * Pi / (count * count);
}

/// A torus of quads split in two, fine on one side and coarse on the other, jittered.
Shape GradedTorus(int count)
{
  shapes::PatchOptions options;
  options.CountU = 2 * count;
  options.CountV = count;
  options.PeriodicU = options.PeriodicV = true;
  options.Jitter = 0.25;
  return shapes::Patch(options,
    [](double u, double v)
    {
      const double x = 2.0 * Pi * u;
      const double y = 2.0 * Pi * v;
      return OnTorus(x + 0.8 * std::sin(x), y + 0.6 * std::sin(y));
    });
}

double TwistDistance(const Shape& shape)
{
  return MeasureShapeDistance(MakeMesh(shape), shape.Positions, TwistedAndBent(shape.Positions))
    .Total;
}
}

TEST(ShapeDistance, VanishesForRigidMotionsOnly)
{
  const shapes::Shape shape = shapes::Torus(32, 16, 2.0, 0.7, 0.2);
  const TriangleMesh mesh = MakeMesh(shape);
  EXPECT_LT(
    MeasureShapeDistance(mesh, shape.Positions, shapes::RandomRigidMotion(3, 10.0)(shape.Positions))
      .Total,
    1e-20);
  EXPECT_GT(
    MeasureShapeDistance(mesh, shape.Positions, shapes::Noisy(shape, 0.05).Positions).Total, 1.0);
}

TEST(ShapeDistance, InvariantToRigidMotionsOfEitherSurface)
{
  const shapes::Shape bar = shapes::Bar(4, 4, 20, { 1.0, 1.0, 5.0 });
  const TriangleMesh mesh = MakeMesh(bar);
  const Points bent = BentBar(bar.Positions, 1.0, 4.0, 2.0);
  const ShapeDistance distance = MeasureShapeDistance(mesh, bar.Positions, bent);
  const ShapeDistance moved = MeasureShapeDistance(
    mesh, shapes::RandomRigidMotion(1)(bar.Positions), shapes::RandomRigidMotion(2, 5.0)(bent));
  EXPECT_NEAR(moved.Total, distance.Total, 1e-10);
  EXPECT_LT((moved.Density - distance.Density).cwiseAbs().maxCoeff(), 1e-10);
  // Without unit.
  EXPECT_NEAR(
    MeasureShapeDistance(mesh, 1e-6 * bar.Positions, 1e-6 * bent).Total, distance.Total, 1e-10);
}

TEST(ShapeDistance, OfARolledPlaneIsTheIntegralOfTheSquaredCurvature)
{
  // Second forms diag(0, 0) and diag(1 / r, 0).
  const double radius = 0.8;
  const auto error = [radius](int count)
  {
    const shapes::Shape flat = shapes::Plane(count, 2.0);
    const shapes::Shape rolled = Rolled(flat, radius);
    return std::abs(MeasureShapeDistance(MakeMesh(flat), flat.Positions, rolled.Positions).Total -
      4.0 / (radius * radius));
  };
  EXPECT_LT(error(80), 0.02 * 4.0 / (radius * radius));
  EXPECT_GT(std::log2(error(40) / error(80)), 0.9);
}

TEST(ShapeDistance, DensityIntegratesToTheTotal)
{
  const shapes::Shape bar = shapes::Bar(4, 4, 20, { 1.0, 1.0, 5.0 });
  const TriangleMesh mesh = MakeMesh(bar);
  const ShapeDistance distance =
    MeasureShapeDistance(mesh, bar.Positions, BentBar(bar.Positions, 1.0, 4.0, 2.0));
  EXPECT_TRUE((distance.Density.array() >= 0.0).all());
  EXPECT_NEAR(distance.Density.dot(BarycentricAreas(mesh, TriangleAreas(mesh, bar.Positions))),
    distance.Total, 1e-12);
}

TEST(ShapeDistance, FiniteOnDegenerateTriangles)
{
  shapes::Shape plane = shapes::Plane(4);
  const Points current = plane.Positions;
  plane.Positions.row(7) = plane.Positions.row(6);
  const ShapeDistance distance = MeasureShapeDistance(MakeMesh(plane), plane.Positions, current);
  EXPECT_TRUE(std::isfinite(distance.Total));
  EXPECT_TRUE(distance.Density.allFinite());
}

TEST(ShapeDistance, ConvergesOnIsosurfaces)
{
  const double exact = ExactDistance();
  const auto error = [exact](int count)
  {
    const Shape shape = shapes::MarchingTetrahedra(count, 1.6, TorusField).Get();
    const double relative = TwistDistance(shape) / exact - 1.0;
    shapes::ShowFigure("isosurface, relative error of Dist", relative);
    return std::abs(relative);
  };
  EXPECT_LT(error(32), 0.05);
  EXPECT_LT(error(64), 0.03);
}

TEST(ShapeDistance, ConvergesOnGradedMeshes)
{
  const double exact = ExactDistance();
  const auto error = [exact](int count)
  {
    const double relative = TwistDistance(GradedTorus(count)) / exact - 1.0;
    shapes::ShowFigure("graded torus, relative error of Dist", relative);
    return std::abs(relative);
  };
  EXPECT_LT(error(40), 0.06);
  EXPECT_LT(error(80), 0.02);
}

TEST(ShapeDistance, DoesNotSeeHowLongAnExtraEdgeIs)
{
  // A point on an edge, at any part of it, splits both triangles beside it.
  const Shape torus = shapes::Torus(40, 24, 1.0, TubeRadius);
  const double expected = TwistDistance(torus);
  for (const double part : { 0.5, 1e-2, 1e-4, 1e-8, 1e-13, 0.0 })
  {
    Shape split = torus;
    std::vector<Eigen::Vector3i> faces;
    const int a = torus.Faces(100, 0);
    const int b = torus.Faces(100, 1);
    const int added = torus.NumberOfVertices();
    for (int t = 0; t < torus.Faces.rows(); ++t)
    {
      const Eigen::Vector3i face = torus.Faces.row(t).transpose();
      faces.push_back(face);
      if ((face.array() == a).any() && (face.array() == b).any())
      {
        Eigen::Vector3i other = face;
        std::replace(faces.back().begin(), faces.back().end(), a, added);
        std::replace(other.begin(), other.end(), b, added);
        faces.push_back(other);
      }
    }
    split.Faces = shapes::ToTriangles(faces);
    split.Positions.conservativeResize(added + 1, 3);
    split.Positions.row(added) =
      (1.0 - part) * torus.Positions.row(a) + part * torus.Positions.row(b);
    EXPECT_NEAR(TwistDistance(split) / expected, 1.0, 0.01) << part;
  }
}
