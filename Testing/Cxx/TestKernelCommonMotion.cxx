// SPDX-License-Identifier: BSD-3-Clause
#include "AllDeformers.h"
#include "HandleShapes.h"
#include "Ids.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Base/Constants.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

/// What handles do together, the surface does; and every method gives the same
/// result in every frame.
namespace
{
using cartan::DeformedSurface;
using cartan::HandleMotion;
using cartan::HandleProblem;
using cartan::HandleTargets;
using cartan::MatrixAt;
using cartan::Points;

constexpr double Degree = cartan::FullTurn / 360.0;

/// A bar along z from -2 to 2.
HandleProblem Bar(const shapes::HandleOf& handleOf, const std::vector<int>& moving)
{
  shapes::Shape shape = shapes::Bar(3, 3, 12, { 1.0, 1.0, 4.0 }, true);
  shape.Positions.rowwise() -= shape.Positions.colwise().mean().eval();
  return shapes::ProblemOf(shape, handleOf, moving);
}

/// Both ends and a patch in the middle of one side.
int EndsAndSide(const Eigen::Vector3d& x)
{
  const bool isSide = x[0] > 0.5 - 1e-9 && std::abs(x[2]) < 0.4 && std::abs(x[1]) < 0.3;
  return x[2] < -1.5 ? 1 : x[2] > 1.5 ? 2 : isSide ? 3 : 0;
}

int BothEnds(const Eigen::Vector3d& x)
{
  return x[2] < -1.5 ? 1 : x[2] > 1.5 ? 2 : 0;
}

HandleMotion Turn(const Eigen::Vector3d& vector, const Eigen::Vector3d& shift = { 0.0, 0.0, 0.0 })
{
  HandleMotion motion;
  motion.RotationVector = vector;
  motion.Linear = cartan::RotationFromVector(vector);
  motion.Translation = shift;
  return motion;
}

/// As a matrix tells it.
HandleMotion WithoutTurns(HandleMotion motion)
{
  motion.RotationVector = cartan::VectorFromRotation(cartan::ProjectOnRotations(motion.Linear));
  motion.CountsTurns = false;
  return motion;
}

/// The motion, then `frame`.
HandleMotion Then(const HandleMotion& motion, const shapes::RigidMotion& frame)
{
  HandleMotion result;
  result.Linear = frame.Rotation * motion.Linear;
  result.Translation = frame.Rotation * motion.Translation + frame.Translation;
  return WithoutTurns(result);
}

std::vector<shapes::RigidMotion> Frames()
{
  std::vector<shapes::RigidMotion> frames;
  for (int seed = 1; seed <= 3; ++seed)
  {
    frames.push_back(shapes::RandomRigidMotion(seed, 3.0));
  }
  for (const Eigen::Vector3d& axis :
    { Eigen::Vector3d(0.0, 0.0, 1.0), Eigen::Vector3d(1.0, 1.0, 0.0) })
  {
    for (const double degrees : { 149.0, 175.0, 180.0, 200.0 })
    {
      frames.push_back(frames.front());
      frames.back().Rotation = cartan::RotationFromVector(degrees * Degree * axis.normalized());
    }
  }
  return frames;
}

DeformedSurface Deform(cartan::SurfaceDeformer& deformer, const HandleTargets& targets)
{
  DeformedSurface result;
  deformer.Deform(targets, true, result, {});
  return result;
}

DeformedSurface Deform(cartan::SurfaceDeformer& deformer, const std::vector<HandleMotion>& motions)
{
  HandleTargets targets;
  targets.Motions = motions;
  return Deform(deformer, targets);
}

double LargestDifference(const Points& a, const Points& b)
{
  return (a - b).cwiseAbs().maxCoeff();
}

TEST(CommonMotion, CarriesTheSurfaceAlong)
{
  const HandleProblem problem = Bar(EndsAndSide, { 1, 2, 3 });
  for (const auto& [name, make] : deformers::All())
  {
    const auto deformer = make(problem, {});
    for (const shapes::RigidMotion& frame : Frames())
    {
      const HandleMotion motion = Then({}, frame);
      const DeformedSurface result = Deform(*deformer, { motion, motion, motion });
      EXPECT_LT(LargestDifference(result.Positions, frame(*problem.Rest)), 1e-10) << name;
      for (Eigen::Index v = 0; v < result.Transforms.rows(); ++v)
      {
        ASSERT_LT((MatrixAt(result.Transforms, v) - frame.Rotation).norm(), 1e-7) << name;
      }
    }
  }
}

TEST(CommonMotion, OfOneHandleIsFollowedByTheWhole)
{
  const HandleProblem problem =
    Bar([](const Eigen::Vector3d& x) { return x[2] < -1.5 ? 4 : 0; }, { 4 });
  const shapes::RigidMotion frame = shapes::RandomRigidMotion(5, 3.0);
  for (const auto& [name, make] : deformers::All())
  {
    const auto deformer = make(problem, {});
    const DeformedSurface result = Deform(*deformer, { Then({}, frame) });
    EXPECT_LT(LargestDifference(result.Positions, frame(*problem.Rest)), 1e-10) << name;
  }
}

TEST(CommonMotion, OfSinglePointsIsFollowedByTheWhole)
{
  // Two points leave the rotation about their line to the motions.
  HandleProblem problem = Bar([](const Eigen::Vector3d&) { return 0; }, { 1, 2 });
  problem.Handle[0] = 1;
  problem.Handle[problem.Handle.size() / 2] = 2;
  const shapes::RigidMotion frame = shapes::RandomRigidMotion(6, 3.0);
  for (const auto& [name, make] : deformers::All())
  {
    if (name == "SimilarityOfPositions")
    {
      continue; // refuses points in a line
    }
    const auto deformer = make(problem, {});
    const HandleMotion motion = Then({}, frame);
    const DeformedSurface result = Deform(*deformer, { motion, motion });
    EXPECT_LT(LargestDifference(result.Positions, frame(*problem.Rest)), 1e-10) << name;
  }
}

TEST(CommonMotion, DoesNotChangeWhatHandlesDoToEachOther)
{
  // Axes differ, one handle has scale and shear.
  HandleMotion sheared = Turn({ 0.3, -0.8, 0.2 }, { 0.2, 0.0, 0.1 });
  sheared.Linear(0, 1) += 0.2;
  for (const HandleMotion& third : { Turn({ 0.3, -0.8, 0.2 }, { 0.2, 0.0, 0.1 }), sheared })
  {
    const std::vector<HandleMotion> motions{ WithoutTurns(Turn({ 0.0, 0.0, 0.0 })),
      WithoutTurns(Turn({ 0.9, 0.0, 0.4 }, { 0.1, 0.2, 0.1 })), WithoutTurns(third) };
    const HandleProblem problem = Bar(EndsAndSide, { 1, 2, 3 });
    for (const auto& [name, make] : deformers::All())
    {
      const auto deformer = make(problem, {});
      const DeformedSurface original = Deform(*deformer, motions);
      for (const shapes::RigidMotion& frame : Frames())
      {
        std::vector<HandleMotion> moved;
        for (const HandleMotion& motion : motions)
        {
          moved.push_back(Then(motion, frame));
        }
        const DeformedSurface result = Deform(*deformer, moved);
        EXPECT_LT(LargestDifference(result.Positions, frame(original.Positions)), 1e-10) << name;
      }
    }
  }
}

TEST(CommonMotion, KeepsLaps)
{
  const HandleProblem problem = Bar(BothEnds, { 1, 2 });
  const auto deformer = deformers::All()["ShapePreserving"](problem, {});
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, 2.0, 3.0).normalized();
  const Points expected =
    Deform(*deformer, { Turn(0.0 * axis), Turn(400.0 * Degree * axis) }).Positions;
  const shapes::RigidMotion frame{ cartan::RotationFromVector(1000.0 * Degree * axis),
    Eigen::Vector3d::Zero() };
  const Points found =
    Deform(*deformer, { Turn(1000.0 * Degree * axis), Turn(1400.0 * Degree * axis) }).Positions;
  EXPECT_LT(LargestDifference(found, frame(expected)), 1e-10);
  // A full turn between handles is no common motion.
  const Points turned =
    Deform(*deformer, { Turn(0.0 * axis), Turn(360.0 * Degree * axis) }).Positions;
  EXPECT_GT(LargestDifference(turned, *problem.Rest), 0.1);
}

TEST(CommonMotion, IsFollowedBeyondAHandle)
{
  // Pinned below, moved in the middle: the upper half sees one handle alone.
  const HandleProblem problem = Bar([](const Eigen::Vector3d& x)
    { return x[2] < -1.5            ? 1
        : x[2] > -0.5 && x[2] < 0.5 ? 2
                                    : 0; },
    { 2 });
  const shapes::RigidMotion frame{ cartan::RotationFromVector({ 0.0, 1.7, 0.3 }),
    Eigen::Vector3d(0.3, 0.1, 0.5) };
  const Points expected = frame(*problem.Rest);
  for (const auto& [name, make] : deformers::All())
  {
    const auto deformer = make(problem, {});
    const DeformedSurface result = Deform(*deformer, { Then({}, frame) });
    for (Eigen::Index v = 0; v < expected.rows(); ++v)
    {
      if ((*problem.Rest)(v, 2) > 0.0)
      {
        ASSERT_LT((result.Positions.row(v) - expected.row(v)).norm(), 1e-10) << name;
      }
    }
  }
}

TEST(CommonMotion, TurnsHandlesTheShortWayAgainstEachOther)
{
  // 170 and 200 degrees as matrices, the second nearer to the pinned end by way
  // of -160: the first follows it to -190.
  const HandleProblem problem = Bar(EndsAndSide, { 2, 3 });
  const auto turn = [](double degrees) { return Turn({ 0.0, 0.0, degrees * Degree }); };
  for (const char* name : { "ShapePreserving", "PoissonHarmonic", "Spokes" })
  {
    const auto deformer = deformers::All()[name](problem, {});
    const Points found =
      Deform(*deformer, { WithoutTurns(turn(170.0)), WithoutTurns(turn(200.0)) }).Positions;
    const Points expected = Deform(*deformer, { turn(-190.0), turn(-160.0) }).Positions;
    EXPECT_LT(LargestDifference(found, expected), 1e-10) << name;
  }
}

TEST(CommonMotion, ComparesHandlesThatShareARegionOnly)
{
  // 150 degrees to either side of a pinned ring.
  const HandleProblem problem = Bar(
    [](const Eigen::Vector3d& x) {
      return x[2] < -1.5 ? 1 : x[2] > 1.5 ? 2 : std::abs(x[2]) < 0.5 ? 3 : 0;
    },
    { 1, 2 });
  const auto deformer = deformers::All()["ShapePreserving"](problem, {});
  const HandleMotion left = Turn({ 0.0, 0.0, 150.0 * Degree });
  const HandleMotion right = Turn({ 0.0, 0.0, -150.0 * Degree });
  const Points found = Deform(*deformer, { WithoutTurns(left), WithoutTurns(right) }).Positions;
  EXPECT_LT(LargestDifference(found, Deform(*deformer, { left, right }).Positions), 1e-12);
}

TEST(CommonMotion, IsFoundInTargetsOfSinglePoints)
{
  const HandleProblem problem = Bar(EndsAndSide, { 1, 2, 3 });
  const Eigen::Index count = problem.Rest->rows();
  // Rotations that grow along the upper end and pass half a turn in every frame.
  const auto targetsIn = [&](const shapes::RigidMotion& frame)
  {
    HandleTargets targets;
    HandleMotion byMatrices;
    byMatrices.CountsTurns = false;
    targets.Motions.assign(3, byMatrices);
    targets.Vertices = shapes::Ids(count);
    targets.Positions = *problem.Rest;
    targets.Transforms = cartan::Identities(count);
    targets.RotationVectors = Points::Zero(count, 3);
    for (Eigen::Index v = 0; v < count; ++v)
    {
      const Eigen::Vector3d rest = problem.Rest->row(v);
      const HandleMotion turn =
        problem.Handle[v] == 2 ? Turn({ 0.0, 0.0, 0.3 * rest[2] }) : Turn({ 0.0, 0.0, 0.0 });
      const HandleMotion motion = Then(turn, frame);
      targets.Positions.row(v) = (motion.Linear * rest + motion.Translation).transpose();
      MatrixAt(targets.Transforms, v) = motion.Linear;
      targets.RotationVectors.row(v) = motion.RotationVector.transpose();
    }
    return targets;
  };
  const shapes::RigidMotion still{ Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero() };
  for (const auto& [name, make] : deformers::All())
  {
    if (name.rfind("Poisson", 0) == 0)
    {
      continue; // one motion per handle
    }
    const auto deformer = make(problem, {});
    const Points original = Deform(*deformer, targetsIn(still)).Positions;
    for (const shapes::RigidMotion& frame : Frames())
    {
      EXPECT_LT(
        LargestDifference(Deform(*deformer, targetsIn(frame)).Positions, frame(original)), 1e-10)
        << name;
    }
  }
}

TEST(CommonMotion, LeavesWhatNoHandleReaches)
{
  // A second bar without handles, far away.
  const HandleProblem one = Bar(BothEnds, { 1, 2 });
  const int count = one.Mesh->NumberOfVertices();
  const auto& faces = one.Mesh->GetTriangles();
  cartan::Triangles both(2 * faces.rows(), 3);
  both << faces, faces.array() + count;
  Points rest(2 * count, 3);
  rest << *one.Rest, one.Rest->rowwise() + Eigen::RowVector3d(5.0, 0.1, 0.2);
  HandleProblem problem = one;
  problem.Mesh = std::make_shared<const cartan::TriangleMesh>(2 * count, both);
  problem.Rest = std::make_shared<const Points>(rest);
  problem.Handle.resize(2 * count, 0);
  const shapes::RigidMotion frame = shapes::RandomRigidMotion(8, 3.0);
  for (const auto& [name, make] : deformers::All())
  {
    const auto deformer = make(problem, {});
    const HandleMotion motion = Then({}, frame);
    const DeformedSurface result = Deform(*deformer, { motion, motion });
    EXPECT_EQ(result.Positions.bottomRows(count), rest.bottomRows(count)) << name;
    EXPECT_LT(LargestDifference(result.Positions.topRows(count), frame(rest.topRows(count))), 1e-10)
      << name;
  }
}
}

TEST(SoftHandles, MeetInTheMiddleOrAreRefusedWhereRoundingLeavesNothingOfThem)
{
  // One of two ends of equal size is shifted. The less its points are held, the more
  // the bar moves as a whole, at last half of the way.
  const Eigen::RowVector3d shift(1.0, 0.0, 0.0);
  HandleMotion motion;
  motion.Translation = shift.transpose();
  int refused = 0;
  auto methods = deformers::All();
  methods.erase("LaplacianImplicit"); // turns as a whole, too, which brings it closer
  methods.erase("SmoothedRotations"); // does not converge in its sweeps
  for (const auto& [name, make] : methods)
  {
    for (const double weight : { 1e-4, 1e-6, 1e-7, 1e-8, 1e-12, 1e-20 })
    {
      HandleProblem problem = Bar(BothEnds, { 2 });
      problem.SoftWeights.setConstant(problem.Rest->rows(), weight);
      SCOPED_TRACE(name + ", " + std::to_string(std::log10(weight)));
      try
      {
        const auto deformer = make(problem, {});
        const Points moved = Deform(*deformer, { motion }).Positions;
        const double error =
          (moved - (problem.Rest->rowwise() + 0.5 * shift)).cwiseAbs().maxCoeff();
        EXPECT_TRUE(error < 1e-3 || !deformer->GetWarning().empty()) << error;
      }
      catch (const cartan::Error& error)
      {
        EXPECT_LT(weight, 1e-4) << error.what();
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 3 * static_cast<int>(methods.size()) - 1); // at 1e-8 and below
}
