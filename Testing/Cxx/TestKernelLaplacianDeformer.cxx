// SPDX-License-Identifier: BSD-3-Clause
#include "HandleShapes.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Deformation/LaplacianDeformer.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{
using cartan::HandleMotion;
using cartan::HandleProblem;
using cartan::HandleTargets;
using cartan::LaplacianRotations;
using cartan::Points;

/// A bar whose lower end is pinned (handle 2), while the upper one turns and moves (handle 1).
struct TurnedBar
{
  TurnedBar()
  {
    this->Shape.Positions.rowwise() -= this->Shape.Positions.colwise().minCoeff().eval();
    this->Problem = shapes::ProblemOf(this->Shape,
      [](const Eigen::Vector3d& x) { return x[2] <= 1.0 + 1e-9 ? 2
                                       : x[2] >= 5.0 - 1e-9    ? 1
                                                               : 0; },
      { 1 });
    HandleMotion motion;
    motion.RotationVector = { 0.7, -0.3, 0.5 };
    motion.Linear = cartan::RotationFromVector(motion.RotationVector);
    motion.Translation = { 0.3, 2.0, -0.4 };
    this->Targets.Motions = { motion };
  }

  shapes::Shape Shape = shapes::Bar(5, 5, 30, { 1.0, 1.0, 6.0 }, true);
  HandleProblem Problem;
  HandleTargets Targets;
};

/// The handles' vertices where motions take them, one by one, for which methods solve.
HandleTargets VertexByVertex(const HandleProblem& problem, const HandleTargets& targets)
{
  const std::vector<int> moving = cartan::MovingHandleOfVertices(problem);
  const Points positions = cartan::HandlePositions(problem, targets, moving);
  HandleTargets each;
  for (Eigen::Index v = 0; v < positions.rows(); ++v)
  {
    if (moving[v] >= 0)
    {
      each.Vertices.push_back(static_cast<int>(v));
    }
  }
  each.Positions = positions(each.Vertices, Eigen::all);
  return each;
}

}

TEST(LaplacianDeformer, SumsOverHandlesAreWhatASolveGives)
{
  TurnedBar bar;
  // A third handle, held softly, in the middle of one side; and the ends.
  for (int v = 0; v < bar.Shape.NumberOfVertices(); ++v)
  {
    const Eigen::Vector3d x = bar.Shape.Positions.row(v);
    bar.Problem.Handle[v] = bar.Problem.Handle[v] == 0 && x[0] < 1e-9 && std::abs(x[2] - 3.0) < 0.4
      ? 3
      : bar.Problem.Handle[v];
  }
  bar.Problem.Moving = { 1, 3 };
  bar.Problem.SoftWeights = Eigen::VectorXd::Zero(bar.Shape.NumberOfVertices());
  for (int v = 0; v < bar.Shape.NumberOfVertices(); ++v)
  {
    bar.Problem.SoftWeights[v] =
      bar.Problem.Handle[v] == 3 ? 0.5 : std::numeric_limits<double>::infinity();
  }
  HandleMotion stretch;
  stretch.Linear << 1.1, 0.2, 0.0, -0.1, 0.9, 0.3, 0.0, 0.1, 1.2;
  stretch.Translation = { 0.1, -0.2, 0.3 };
  bar.Targets.Motions.push_back(stretch);
  for (const LaplacianRotations rotations :
    { LaplacianRotations::None, LaplacianRotations::Estimated, LaplacianRotations::Implicit })
  {
    cartan::LaplacianDeformer deformer(bar.Problem, rotations);
    cartan::DeformedSurface summed;
    deformer.Deform(bar.Targets, true, summed, {});
    cartan::DeformedSurface solved;
    deformer.Deform(VertexByVertex(bar.Problem, bar.Targets), true, solved, {});
    const auto name = static_cast<int>(rotations);
    EXPECT_LT((summed.Positions - solved.Positions).cwiseAbs().maxCoeff(), 1e-10) << name;
    EXPECT_LT((summed.Transforms - solved.Transforms).cwiseAbs().maxCoeff(), 1e-10) << name;

    // What moved before makes no difference, to the last bit.
    cartan::LaplacianDeformer fresh(bar.Problem, rotations);
    cartan::DeformedSurface result;
    fresh.Deform(VertexByVertex(bar.Problem, bar.Targets), true, result, {});
    EXPECT_EQ(result.Positions, solved.Positions) << name;
    deformer.Deform(bar.Targets, true, result, {});
    EXPECT_EQ(result.Positions, summed.Positions) << name;
  }
}

TEST(LaplacianDeformer, SolvesForTheMotionsOfManyHandles)
{
  // Of five handles on two sides each motion is solved for; as one handle, they are summed.
  TurnedBar bar;
  HandleProblem split = bar.Problem;
  split.Moving = { 1, 3, 4, 5, 6 };
  for (int v = 0; v < bar.Shape.NumberOfVertices(); ++v)
  {
    if (split.Handle[v] == 1)
    {
      const Eigen::Vector3d x = bar.Shape.Positions.row(v);
      split.Handle[v] = x[0] < 0.3 ? 1 : x[0] > 0.7 ? 3 : x[1] < 0.3 ? 4 : x[1] > 0.7 ? 5 : 6;
    }
  }
  HandleTargets all;
  all.Motions.assign(5, bar.Targets.Motions[0]);
  for (const LaplacianRotations rotations :
    { LaplacianRotations::None, LaplacianRotations::Estimated, LaplacianRotations::Implicit })
  {
    cartan::DeformedSurface ofOne;
    cartan::LaplacianDeformer(bar.Problem, rotations).Deform(bar.Targets, true, ofOne, {});
    cartan::DeformedSurface ofFive;
    cartan::LaplacianDeformer(split, rotations).Deform(all, true, ofFive, {});
    EXPECT_LT((ofOne.Positions - ofFive.Positions).cwiseAbs().maxCoeff(), 1e-10)
      << static_cast<int>(rotations);
  }
}

TEST(LaplacianDeformer, ImplicitRotationsAreTheClosestToTheirSimilarities)
{
  // Handles that all stretch by s alike leave similarities s I, also inside out, of which one
  // rotation is chosen.
  TurnedBar bar;
  bar.Problem.Moving = { 1, 2 };
  for (const double scale : { 1.5, 0.5, -0.5 })
  {
    HandleMotion motion;
    motion.Linear = scale * Eigen::Matrix3d::Identity();
    bar.Targets.Motions = { motion, motion };
    cartan::LaplacianDeformer deformer(bar.Problem, LaplacianRotations::Implicit);
    cartan::DeformedSurface result;
    deformer.Deform(bar.Targets, true, result, {});
    for (int v = 0; v < bar.Shape.NumberOfVertices(); ++v)
    {
      const Eigen::Matrix3d rotation = cartan::MatrixAt(result.Transforms, v);
      ASSERT_LT((rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm(), 1e-12) << v;
      ASSERT_NEAR(rotation.determinant(), 1.0, 1e-12) << v;
      ASSERT_TRUE(scale < 0.0 || rotation.isIdentity(1e-9)) << v;
    }
  }
}
