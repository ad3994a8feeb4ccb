// SPDX-License-Identifier: BSD-3-Clause
#include "HandleShapes.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Base/Constants.h"
#include "Kernel/Deformation/RotationInvariantDeformer.h"
#include "Kernel/Deformation/ShapePreservingDeformer.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace cartan;

namespace
{
constexpr double Degree = Pi / 180.0;
constexpr double Tolerance = 1e-5; ///< of the diagonal

HandleMotion Turn(const Eigen::Vector3d& axis, double degrees, const Eigen::Vector3d& translation)
{
  HandleMotion motion;
  motion.RotationVector = degrees * Degree * axis.normalized();
  motion.Linear = RotationFromVector(motion.RotationVector);
  motion.Translation = translation;
  return motion;
}

HandleTargets One(const Eigen::Vector3d& axis, double degrees,
  const Eigen::Vector3d& translation = Eigen::Vector3d::Zero())
{
  HandleTargets targets;
  targets.Motions.push_back(Turn(axis, degrees, translation));
  return targets;
}

/// A bar of 1 x 1 x 5 with uneven edges, held at both ends.
shapes::Shape Bar()
{
  return shapes::Noisy(shapes::Bar(5, 5, 25, { 1.0, 1.0, 5.0 }), 0.02);
}

HandleProblem BarProblem()
{
  const shapes::Shape bar = Bar();
  return shapes::ProblemOf(bar, shapes::EndsAlong(bar, 2, 0.15));
}

double Diagonal(const HandleProblem& problem)
{
  return (problem.Rest->colwise().maxCoeff() - problem.Rest->colwise().minCoeff()).norm();
}

template <typename Deformer>
Points Positions(Deformer& deformer, const HandleTargets& targets)
{
  DeformedSurface result;
  deformer.Deform(targets, false, result, {});
  return result.Positions;
}

double Distance(const Points& a, const Points& b)
{
  return (a - b).rowwise().norm().maxCoeff();
}

TurnTable::Options Options(const HandleProblem& problem, double degrees = 180.0)
{
  return { degrees * Degree, Tolerance * Diagonal(problem) };
}

/// Gives a bar the offsets of the neutral offset: from its axis to its skin.
std::shared_ptr<const VolumeModel> ModelOf(const HandleProblem& problem)
{
  auto model = std::make_shared<VolumeModel>();
  model->LocalDepth = Eigen::VectorXd::Ones(problem.Rest->rows());
  model->Offsets = *problem.Rest;
  model->Offsets.leftCols<2>().rowwise() -= model->Offsets.leftCols<2>().colwise().mean().eval();
  model->Offsets.col(2).setZero();
  model->EnclosesVolume = { 1 };
  model->Volumes = { 5.0 };
  model->IsMeasured.assign(problem.Handle.size(), 1);
  return model;
}

/// Motions within the tolerance of those that a second deformer solves for.
template <typename Deformer>
void ExpectAsSolved(Deformer& tabulated, Deformer& solved, double largest)
{
  const double tolerance = Tolerance * Diagonal(tabulated.GetProblem());
  const Eigen::Vector3d axes[] = { { 1.0, 0.0, 0.0 }, { 0.3, -0.5, 0.8 }, { 0.0, 0.0, 1.0 } };
  for (const Eigen::Vector3d& axis : axes)
  {
    for (const double part : { -1.0, -0.63, -0.05, 0.0, 1e-3, 0.31, 0.5, 0.77, 0.999 })
    {
      const HandleTargets targets = One(axis, part * largest, { 0.4, -0.2, 0.1 });
      const Points table = Positions(tabulated, targets);
      ASSERT_NE(tabulated.GetUsedTable(), nullptr) << part;
      EXPECT_LT(tabulated.GetUsedTable()->GetError(), tolerance);
      EXPECT_LT(Distance(table, Positions(solved, targets)), tolerance) << part << " " << axis;
    }
  }
}
}

TEST(TurnTable, OfShapePreservingEqualsTheSolution)
{
  const HandleProblem problem = BarProblem();
  ShapePreservingDeformer tabulated(problem);
  ShapePreservingDeformer solved(problem);
  tabulated.SetTurnTable(Options(problem));
  ExpectAsSolved(tabulated, solved, 180.0);
  EXPECT_DOUBLE_EQ(tabulated.GetUsedTable()->GetRange(), Pi);
  EXPECT_EQ(solved.GetUsedTable(), nullptr);
}

TEST(TurnTable, ServesFullTurns)
{
  const HandleProblem problem = BarProblem();
  ShapePreservingDeformer tabulated(problem);
  ShapePreservingDeformer solved(problem);
  tabulated.SetTurnTable(Options(problem, 720.0));
  ExpectAsSolved(tabulated, solved, 720.0);
}

/// Where no table is good enough, motions are solved for, those without a turn too.
TEST(TurnTable, IsNotReadWhereItCouldNotBeMade)
{
  const HandleProblem problem = BarProblem();
  ShapePreservingDeformer tabulated(problem);
  ShapePreservingDeformer solved(problem);
  tabulated.SetTurnTable({ Pi, 1e-30 });
  for (const double degrees : { 0.0, 20.0, 0.0 })
  {
    const HandleTargets targets = One({ 1.0, 0.0, 0.0 }, degrees, { 0.3, 0.2, 0.1 });
    EXPECT_LT(Distance(Positions(tabulated, targets), Positions(solved, targets)), 1e-12);
    EXPECT_EQ(tabulated.GetUsedTable(), nullptr);
  }
}

TEST(TurnTable, CarriesTheNeutralOffset)
{
  const HandleProblem problem = BarProblem();
  ShapePreservingDeformer tabulated(problem);
  ShapePreservingDeformer solved(problem);
  const auto model = ModelOf(problem);
  for (ShapePreservingDeformer* deformer : { &tabulated, &solved })
  {
    deformer->SetVolumeModel(model);
    deformer->SetVolumeCorrection(VolumeCorrection::NeutralOffset);
  }
  const Points plain = Positions(solved, One({ 1.0, 0.0, 0.0 }, 90.0));
  tabulated.SetTurnTable(Options(problem));
  ExpectAsSolved(tabulated, solved, 180.0);
  // It is not the table without offsets.
  tabulated.SetVolumeCorrection(VolumeCorrection::None);
  const Points without = Positions(tabulated, One({ 1.0, 0.0, 0.0 }, 90.0));
  ASSERT_NE(tabulated.GetUsedTable(), nullptr);
  EXPECT_GT(Distance(plain, without), 0.01);
  solved.SetVolumeCorrection(VolumeCorrection::None);
  EXPECT_LT(Distance(without, Positions(solved, One({ 1.0, 0.0, 0.0 }, 90.0))),
    Tolerance * Diagonal(problem));
}

// Blends of rotations and the identity vanish at half a turn: near it no polynomial is close.
TEST(TurnTable, OfRotationInvariantIsShorter)
{
  const HandleProblem problem = BarProblem();
  RotationInvariantDeformer tabulated(problem);
  RotationInvariantDeformer solved(problem);
  // Also where nothing turns, which is a sum over fields else.
  tabulated.SetFrameProjection(FrameProjection::Rotation);
  solved.SetFrameProjection(FrameProjection::Rotation);
  tabulated.SetTurnTable(Options(problem));
  Positions(tabulated, One({ 1.0, 0.0, 0.0 }, 10.0));
  ASSERT_NE(tabulated.GetUsedTable(), nullptr);
  const double range = tabulated.GetUsedTable()->GetRange();
  EXPECT_GT(range, 90.0 * Degree);
  EXPECT_LT(range, Pi);
  ExpectAsSolved(tabulated, solved, 0.99999 * range / Degree);
  // Beyond, it is solved for.
  const HandleTargets beyond = One({ 1.0, 0.0, 0.0 }, range / Degree + 1.0);
  EXPECT_EQ(Distance(Positions(tabulated, beyond), Positions(solved, beyond)), 0.0);
  EXPECT_EQ(tabulated.GetUsedTable(), nullptr);
}

TEST(TurnTable, ServesSoftHandlesOtherWeightsAndFreeEnds)
{
  for (const int kind : { 0, 1, 2 })
  {
    SCOPED_TRACE(kind);
    HandleProblem problem = BarProblem();
    if (kind == 0)
    {
      problem.SoftWeights =
        Eigen::VectorXd::Constant(static_cast<Eigen::Index>(problem.Handle.size()), 0.7);
    }
    problem.PositionWeights = kind == 1 ? LaplacianWeights::Uniform : LaplacianWeights::Cotangent;
    problem.ConstrainPositions = kind != 2;
    ShapePreservingDeformer tabulated(problem);
    ShapePreservingDeformer solved(problem);
    tabulated.SetTurnTable(Options(problem));
    ExpectAsSolved(tabulated, solved, 180.0);
  }
}

TEST(TurnTable, ServesHandlesInAFixedRatio)
{
  HandleProblem problem = BarProblem();
  const shapes::Shape bar = Bar();
  for (std::size_t v = 0; v < problem.Handle.size(); ++v)
  {
    const double height = bar.Positions(static_cast<Eigen::Index>(v), 2);
    problem.Handle[v] = std::abs(height - 2.5) < 0.2 ? 3 : problem.Handle[v];
  }
  problem.Moving = { 2, 3 };
  ShapePreservingDeformer tabulated(problem);
  ShapePreservingDeformer solved(problem);
  tabulated.SetTurnTable(Options(problem));
  const auto both = [](double first, double second)
  {
    HandleTargets targets = One({ 1.0, 0.2, 0.0 }, first, { 0.1, 0.0, 0.0 });
    targets.Motions.push_back(Turn({ 1.0, 0.2, 0.0 }, second, { 0.0, 0.2, 0.0 }));
    return targets;
  };
  const double tolerance = Tolerance * Diagonal(problem);
  for (const double angle : { 40.0, -70.0, 150.0 })
  {
    const HandleTargets targets = both(angle, 0.4 * angle);
    EXPECT_LT(Distance(Positions(tabulated, targets), Positions(solved, targets)), tolerance);
    EXPECT_NE(tabulated.GetUsedTable(), nullptr);
  }
  // Another ratio is solved for; when it comes again, it gets a table.
  const HandleTargets other = both(60.0, 60.0);
  EXPECT_EQ(Distance(Positions(tabulated, other), Positions(solved, other)), 0.0);
  EXPECT_EQ(tabulated.GetUsedTable(), nullptr);
  const HandleTargets again = both(50.0, 50.0);
  EXPECT_LT(Distance(Positions(tabulated, again), Positions(solved, again)), tolerance);
  EXPECT_NE(tabulated.GetUsedTable(), nullptr);
}

TEST(TurnTable, LeavesOtherMotionsToTheSolver)
{
  const HandleProblem problem = BarProblem();
  ShapePreservingDeformer tabulated(problem);
  ShapePreservingDeformer solved(problem);
  tabulated.SetTurnTable(Options(problem, 90.0));
  HandleTargets scaled = One({ 1.0, 0.0, 0.0 }, 30.0);
  scaled.Motions[0].Linear *= 1.1;
  for (const HandleTargets& targets : { scaled, One({ 1.0, 0.0, 0.0 }, 90.1) })
  {
    EXPECT_EQ(Distance(Positions(tabulated, targets), Positions(solved, targets)), 0.0);
    EXPECT_EQ(tabulated.GetUsedTable(), nullptr);
  }
  tabulated.SetTurnTable({});
  const HandleTargets turn = One({ 1.0, 0.0, 0.0 }, 60.0);
  EXPECT_EQ(Distance(Positions(tabulated, turn), Positions(solved, turn)), 0.0);
}

// The frames that come with the positions are those of the method, exactly.
TEST(TurnTable, LeavesTheFrames)
{
  const HandleProblem problem = BarProblem();
  ShapePreservingDeformer tabulated(problem);
  ShapePreservingDeformer solved(problem);
  tabulated.SetTurnTable(Options(problem));
  DeformedSurface table;
  DeformedSurface solution;
  const HandleTargets targets = One({ 1.0, 1.0, 0.0 }, 80.0);
  tabulated.Deform(targets, true, table, {});
  solved.Deform(targets, true, solution, {});
  EXPECT_EQ((table.Transforms - solution.Transforms).cwiseAbs().maxCoeff(), 0.0);
}
