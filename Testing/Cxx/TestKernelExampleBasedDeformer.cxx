// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Deformation/ExampleBasedDeformer.h"
#include "Kernel/Deformation/ShapePreservingDeformer.h"

#include "AdviceWords.h"
#include "HandleShapes.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Mesh/Geometry.h"
#include "RealMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using cartan::DeformedSurface;
using cartan::ExampleBasedDeformer;
using cartan::HandleProblem;
using cartan::HandleTargets;
using cartan::Points;
using Eigen::VectorXd;
using shapes::Shape;

namespace
{
/// A bar of 1 x 1 x 6 along z; its ends below 1 and above 5 are handles 1 and 2.
Shape Bar()
{
  return shapes::Bar(6, 6, 48, { 1.0, 1.0, 6.0 });
}

HandleProblem Problem(const Shape& bar)
{
  return shapes::ProblemOf(
    bar, [](const Eigen::Vector3d& p) { return p[2] < 1.01 ? 1
                                          : p[2] > 4.99    ? 2
                                                           : 0; });
}

/// Between the ends an arc, whose total angle in degrees is given, and a twist.
Points Pose(const Shape& bar, double bend, double twist = 0.0)
{
  Points posed = bar.Positions;
  const double total = bend * shapes::Pi / 180.0;
  for (Eigen::Index v = 0; v < posed.rows(); ++v)
  {
    const double part = std::clamp((posed(v, 2) - 1.0) / 4.0, 0.0, 1.0);
    const double turn = part * twist * shapes::Pi / 180.0;
    const Eigen::Vector2d side =
      Eigen::Rotation2Dd(turn) * Eigen::Vector2d(posed(v, 0), posed(v, 1));
    const double beyond = posed(v, 2) - 1.0 - 4.0 * part;
    const double angle = part * total;
    // The middle line: an integral of its direction (0, sin, cos).
    const double rise = total == 0.0 ? 0.0 : 4.0 * (1.0 - std::cos(angle)) / total;
    const double run = total == 0.0 ? 4.0 * part : 4.0 * std::sin(angle) / total;
    posed.row(v) << side[0], rise + std::cos(angle) * side[1] + std::sin(angle) * beyond,
      1.0 + run - std::sin(angle) * side[1] + std::cos(angle) * beyond;
  }
  return posed;
}

/// Handle 2 where it is in a pose.
HandleTargets TargetsOf(const HandleProblem& problem, const Points& pose)
{
  HandleTargets targets;
  targets.Motions.resize(problem.Moving.size());
  for (std::size_t v = 0; v < problem.Handle.size(); ++v)
  {
    if (problem.Handle[v] > 0)
    {
      targets.Vertices.push_back(static_cast<int>(v));
    }
  }
  targets.Positions.resize(static_cast<Eigen::Index>(targets.Vertices.size()), 3);
  for (std::size_t i = 0; i < targets.Vertices.size(); ++i)
  {
    targets.Positions.row(static_cast<Eigen::Index>(i)) = pose.row(targets.Vertices[i]);
  }
  return targets;
}

DeformedSurface Deform(ExampleBasedDeformer& deformer, const HandleTargets& targets)
{
  DeformedSurface result;
  deformer.Deform(targets, true, result, {});
  EXPECT_EQ(deformer.GetWarning(), "");
  return result;
}

double Distance(const Points& a, const Points& b)
{
  return (a - b).rowwise().norm().maxCoeff() / cartan::BoundingDiagonal(b);
}
}

TEST(ExampleBasedDeformer, FindsTheRestPoseAndTheExamples)
{
  const Shape bar = Bar();
  HandleProblem problem = Problem(bar);
  problem.Moving = { 1, 2 };
  const std::vector<Points> poses = { bar.Positions, Pose(bar, 90.0), Pose(bar, 0.0, 90.0),
    Pose(bar, -60.0, 30.0) };
  // Examples may lie anywhere.
  const shapes::RigidMotion away = shapes::RandomRigidMotion(3, 5.0);
  ExampleBasedDeformer deformer(problem, { away(poses[1]), poses[2], poses[3] });
  for (int pose = 0; pose < 4; ++pose)
  {
    for (const bool isTurned : { false, true })
    {
      const Points expected = isTurned ? away(poses[pose]) : poses[pose];
      const DeformedSurface result = Deform(deformer, TargetsOf(problem, expected));
      EXPECT_LT(Distance(result.Positions, expected), 1e-9);
      VectorXd weights = VectorXd::Zero(3);
      if (pose > 0)
      {
        weights[pose - 1] = 1.0;
      }
      EXPECT_LT((deformer.GetWeights() - weights).cwiseAbs().maxCoeff(), 1e-6);
      EXPECT_LT(deformer.GetDistance(), 1e-9);
    }
  }
}

TEST(ExampleBasedDeformer, BendsBetweenAndBeyondExamples)
{
  const Shape bar = Bar();
  const HandleProblem problem = Problem(bar);
  ExampleBasedDeformer deformer(problem, { Pose(bar, 90.0), Pose(bar, 0.0, 60.0) });
  for (const double bend : { 45.0, 70.0, -40.0, 135.0 })
  {
    const Points expected = Pose(bar, bend);
    const DeformedSurface result = Deform(deformer, TargetsOf(problem, expected));
    EXPECT_NEAR(deformer.GetWeights()[0], bend / 90.0, 1e-3);
    EXPECT_NEAR(deformer.GetWeights()[1], 0.0, 1e-3);
    shapes::ShowFigure("bend", bend);
    shapes::ShowFigure("  distance", Distance(result.Positions, expected));
    shapes::ShowFigure("  iterations", deformer.GetNumberOfIterations());
    if (bend == 45.0)
    {
      EXPECT_LT(Distance(result.Positions, expected), 1e-5);
    }
  }
}

TEST(ExampleBasedDeformer, DoesNotDependOnTheOrderOfExamplesNorOnHowTheyLie)
{
  const Shape bar = Bar();
  const HandleProblem problem = Problem(bar);
  const Points bent = Pose(bar, 80.0);
  const Points twisted = Pose(bar, 10.0, 70.0);
  const HandleTargets targets = TargetsOf(problem, Pose(bar, 50.0, 20.0));
  ExampleBasedDeformer deformer(problem, { bent, twisted });
  const Points expected = Deform(deformer, targets).Positions;
  const VectorXd weights = deformer.GetWeights();
  ExampleBasedDeformer other(problem,
    { shapes::RandomRigidMotion(5, 2.0)(twisted), shapes::RandomRigidMotion(6, 9.0)(bent) });
  EXPECT_LT(Distance(Deform(other, targets).Positions, expected), 1e-6);
  EXPECT_LT((other.GetWeights().reverse() - weights).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_NEAR(other.GetDistance(), deformer.GetDistance(), 1e-9);
  // An example twice shares its weight.
  ExampleBasedDeformer twice(problem, { bent, twisted, bent });
  EXPECT_LT(Distance(Deform(twice, targets).Positions, expected), 1e-6);
  EXPECT_NEAR(twice.GetWeights()[0] + twice.GetWeights()[2], weights[0], 1e-5);
  // A pose like the rest adds nothing.
  ExampleBasedDeformer idle(problem, { bent, bar.Positions, twisted });
  EXPECT_LT(Distance(Deform(idle, targets).Positions, expected), 1e-6);
}

TEST(ExampleBasedDeformer, IsNearestToTheSpan)
{
  // No other weights come closer: a span of the result's own pose finds weight 1 at the
  // distance 0, and of two spans the larger one is never farther away.
  const Shape bar = Bar();
  const HandleProblem problem = Problem(bar);
  const HandleTargets targets = TargetsOf(problem, Pose(bar, 60.0, 40.0));
  double last = 1.0;
  std::vector<Points> examples;
  for (const Points& pose : { Pose(bar, 90.0), Pose(bar, 0.0, 90.0), Pose(bar, 60.0, 40.0) })
  {
    examples.push_back(pose);
    ExampleBasedDeformer deformer(problem, examples);
    Deform(deformer, targets);
    EXPECT_LE(deformer.GetDistance(), last * (1.0 + 1e-9));
    last = deformer.GetDistance();
  }
  EXPECT_LT(last, 1e-9);
}

/// Of poses that fit alike, the rest pose and then the first example.
TEST(ExampleBasedDeformer, TakesTheFirstOfPosesThatFitAlike)
{
  const Shape bar = Bar();
  const HandleProblem problem = Problem(bar);
  const Points bent = Pose(bar, 60.0);
  const Points away = shapes::RandomRigidMotion(5, 3.0)(bent);
  ExampleBasedDeformer twice(problem, { bent, away });
  Deform(twice, TargetsOf(problem, bent));
  EXPECT_LT((twice.GetWeights() - Eigen::Vector2d(1.0, 0.0)).norm(), 1e-9);
  ExampleBasedDeformer resting(problem, { shapes::RandomRigidMotion(6, 3.0)(bar.Positions), bent });
  Deform(resting, TargetsOf(problem, bar.Positions));
  EXPECT_LT(resting.GetWeights().norm(), 1e-9);
  // To 1e-9 of the size.
  ExampleBasedDeformer nearly(
    problem, { shapes::Noisy({ away, bar.Faces }, 1e-10).Positions, bent });
  Deform(nearly, TargetsOf(problem, bent));
  EXPECT_LT((nearly.GetWeights() - Eigen::Vector2d(1.0, 0.0)).norm(), 1e-4);
}

/// Handles so far away that no weight changes more of the misfit than its last digits.
TEST(ExampleBasedDeformer, FindsWeightsBySlopesFarFromTheExamples)
{
  const Shape bar = Bar();
  HandleTargets targets;
  targets.Motions.resize(1);
  targets.Motions[0].Translation = { 1e8, -3e8, 2e8 };
  std::vector<double> weights;
  for (const double noise : { 0.0, 1e-13 })
  {
    ExampleBasedDeformer deformer(Problem(shapes::Noisy(bar, noise)), { Pose(bar, 90.0) });
    Deform(deformer, targets);
    EXPECT_GT(deformer.GetDistance(), 1e6);
    weights.push_back(deformer.GetWeights()[0]);
  }
  EXPECT_NEAR(weights[1], weights[0], 1e-5 * std::abs(weights[0]));
}

/// Two points hold the surface but for a turn about their line. A bar that is a mirror image
/// of itself, bent within its plane, stays in it.
TEST(ExampleBasedDeformer, TurnsLeastAboutTheLineOfTwoPoints)
{
  const Shape bar = Bar();
  const auto ends = [](const Eigen::Vector3d& p) {
    return p.head<2>().norm() > 1e-9 ? 0 : p[2] < 1e-9 ? 1 : p[2] > 5.999 ? 2 : 0;
  };
  HandleTargets targets;
  targets.Motions.resize(1);
  targets.Motions[0].Translation = { 0.0, 1.5, -1.0 };
  std::vector<Points> results;
  for (const double noise : { 0.0, 1e-13 })
  {
    const HandleProblem problem = shapes::ProblemOf(shapes::Noisy(bar, noise), ends);
    ASSERT_EQ(std::count(problem.Handle.begin(), problem.Handle.end(), 2), 1);
    ExampleBasedDeformer deformer(problem, { Pose(bar, 90.0) });
    results.push_back(Deform(deformer, targets).Positions);
  }
  EXPECT_LT(Distance(results[1], results[0]), 1e-7);
  for (Eigen::Index v = 0; v < results[0].rows(); ++v)
  {
    // The triangles themselves are no mirror image.
    EXPECT_LT(std::abs(results[0](v, 0) - bar.Positions(v, 0)), 0.1) << v;
  }
}

TEST(ExampleBasedDeformer, StartsFromTheLastMotionWhenWarm)
{
  const Shape bar = Bar();
  const HandleProblem problem = Problem(bar);
  ExampleBasedDeformer cold(problem, { Pose(bar, 90.0), Pose(bar, 0.0, 90.0) });
  ExampleBasedDeformer warm(problem, { Pose(bar, 90.0), Pose(bar, 0.0, 90.0) });
  warm.SetWarmStart(true);
  for (double bend = 10.0; bend < 60.0; bend += 3.0)
  {
    const HandleTargets targets = TargetsOf(problem, Pose(bar, bend, 0.4 * bend));
    const Points expected = Deform(cold, targets).Positions;
    EXPECT_LT(Distance(Deform(warm, targets).Positions, expected), 1e-5);
    EXPECT_LE(warm.GetNumberOfIterations(), 8);
  }
  EXPECT_EQ(warm.GetNumberOfFactorizations(), 1);
}

std::unique_ptr<cartan::SurfaceDeformer> NewShapePreserving(
  const HandleProblem& problem, const cartan::ExecutionContext& context)
{
  return std::make_unique<cartan::ShapePreservingDeformer>(
    problem, cartan::SolverBackend::Automatic, context);
}

TEST(ExampleBasedDeformer, BlendsWithAnotherMethodByRigidness)
{
  const Shape bar = Bar();
  const HandleProblem problem = Problem(bar);
  HandleTargets targets;
  targets.Motions.resize(1);
  cartan::HandleMotion& motion = targets.Motions[0];
  motion.RotationVector = { 0.6, 0.2, 0.0 };
  motion.Linear = cartan::RotationFromVector(motion.RotationVector);
  ExampleBasedDeformer deformer(problem, { Pose(bar, -90.0) });
  const Points span = Deform(deformer, targets).Positions;
  deformer.SetRigidness(1.0, NewShapePreserving);
  const Points rigid = Deform(deformer, targets).Positions;
  cartan::ShapePreservingDeformer other(problem);
  DeformedSurface expected;
  other.Deform(targets, false, expected, {});
  EXPECT_LT(Distance(rigid, expected.Positions), 1e-12);
  EXPECT_GT(Distance(span, rigid), 1e-3);
  deformer.SetRigidness(0.25, NewShapePreserving);
  const Points between = 0.75 * span + 0.25 * rigid;
  EXPECT_LT(Distance(Deform(deformer, targets).Positions, between), 1e-12);
  EXPECT_EQ(deformer.GetNumberOfFactorizations(), 2);
  // In the span of the examples and rigid alike.
  const HandleTargets atRest = TargetsOf(problem, bar.Positions);
  EXPECT_LT(Distance(Deform(deformer, atRest).Positions, bar.Positions), 1e-9);
}

TEST(ExampleBasedDeformer, RefusesHandlesWithoutPositionsAndSaysWhenItHasNotSettled)
{
  const Shape bar = Bar();
  HandleProblem problem = Problem(bar);
  ExampleBasedDeformer deformer(problem, { Pose(bar, 90.0) });
  deformer.SetIteration(1, 1e-12);
  DeformedSurface result;
  deformer.Deform(TargetsOf(problem, Pose(bar, 40.0, 30.0)), false, result, {});
  EXPECT_NE(deformer.GetWarning().find(shapes::Advice(
              "raise MaximumIterations, or move the handles less far from the examples.")),
    std::string::npos);
  deformer.SetIteration(50, 1e-6);
  deformer.Deform(TargetsOf(problem, Pose(bar, 40.0, 30.0)), false, result, {});
  EXPECT_EQ(deformer.GetWarning(), "");
  problem.ConstrainPositions = false;
  try
  {
    ExampleBasedDeformer refused(problem, { Pose(bar, 90.0) });
    FAIL();
  }
  catch (const cartan::Error& error)
  {
    EXPECT_NE(std::string(error.what()).find(shapes::Advice("turn ConstrainHandlePositions on.")),
      std::string::npos);
  }
}

/// A mirrored handle is no rotation, and the least change chooses none.
TEST(ExampleBasedDeformer, KeepsTheMotionOfHandlesWhenItBlends)
{
  const Shape bar = Bar();
  const HandleProblem problem = Problem(bar);
  HandleTargets targets;
  targets.Motions.resize(1);
  targets.Motions[0].Linear = -Eigen::Matrix3d::Identity();
  targets.Motions[0].Translation = { 0.0, 0.0, 11.0 };
  ExampleBasedDeformer deformer(problem, { Pose(bar, 90.0) });
  deformer.SetRigidness(0.2, NewShapePreserving);
  const DeformedSurface result = Deform(deformer, targets);
  for (std::size_t v = 0; v < problem.Handle.size(); ++v)
  {
    const Eigen::Matrix3d transform = cartan::MatrixAt(result.Transforms, static_cast<int>(v));
    if (problem.Handle[v] == 2)
    {
      EXPECT_EQ(transform, targets.Motions[0].Linear);
    }
    else
    {
      EXPECT_NEAR(transform.determinant(), 1.0, 1e-12);
    }
  }
}
