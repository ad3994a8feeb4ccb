// SPDX-License-Identifier: BSD-3-Clause
#include "AllDeformers.h"
#include "HandleShapes.h"
#include "Ids.h"
#include "Kernel/Algebra/Rotation.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

/// What every deformation method promises.
namespace
{
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

/// The third handle turned as a whole, the second more and more along z: with rows
/// for those of `vertices`.
HandleTargets TargetsOf(const HandleProblem& problem, const std::vector<int>& vertices)
{
  HandleTargets targets;
  targets.Motions.resize(2);
  targets.Vertices = vertices;
  targets.Positions = (*problem.Rest)(vertices, Eigen::all);
  targets.Transforms = cartan::Identities(targets.Positions.rows());
  targets.RotationVectors = Points::Zero(targets.Positions.rows(), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    const auto row = static_cast<Eigen::Index>(i);
    const double z = targets.Positions(row, 2);
    targets.RotationVectors.row(row) << 0.2, 0.1, problem.Handle[vertices[i]] == 2 ? 0.3 * z : 0.4;
    cartan::MatrixAt(targets.Transforms, row) =
      cartan::RotationFromVector(targets.RotationVectors.row(row).transpose());
    targets.Positions.row(row) *= cartan::MatrixAt(targets.Transforms, row).transpose();
  }
  return targets;
}

TEST(SurfaceDeformer, ReadsTargetsOfMovingHandlesAlone)
{
  for (const bool isAnyPinned : { true, false })
  {
    HandleProblem problem = ThreeHandles(8);
    problem.Moving = { 2, 3 };
    std::vector<int> moving;
    for (int v = 0; v < problem.Mesh->NumberOfVertices(); ++v)
    {
      problem.Handle[v] = !isAnyPinned && problem.Handle[v] == 1 ? 0 : problem.Handle[v];
      if (problem.Handle[v] > 1)
      {
        moving.push_back(v);
      }
    }
    const std::vector<int> all = shapes::Ids(problem.Mesh->NumberOfVertices());
    for (const auto& [name, make] : deformers::All())
    {
      if (name.rfind("Poisson", 0) == 0)
      {
        continue; // one motion per handle
      }
      const auto deformer = make(problem, {});
      cartan::DeformedSurface expected;
      deformer->Deform(TargetsOf(problem, all), true, expected, {});
      cartan::DeformedSurface found;
      deformer->Deform(TargetsOf(problem, moving), true, found, {});
      EXPECT_EQ(found.Positions, expected.Positions) << name;
      EXPECT_EQ(found.Transforms, expected.Transforms) << name;
      for (const int v : moving)
      {
        const Eigen::RowVector3d place =
          TargetsOf(problem, all).Positions.row(v) - found.Positions.row(v);
        EXPECT_LT(place.norm(), 1e-12) << name << " at " << v;
      }
    }
  }
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
