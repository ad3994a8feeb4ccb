// SPDX-License-Identifier: BSD-3-Clause
#include "AllDeformers.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Mesh/Geometry.h"
#include "RealMeshes.h"

#include <gtest/gtest.h>

using cartan::DeformedSurface;
using cartan::HandleProblem;
using cartan::HandleTargets;
using cartan::Points;
using cartan::TriangleMesh;
using shapes::Shape;

namespace
{
/// A bumpy tube with handles 1 to `count` around it, every third of them pinned,
/// rings at first and single points in between.
HandleProblem TubeWithHandles(int count)
{
  const Shape tube = shapes::Noisy(shapes::OpenCylinder(16, 30, 1.0, 6.0), 0.02);
  HandleProblem problem;
  problem.Mesh = std::make_shared<const TriangleMesh>(shapes::MakeMesh(tube));
  problem.Rest = std::make_shared<const Points>(tube.Positions);
  problem.Handle.assign(tube.NumberOfVertices(), 0);
  for (int k = 0; k < count; ++k)
  {
    const int seed = (2 * k + 1) * tube.NumberOfVertices() / (2 * count);
    problem.Handle[seed] = k + 1;
    for (int d = problem.Mesh->RingBegin(seed); d < problem.Mesh->RingEnd(seed); ++d)
    {
      problem.Handle[problem.Mesh->Neighbor(d)] = k + 1;
    }
    if (k % 3 != 0)
    {
      problem.Moving.push_back(k + 1);
    }
  }
  return problem;
}

/// Turns about many axes, or about one; with scales, or rigid.
HandleTargets MakeTargets(const HandleProblem& problem, bool hasOneAxis, bool isRigid)
{
  HandleTargets targets;
  for (std::size_t k = 0; k < problem.Moving.size(); ++k)
  {
    const double angle = 0.3 + 0.1 * static_cast<double>(k);
    cartan::HandleMotion motion;
    motion.RotationVector =
      angle * (hasOneAxis || k % 2 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX());
    motion.Linear = cartan::RotationFromVector(motion.RotationVector) *
      (isRigid ? 1.0 : 1.0 + 0.1 * static_cast<double>(k));
    motion.Translation = Eigen::Vector3d(0.2, -0.1 * static_cast<double>(k), 0.3);
    targets.Motions.push_back(motion);
  }
  return targets;
}
}

// One solve per motion finds what fields that are kept find.
TEST(ManyHandles, StoredFieldsAndSolvesAgree)
{
  for (const bool isSoft : { false, true })
  {
    HandleProblem stored = TubeWithHandles(7);
    if (isSoft)
    {
      stored.SoftWeights.setConstant(static_cast<Eigen::Index>(stored.Handle.size()), 0.7);
    }
    HandleProblem solved = stored;
    solved.StoredHandles = 6;
    ASSERT_TRUE(cartan::StoresHandleFields(stored));
    ASSERT_FALSE(cartan::StoresHandleFields(solved));
    for (const auto& [name, make] : deformers::All())
    {
      const auto ofStored = make(stored, {});
      const auto ofSolved = make(solved, {});
      for (const bool hasOneAxis : { false, true })
      {
        for (const bool isRigid : { false, true })
        {
          const HandleTargets targets = MakeTargets(stored, hasOneAxis, isRigid);
          DeformedSurface a;
          DeformedSurface b;
          ofStored->Deform(targets, true, a, {});
          ofSolved->Deform(targets, true, b, {});
          EXPECT_LT((a.Positions - b.Positions).cwiseAbs().maxCoeff(), 1e-12)
            << name << " soft " << isSoft << " axis " << hasOneAxis << " rigid " << isRigid;
          EXPECT_LT((a.Transforms - b.Transforms).cwiseAbs().maxCoeff(), 1e-12) << name;
        }
      }
    }
  }
}

// What is kept does not grow with the number of handles beyond that.
TEST(ManyHandles, MemoryDoesNotGrowWithTheirNumber)
{
  for (const std::string name : { "RotationInvariant", "ShapePreserving", "PoissonHarmonic",
         "SimilarityEdgeForm", "Multiresolution2" })
  {
    std::size_t bytes[2];
    for (const int count : { 6, 12 })
    {
      HandleProblem problem = TubeWithHandles(count);
      problem.StoredHandles = 0;
      const auto deformer = deformers::All()[name](problem, {});
      DeformedSurface result;
      deformer->Deform(MakeTargets(problem, false, false), false, result, {});
      bytes[count / 12] = deformer->GetBytes();
    }
    // Stored fields would double. The factors differ a little with what is held.
    EXPECT_LT(bytes[1], 1.1 * bytes[0]) << name;
  }
}
