// SPDX-License-Identifier: BSD-3-Clause
#include "AllDeformers.h"
#include "HandleShapes.h"
#include "Kernel/Algebra/Rotation.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

/// What every deformation method promises.
namespace
{
using cartan::HandleMotion;
using cartan::HandleProblem;
using cartan::HandleTargets;
using cartan::Points;

/// A bar along z whose lower end is pinned (handle 1), with a handle at its upper
/// end (2) and a patch of one side in the middle (3).
HandleProblem ThreeHandles(int along)
{
  shapes::Shape shape = shapes::Bar(4, 4, along, { 1.0, 1.0, 4.0 }, true);
  shape.Positions.rowwise() -= shape.Positions.colwise().mean().eval();
  return shapes::ProblemOf(shape,
    [](const Eigen::Vector3d& x)
    {
      const bool isSide = x[0] > 0.5 - 1e-9 && std::abs(x[2]) < 0.26 && std::abs(x[1]) < 0.3;
      return x[2] < -1.5 ? 1 : x[2] > 1.5 ? 2 : isSide ? 3 : 0;
    });
}

HandleMotion Turn()
{
  HandleMotion motion;
  motion.RotationVector = { 0.5, 0.1, 0.6 };
  motion.Linear = cartan::RotationFromVector(motion.RotationVector);
  motion.Translation = { 0.1, 0.2, 0.1 };
  return motion;
}

Points Deform(cartan::SurfaceDeformer& deformer, const std::vector<HandleMotion>& motions)
{
  HandleTargets targets;
  targets.Motions = motions;
  cartan::DeformedSurface result;
  deformer.Deform(targets, false, result, {});
  return result.Positions;
}

TEST(SurfaceDeformer, ServesWhereAHandleAtRestIsAPinnedOne)
{
  const HandleProblem fewer = ThreeHandles(16);
  HandleProblem more = fewer;
  more.Moving = { 2, 3 };
  for (const auto& [name, make] : deformers::All())
  {
    const auto ofFewer = make(fewer, {});
    const auto ofMore = make(more, {});
    const Points expected = Deform(*ofFewer, { Turn() });
    const Points found = Deform(*ofMore, { Turn(), HandleMotion() });
    const double difference = (found - expected).cwiseAbs().maxCoeff();
    EXPECT_EQ(ofMore->Serves(fewer), difference < 1e-7) << name << " differs by " << difference;
    EXPECT_FALSE(ofFewer->Serves(more)) << name;
    EXPECT_TRUE(ofMore->Serves(more)) << name;
  }
}

TEST(SurfaceDeformer, ServesTheSameProblemOnly)
{
  HandleProblem problem = ThreeHandles(8);
  problem.Moving = { 2, 3 };
  for (const auto& [name, make] : deformers::All())
  {
    const auto deformer = make(problem, {});
    HandleProblem copy = problem;
    EXPECT_TRUE(deformer->Serves(copy)) << name;
    copy.Handle[1] = copy.Handle[1] == 0 ? 1 : 0;
    EXPECT_FALSE(deformer->Serves(copy)) << name;
    copy = problem;
    copy.Weights = cartan::LaplacianWeights::Uniform;
    EXPECT_FALSE(deformer->Serves(copy)) << name;
    copy = problem;
    copy.PositionWeights = cartan::LaplacianWeights::Uniform;
    EXPECT_FALSE(deformer->Serves(copy)) << name;
    copy = problem;
    copy.SoftWeights.setOnes(problem.Mesh->NumberOfVertices());
    EXPECT_FALSE(deformer->Serves(copy)) << name;
    copy = problem;
    copy.ConstrainPositions = false;
    EXPECT_FALSE(deformer->Serves(copy)) << name;
    copy = problem;
    copy.Rest = std::make_shared<const Points>(*problem.Rest);
    EXPECT_FALSE(deformer->Serves(copy)) << name;
  }
}

TEST(SurfaceDeformer, FramesThatMoveFreelyMakeEveryMovingHandleCount)
{
  HandleProblem more = ThreeHandles(8);
  more.Moving = { 2, 3 };
  more.ConstrainPositions = false;
  HandleProblem fewer = more;
  fewer.Moving = { 2 };
  const auto deformer = deformers::All()["RotationInvariant"](more, {});
  EXPECT_TRUE(deformer->Serves(more));
  EXPECT_FALSE(deformer->Serves(fewer));
}

TEST(SurfaceDeformer, BytesGrowWithTheSurface)
{
  const HandleProblem small = ThreeHandles(16);
  const HandleProblem large = ThreeHandles(64);
  for (const auto& [name, make] : deformers::All())
  {
    const auto ofSmall = make(small, {});
    const auto ofLarge = make(large, {});
    // A factor of some entries per unknown at the least.
    const auto free = static_cast<std::size_t>(ofLarge->GetNumberOfFreeVertices());
    EXPECT_GT(ofLarge->GetBytes(), 100 * free) << name;
    EXPECT_GT(ofLarge->GetBytes(), 2 * ofSmall->GetBytes()) << name;
    EXPECT_LT(ofLarge->GetBytes(), 20 * ofSmall->GetBytes()) << name;
  }
}
}
