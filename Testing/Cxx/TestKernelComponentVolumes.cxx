// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Measure/ComponentVolumes.h"

#include "RealMeshes.h"

#include <gtest/gtest.h>

using namespace cartan;
using shapes::Inverted;
using shapes::MakeMesh;
using shapes::Shape;
using shapes::Union;

namespace
{
Shape Ball(double radius, double x = 0.0, double y = 0.0)
{
  Shape ball = shapes::Icosphere(2, radius);
  ball.Positions.col(0).array() += x;
  ball.Positions.col(1).array() += y;
  return ball;
}

Shape All(const std::vector<Shape>& parts)
{
  Shape all = parts[0];
  for (std::size_t i = 1; i < parts.size(); ++i)
  {
    all = Union(all, parts[i]);
  }
  return all;
}

/// However the surface lies and its parts are oriented.
void ExpectEnclosing(const std::vector<Shape>& parts, const std::vector<int>& expected)
{
  for (unsigned int trial = 0; trial < 8; ++trial)
  {
    std::vector<Shape> turned = parts;
    for (std::size_t i = 0; i < turned.size(); ++i)
    {
      turned[i] = (trial >> (i % 3)) % 2 ? Inverted(turned[i]) : turned[i];
    }
    Shape all = All(turned);
    all.Positions = shapes::RandomRigidMotion(trial + 1, 7.0)(all.Positions);
    const TriangleMesh mesh = MakeMesh(all);
    EXPECT_EQ(
      EnclosingComponents(mesh, all.Positions, MeasureComponents(mesh, all.Positions)), expected)
      << trial;
  }
}
}

TEST(EnclosingComponents, OfNestedShellsIsTheNextLargerOne)
{
  ExpectEnclosing({ Ball(3.0), Ball(2.0), Ball(1.0) }, { -1, 0, 1 });
  ExpectEnclosing({ Ball(1.0), Ball(3.0), Ball(2.0) }, { 2, -1, 1 });
}

TEST(EnclosingComponents, OfNeighborsIsThatAroundBoth)
{
  ExpectEnclosing(
    { Ball(4.0), Ball(0.8, 2.0), Ball(0.8, 0.0, 2.0), Ball(0.8, -2.0), Ball(0.3, 2.0) },
    { -1, 0, 0, 0, 1 });
  ExpectEnclosing({ Ball(1.0), Ball(1.0, 3.0), Ball(1.0, 6.0) }, { -1, -1, -1 });
}

TEST(EnclosingComponents, OfABallInTheHoleOfATorusIsNone)
{
  const Shape torus = shapes::Torus(48, 24, 2.0, 0.7);
  ExpectEnclosing({ torus, Ball(0.5) }, { -1, -1 });
  ExpectEnclosing({ torus, Ball(0.3, 2.0) }, { -1, 0 });
}

TEST(EnclosingComponents, PassesOverOpenOnesAndSheetsWithTwoSides)
{
  Shape sheet = shapes::Bar(2, 2, 2, { 1.0, 1.0, 1.0 });
  sheet.Positions.col(2).setZero();
  sheet.Positions.rowwise() -= Eigen::RowVector3d(0.5, 0.5, 0.0);
  Shape tube = shapes::OpenCylinder(24, 6);
  ExpectEnclosing({ Ball(5.0), tube, sheet, Ball(0.2, 0.0, 0.2) }, { -1, -1, -1, 0 });
}

TEST(ComponentVolume, EnclosesNothingWhereTwoSidesLieOnEachOther)
{
  Shape sheet = shapes::Bar(3, 3, 3, { 1.0, 1.0, 1.0 });
  sheet.Positions.col(2).setZero();
  sheet.Positions = shapes::RandomRigidMotion(2, 5.0)(sheet.Positions);
  const Shape all = All({ sheet, Inverted(Ball(1.0)), shapes::OpenCylinder(8, 2) });
  const auto components = MeasureComponents(MakeMesh(all), all.Positions);
  EXPECT_FALSE(components[0].EnclosesVolume());
  EXPECT_TRUE(components[1].EnclosesVolume());
  EXPECT_FALSE(components[2].EnclosesVolume());
}

TEST(ComponentCenters, AreWeightedMeans)
{
  const Shape all = Union(Ball(1.0, 4.0), Ball(2.0, 0.0, -3.0));
  const TriangleMesh mesh = MakeMesh(all);
  Points expected(2, 3);
  expected << 4, 0, 0, 0, -3, 0;
  EXPECT_LT((ComponentCenters(mesh, all.Positions) - expected).norm(), 1e-12);
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(all.NumberOfVertices());
  weights[5] = 1.0;
  weights[all.NumberOfVertices() - 1] = weights[all.NumberOfVertices() - 2] = 2.0;
  expected.row(0) = all.Positions.row(5);
  expected.row(1) = all.Positions.bottomRows(2).colwise().mean();
  EXPECT_LT((ComponentCenters(mesh, all.Positions, weights) - expected).norm(), 1e-12);
}
