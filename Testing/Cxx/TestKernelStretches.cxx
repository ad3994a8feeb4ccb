// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Measure/Stretches.h"

#include "Kernel/Mesh/Geometry.h"
#include "RealMeshes.h"

#include <gtest/gtest.h>

#include <cmath>

using cartan::Points;
using cartan::Stretches;
using cartan::TriangleMesh;
using shapes::Shape;

namespace
{
constexpr double Tolerance = 1e-10;

/// The singular values of a map on the plane across a unit normal: the roots of the
/// characteristic polynomial of the Gram matrix.
Eigen::Vector2d OnPlane(const Eigen::Matrix3d& map, const Eigen::Vector3d& normal)
{
  const Eigen::Vector3d u = normal.unitOrthogonal();
  const Eigen::Vector3d a = map * u;
  const Eigen::Vector3d b = map * normal.cross(u);
  const double half = 0.5 * (a.squaredNorm() + b.squaredNorm());
  const double root = std::sqrt(std::max(0.0, half * half - a.cross(b).squaredNorm()));
  return { std::sqrt(half + root), std::sqrt(std::max(0.0, half - root)) };
}

Points Mapped(const Points& points, const Eigen::Matrix3d& map)
{
  Points mapped(points.rows(), 3);
  for (Eigen::Index v = 0; v < points.rows(); ++v)
  {
    mapped.row(v) = (map * points.row(v).transpose()).transpose();
  }
  return mapped;
}

Stretches VertexStretches(const TriangleMesh& mesh, const Points& reference, const Points& current)
{
  return cartan::RingStretches(
    std::make_shared<TriangleMesh>(mesh), std::make_shared<Points>(reference))
    .Measure(current);
}

/// The stretches and directions of a linear map at places with these reference normals.
void ExpectLinear(const Stretches& found, const Points& normals, const Eigen::Matrix3d& map)
{
  for (Eigen::Index i = 0; i < normals.rows(); ++i)
  {
    const Eigen::Vector3d normal = normals.row(i).transpose().normalized();
    const Eigen::Vector2d expected = OnPlane(map, normal);
    EXPECT_NEAR(found.Larger[i], expected[0], Tolerance) << i;
    EXPECT_NEAR(found.Smaller[i], expected[1], Tolerance) << i;
    const Eigen::Vector3d larger = found.LargerDirections.row(i).transpose();
    const Eigen::Vector3d smaller = found.SmallerDirections.row(i).transpose();
    EXPECT_NEAR(larger.norm(), 1.0, Tolerance);
    EXPECT_NEAR(larger.dot(smaller), 0.0, Tolerance);
    // Where the direction comes from has the stretch as its length, and lies in the plane.
    const Eigen::Vector3d from = map.inverse() * larger;
    EXPECT_NEAR(from.norm() * expected[0], 1.0, Tolerance) << i;
    EXPECT_NEAR(from.dot(normal), 0.0, Tolerance) << i;
  }
}
}

TEST(Stretches, OfALinearMapAreItsSingularValuesOnAnyMesh)
{
  Eigen::Matrix3d map;
  map << 1.3, 0.2, -0.1, 0.0, 0.8, 0.3, 0.1, -0.2, 1.1;
  for (const Shape& shape :
    { shapes::Noisy(shapes::Icosphere(3), 0.03), shapes::Bar(3, 3, 7, { 1.0, 1.0, 2.0 }),
      shapes::OpenCylinder(9, 5), shapes::Plane(6, 1.0, 0.3) })
  {
    const TriangleMesh mesh = shapes::MakeMesh(shape);
    const Points current = Mapped(shape.Positions, map);
    ExpectLinear(cartan::TriangleStretches(mesh, shape.Positions, current),
      cartan::TriangleAreaVectors(shape.Positions, shape.Faces), map);
    ExpectLinear(VertexStretches(mesh, shape.Positions, current),
      cartan::VertexNormals(mesh, shape.Positions), map);
  }
}

TEST(Stretches, OfAnInflatedSphereAreTheRatioOfRadii)
{
  const Shape sphere = shapes::Icosphere(3, 2.0);
  const TriangleMesh mesh = shapes::MakeMesh(sphere);
  const Points inflated = 1.7 * sphere.Positions;
  for (const Stretches& found : { cartan::TriangleStretches(mesh, sphere.Positions, inflated),
         VertexStretches(mesh, sphere.Positions, inflated) })
  {
    EXPECT_LT((found.Larger.array() - 1.7).abs().maxCoeff(), Tolerance);
    EXPECT_LT((found.Smaller.array() - 1.7).abs().maxCoeff(), Tolerance);
    EXPECT_EQ(found.LargerDirections.cwiseAbs().maxCoeff(), 0.0); // all are alike
  }
}

// x += gamma y: the stretches are gamma / 2 +- sqrt(1 + gamma^2 / 4), inverse to each other.
TEST(Stretches, OfASimpleShearAreKnown)
{
  const Shape plane = shapes::Plane(7, 1.0, 0.3);
  const TriangleMesh mesh = shapes::MakeMesh(plane);
  for (const double gamma : { 1e-3, 0.5, 3.0 })
  {
    Points sheared = plane.Positions;
    sheared.col(0) += gamma * plane.Positions.col(1);
    const double larger = 0.5 * gamma + std::sqrt(1.0 + 0.25 * gamma * gamma);
    // Line elements of most stretch are at this angle to the x axis when sheared.
    const double angle = 0.5 * std::atan2(2.0, gamma);
    for (const Stretches& found : { cartan::TriangleStretches(mesh, plane.Positions, sheared),
           VertexStretches(mesh, plane.Positions, sheared) })
    {
      EXPECT_LT((found.Larger.array() - larger).abs().maxCoeff(), Tolerance);
      EXPECT_LT((found.Smaller.array() - 1.0 / larger).abs().maxCoeff(), Tolerance);
      for (Eigen::Index i = 0; i < found.Larger.size(); ++i)
      {
        const Eigen::RowVector3d direction = found.LargerDirections.row(i);
        EXPECT_NEAR(
          std::abs(direction[0] * std::cos(angle) + direction[1] * std::sin(angle)), 1.0, 1e-10);
      }
    }
  }
}

TEST(Stretches, SayWhereThereAreNone)
{
  Shape shape = shapes::Plane(2);
  shape.Positions.conservativeResize(shape.Positions.rows() + 1, 3);
  const Eigen::Index unused = shape.Positions.rows() - 1;
  shape.Positions.row(unused).setZero();
  const TriangleMesh mesh = shapes::MakeMesh(shape);
  const Points line = shape.Positions.col(0) * Eigen::RowVector3d(1.0, 0.0, 0.0);
  const Stretches fromLine = cartan::TriangleStretches(mesh, line, shape.Positions);
  EXPECT_TRUE(std::isnan(fromLine.Larger[0]) && std::isnan(fromLine.Smaller[0]));
  const Stretches ofVertices = VertexStretches(mesh, line, shape.Positions);
  EXPECT_TRUE(std::isnan(ofVertices.Larger[0]));
  EXPECT_EQ(ofVertices.Larger[unused], 1.0);
  // Onto a line: one stretch remains.
  const Stretches toLine = cartan::TriangleStretches(mesh, shape.Positions, line);
  EXPECT_LT((toLine.Larger.array() - 1.0).abs().maxCoeff(), Tolerance);
  EXPECT_LT(toLine.Smaller.maxCoeff(), Tolerance);
}

TEST(Stretches, BecomeStrainsOfTheirUsualNames)
{
  const Eigen::Vector2d stretches(2.0, 0.5);
  using cartan::StrainMeasure;
  const auto strains = [&](StrainMeasure measure) -> Eigen::Vector2d
  { return cartan::Strains(stretches, measure); };
  EXPECT_EQ(strains(StrainMeasure::Biot), Eigen::Vector2d(1.0, -0.5));
  EXPECT_EQ(strains(StrainMeasure::GreenLagrange), Eigen::Vector2d(1.5, -0.375));
  EXPECT_EQ(strains(StrainMeasure::EulerAlmansi), Eigen::Vector2d(0.375, -1.5));
  EXPECT_EQ(strains(StrainMeasure::Hencky), Eigen::Vector2d(std::log(2.0), -std::log(2.0)));
  // All agree for small strains.
  for (const StrainMeasure measure : { StrainMeasure::Biot, StrainMeasure::GreenLagrange,
         StrainMeasure::Hencky, StrainMeasure::EulerAlmansi })
  {
    EXPECT_NEAR(cartan::Strains(Eigen::VectorXd::Constant(1, 1.0 + 1e-6), measure)[0], 1e-6, 1e-11);
  }
}
