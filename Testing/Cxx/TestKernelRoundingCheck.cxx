// SPDX-License-Identifier: BSD-3-Clause
#include "HandleShapes.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Deformation/RoundingCheck.h"
#include "Kernel/Mesh/Geometry.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using cartan::DeformedSurface;
using cartan::HandleProblem;

HandleProblem Problem()
{
  const shapes::Shape bar = shapes::Bar(2, 2, 6, { 0.6, 0.6, 2.0 });
  return shapes::ProblemOf(bar, shapes::EndsAlong(bar, 2, 0.2));
}

DeformedSurface AtRest(const HandleProblem& problem)
{
  DeformedSurface surface;
  surface.Positions = *problem.Rest;
  surface.Transforms = cartan::Identities(static_cast<int>(problem.Rest->rows()));
  surface.FrameScale.setOnes(problem.Rest->rows());
  return surface;
}

TEST(RoundingCheck, MovesAllPointsByLess)
{
  const HandleProblem problem = Problem();
  const HandleProblem moved = cartan::WithMovedPoints(problem);
  const cartan::Points by = (*moved.Rest - *problem.Rest).cwiseAbs();
  const double size = cartan::BoundingDiagonal(*problem.Rest);
  EXPECT_LE(by.maxCoeff(), 1.001 * cartan::RoundingOfInput * size);
  EXPECT_GT(by.rowwise().maxCoeff().minCoeff(), 0.01 * cartan::RoundingOfInput * size);
  EXPECT_TRUE(*cartan::WithMovedPoints(problem).Rest == *moved.Rest);
}

TEST(RoundingCheck, TurnsMotionsByLessAndLeavesIdentities)
{
  cartan::HandleTargets targets;
  targets.Motions.resize(2);
  targets.Motions[1].RotationVector = { 0.4, -7.0, 2.0 };
  targets.Motions[1].Linear = 3.0 * cartan::RotationFromVector(targets.Motions[1].RotationVector);
  targets.Transforms = cartan::Identities(2);
  cartan::MatrixAt(targets.Transforms, 1) = targets.Motions[1].Linear;
  targets.RotationVectors = cartan::Points::Zero(2, 3);
  targets.RotationVectors.row(1) << 1.0, 2.0, 3.0;
  const cartan::HandleTargets moved = cartan::WithMovedTargets(targets);
  EXPECT_TRUE(moved.Motions[0].Linear.isIdentity(0.0));
  EXPECT_TRUE(moved.Motions[0].RotationVector.isZero(0.0));
  EXPECT_TRUE(cartan::MatrixAt(moved.Transforms, 0).isIdentity(0.0));
  EXPECT_TRUE(moved.RotationVectors.row(0).isZero(0.0));
  const auto expectMoved = [](const auto& from, const auto& to)
  {
    const double by = (to - from).norm() / from.norm();
    EXPECT_GT(by, 0.01 * cartan::RoundingOfTurns);
    EXPECT_LT(by, 2.0 * cartan::RoundingOfTurns);
  };
  expectMoved(targets.Motions[1].Linear, moved.Motions[1].Linear);
  expectMoved(targets.Motions[1].RotationVector, moved.Motions[1].RotationVector);
  expectMoved(targets.Transforms.row(1), moved.Transforms.row(1));
  expectMoved(targets.RotationVectors.row(1), moved.RotationVectors.row(1));
  // A rotation stays one, to the rounding of its square.
  const Eigen::Matrix3d turn = moved.Motions[1].Linear / 3.0;
  EXPECT_LT((turn.transpose() * turn - Eigen::Matrix3d::Identity()).norm(), 1e-14);
}

TEST(RoundingCheck, FindsWhatDiffers)
{
  const HandleProblem problem = Problem();
  const DeformedSurface result = AtRest(problem);
  const auto describe = [&](const DeformedSurface& other, const cartan::ComparedFields& fields)
  { return cartan::CompareResults(problem, result, other, fields).Describe(); };
  const cartan::ComparedFields all{ true, true, true };
  EXPECT_EQ(describe(result, all), "");
  const double size = cartan::BoundingDiagonal(*problem.Rest);

  DeformedSurface other = result;
  other.Positions(7, 1) += 0.5 * cartan::RoundingOfResult * size;
  EXPECT_EQ(describe(other, {}), "");
  other.Positions(7, 1) = result.Positions(7, 1) + 0.25 * size;
  EXPECT_NE(describe(other, {}).find("1 point (id 7)"), std::string::npos) << describe(other, {});
  EXPECT_NE(describe(other, {}).find("0.25"), std::string::npos) << describe(other, {});
  other.Positions(7, 1) = std::nan("");
  EXPECT_NE(describe(other, {}), "");

  // No turn and half a turn about x, both of a line: as matrices near.
  other = result;
  DeformedSurface line = result;
  cartan::MatrixAt(line.Transforms, 5) = Eigen::Vector3d(1.0, 1e-9, 1e-9).asDiagonal();
  cartan::MatrixAt(other.Transforms, 5) = Eigen::Vector3d(1.0, -1e-9, -1e-9).asDiagonal();
  const auto compare = [&](const cartan::ComparedFields& fields)
  { return cartan::CompareResults(problem, line, other, fields).Describe(); };
  EXPECT_EQ(compare({ true, false, false }), "");
  EXPECT_NE(compare({ true, true, false }), "");
}
}
