// SPDX-License-Identifier: BSD-3-Clause
#include "HandleShapes.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Base/Constants.h"
#include "Kernel/Deformation/LaplacianDeformer.h"
#include "Kernel/Deformation/RotationInvariantDeformer.h"
#include "Kernel/Deformation/ShapePreservingDeformer.h"

#include <gtest/gtest.h>

using namespace cartan;

/// Motions that are sums over kept fields, with and without a surface in memory.
namespace
{
HandleMotion TurnedAndShifted(
  double degrees, const Eigen::Vector3d& translation, double scale = 1.0)
{
  HandleMotion motion;
  motion.RotationVector = degrees / 180.0 * Pi * Eigen::Vector3d(0.3, 1.0, 0.2).normalized();
  motion.Linear = scale * RotationFromVector(motion.RotationVector);
  motion.Translation = translation;
  return motion;
}

/// A bar with uneven edges whose ends are handles 1 and 2, and a part in which nothing moves.
HandleProblem UnevenBarProblem(const std::vector<int>& moving = { 2 })
{
  const shapes::Shape bar = shapes::Noisy(shapes::Bar(4, 4, 30, { 1.0, 1.0, 6.0 }), 0.02);
  const shapes::HandleOf ends = shapes::EndsAlong(bar, 2, 0.15);
  const double middle = bar.Positions.col(2).mean();
  return shapes::ProblemOf(
    bar,
    [&](const Eigen::Vector3d& x) {
      return ends(x) ? ends(x) : std::abs(x[2] - middle) < 0.4 && moving.size() == 1 ? 3 : 0;
    },
    moving);
}

Points FromRows(const PositionRows& rows, int count, int step)
{
  Points positions = Points::Constant(count, 3, -1.0);
  for (int begin = 0; begin < count; begin += step)
  {
    rows(begin, std::min(begin + step, count), positions.data() + 3 * begin);
  }
  return positions;
}

/// The rows of one deformer are the surface of another, whatever the ranges are.
template <typename Deformer>
void ExpectSameRows(Deformer& inRows, Deformer& whole, const HandleTargets& targets)
{
  DeformedSurface unwritten;
  const PositionRows rows = inRows.DeformInRows(targets, unwritten, {});
  ASSERT_TRUE(rows);
  EXPECT_EQ(unwritten.Positions.rows(), 0);
  DeformedSurface result;
  whole.Deform(targets, false, result, {});
  const int count = static_cast<int>(result.Positions.rows());
  EXPECT_GT((result.Positions - *whole.GetProblem().Rest).norm(), 0.1);
  for (const int step : { 1, 7, PositionBlock, count })
  {
    EXPECT_TRUE(FromRows(rows, count, step) == result.Positions) << step;
  }
}

TEST(PositionRows, AreTheSurfaceToTheLastBit)
{
  for (const std::vector<int>& moving : { std::vector<int>{ 2 }, std::vector<int>{ 1, 2 } })
  {
    HandleTargets targets;
    for (const int handle : moving)
    {
      targets.Motions.push_back(TurnedAndShifted(20.0 * handle, { 0.1 * handle, 0.2, -0.3 }, 1.1));
    }
    RotationInvariantDeformer inRows(UnevenBarProblem(moving));
    RotationInvariantDeformer whole(UnevenBarProblem(moving));
    ExpectSameRows(inRows, whole, targets);
  }
}

TEST(PositionRows, AreThereForSoftHandles)
{
  HandleProblem problem = UnevenBarProblem();
  problem.SoftWeights.setConstant(problem.Rest->rows(), 2.0);
  HandleTargets targets;
  targets.Motions.push_back(TurnedAndShifted(0.0, { 0.5, 0.0, 0.1 }, 1.2));
  RotationInvariantDeformer inRows(problem);
  RotationInvariantDeformer whole(problem);
  ExpectSameRows(inRows, whole, targets);
}

TEST(PositionRows, AreThereForTables)
{
  const HandleProblem problem = UnevenBarProblem();
  HandleTargets targets;
  targets.Motions.push_back(TurnedAndShifted(70.0, { 0.1, 0.2, -0.3 }));
  ShapePreservingDeformer inRows(problem);
  ShapePreservingDeformer whole(problem);
  inRows.SetTurnTable({ Pi, 1e-5 });
  whole.SetTurnTable({ Pi, 1e-5 });
  ExpectSameRows(inRows, whole, targets);
  EXPECT_NE(inRows.GetUsedTable(), nullptr);
}

TEST(PositionRows, AreNotThereWhereMoreThanASumIsNeeded)
{
  const HandleProblem problem = UnevenBarProblem();
  const auto expectWritten =
    [&](SurfaceDeformer& first, SurfaceDeformer& second, const HandleTargets& targets)
  {
    DeformedSurface written;
    EXPECT_FALSE(first.DeformInRows(targets, written, {}));
    DeformedSurface result;
    second.Deform(targets, false, result, {});
    ASSERT_EQ(written.Positions.rows(), problem.Rest->rows());
    EXPECT_TRUE(written.Positions == result.Positions);
  };
  HandleTargets targets;
  targets.Motions.push_back(TurnedAndShifted(70.0, { 0.1, 0.2, -0.3 }));
  ShapePreservingDeformer shape(problem);
  ShapePreservingDeformer otherShape(problem);
  expectWritten(shape, otherShape, targets);
  // A region all of whose handles move alike follows them exactly.
  RotationInvariantDeformer rigid(problem);
  RotationInvariantDeformer otherRigid(problem);
  rigid.SetFrameProjection(FrameProjection::None);
  otherRigid.SetFrameProjection(FrameProjection::None);
  targets.Motions[0] = HandleMotion();
  expectWritten(rigid, otherRigid, targets);
}

/// Motions of handles, and the same as a target for each vertex, which are solved for.
TEST(PositionRows, LaplacianEditingWithoutRotationsIsASum)
{
  for (const bool isSoft : { false, true })
  {
    HandleProblem problem = UnevenBarProblem({ 1, 2 });
    problem.SoftWeights.setConstant(isSoft ? problem.Rest->rows() : 0, 3.0);
    // Far from the surface, the translation and the rotation nearly cancel.
    const Eigen::Vector3d center(1e4, -2e4, 1e4);
    HandleTargets motions;
    motions.Motions = { TurnedAndShifted(5.0, { 0.3, 0.0, 0.1 }),
      TurnedAndShifted(0.001, { 0.0, 0.0, 0.0 }) };
    motions.Motions[1].Translation = center - motions.Motions[1].Linear * center;
    HandleTargets points = motions;
    for (int v = 0; v < static_cast<int>(problem.Handle.size()); ++v)
    {
      if (problem.Handle[v] > 0)
      {
        points.Vertices.push_back(v);
      }
    }
    points.Positions.resize(static_cast<Eigen::Index>(points.Vertices.size()), 3);
    for (std::size_t i = 0; i < points.Vertices.size(); ++i)
    {
      const int v = points.Vertices[i];
      const HandleMotion& motion = motions.Motions[problem.Handle[v] - 1];
      points.Positions.row(static_cast<Eigen::Index>(i)) =
        (motion.Linear * problem.Rest->row(v).transpose() + motion.Translation).transpose();
    }
    LaplacianDeformer summed(problem, LaplacianRotations::None);
    LaplacianDeformer solved(problem, LaplacianRotations::None);
    DeformedSurface sum;
    DeformedSurface solution;
    summed.Deform(motions, false, sum, {});
    solved.Deform(points, false, solution, {});
    EXPECT_GT((sum.Positions - *problem.Rest).rowwise().norm().maxCoeff(), 0.2);
    EXPECT_LT((sum.Positions - solution.Positions).rowwise().norm().maxCoeff(), 1e-8) << isSoft;
  }
}
}
