// SPDX-License-Identifier: BSD-3-Clause
// What the deformation methods advise.
#include "Advice.h"

#include "vtkAsRigidAsPossibleDeformation.h"
#include "vtkLaplacianDeformation.h"
#include "vtkMultiresolutionDeformation.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkShapePreservingDeformation.h"
#include "vtkSimilarityDeformation.h"

#include "Bridge/DeformationMethod.h"
#include "Kernel/Algebra/SymmetricSolver.h"
#include "Kernel/Base/Error.h"

#include <cmath>

using vtktest::Advice;
using vtktest::Advised;
using vtktest::MarkedBar;
using vtktest::Turn;

namespace
{
const Eigen::Vector3d X = Eigen::Vector3d::UnitX();
const Eigen::Vector3d Y = Eigen::Vector3d::UnitY();

/// Between two handles there is one axis; a pinned point amid the first makes two.
vtkSmartPointer<vtkPolyData> BarWithPinnedPoint()
{
  auto bar = MarkedBar();
  bar->GetPointData()->GetArray("Handle")->SetTuple1(bar->FindPoint(0.0, 0.0, 0.0), 3.0);
  return bar;
}

/// The bar with all its points in handles but those between these heights.
vtkSmartPointer<vtkPolyData> BarFreeBetween(double low, double high)
{
  auto bar = MarkedBar();
  vtktest::MarkEnds(bar, low, high);
  return bar;
}
}

TEST(AdviceOnDeformations, APointOfEachPartIsFixed)
{
  // Handles that give directions only, on two bars.
  const shapes::Shape one = shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 });
  shapes::Shape other = one;
  other.Positions.col(0).array() += 3.0;
  for (const bool areTwo : { false, true })
  {
    const auto bars = vtktest::MakePolyData(areTwo ? shapes::Union(one, other) : one);
    vtktest::MarkEnds(bars, 0.6, 3.4);
    Advised<vtkShapePreservingDeformation> deform;
    deform->SetInputData(bars);
    deform->ConstrainHandlePositionsOff();
    deform->SetHandleMotion(1, Turn(10.0));
    deform->SetHandleMotion(2, Turn(40.0));
    const std::string message =
      deform.Refuses({ "The system is singular: " + std::to_string(bars->GetNumberOfPoints()) +
          " points (ids 0, 1, 2, 3, 4, ...)",
        areTwo ? Advice("2 connected parts have no constraint. In each part, fix")
               : Advice("connected part have no constraint. Fix"),
        Advice("at least one point.") });
    vtkDataArray* handles = bars->GetPointData()->GetArray("Handle");
    for (int part = 0; part < (areTwo ? 2 : 1); ++part)
    {
      handles->SetTuple1(35 + 74 * part, 3); // a handle without motion
      ASSERT_EQ(handles->GetTuple1(36 + 74 * part), 0);
    }
    handles->Modified();
    const auto bent = deform.Works();
    for (int part = 0; part < (areTwo ? 2 : 1); ++part)
    {
      const vtkIdType v = 35 + 74 * part;
      EXPECT_EQ(Eigen::Vector3d(bent->GetPoint(v)), Eigen::Vector3d(bars->GetPoint(v)));
    }
  }
}

TEST(AdviceOnDeformations, AVolumeThatCannotBeClosedNeedsFreePointsOrLess)
{
  const auto motion = vtkSmartPointer<vtkHandleMotion>::New();
  motion->SetCenter(0.0, 0.0, 4.0);
  motion->SetScale(3.0, 3.0, 3.0);
  Advised<vtkRotationInvariantDeformation> deform;
  deform->SetHandleMotion(2, motion);
  deform->CloseVolumeOn();
  deform->SetInputData(BarFreeBetween(2.1, 2.1));
  deform.Warns({ "The volume of 1 component (id 0) could not be closed",
    Advice("Leave more points free, or deform less.") });
  deform->SetInputData(BarFreeBetween(0.6, 3.4));
  EXPECT_NEAR(vtktest::SignedVolume(deform.Works()), 4.0, 1e-9);
  deform->SetInputData(BarFreeBetween(2.1, 2.1));
  motion->SetScale(1.0, 1.0, 1.0);
  EXPECT_NEAR(vtktest::SignedVolume(deform.Works()), 4.0, 1e-9);
}

TEST(AdviceOnDeformations, SimilarityHoldsPositionsOrTransforms)
{
  Advised<vtkSimilarityDeformation> deform;
  const auto bar = MarkedBar();
  const auto motion = Turn(30.0);
  deform->SetInputData(bar);
  deform->SetHandleMotion(2, motion);
  deform->ConstrainHandlePositionsOff();
  deform->ConstrainHandleTransformsOff();
  deform.Refuses({ "so nothing moves",
    Advice("switch ConstrainHandlePositions or ConstrainHandleTransforms on.") });
  deform->ConstrainHandlePositionsOn();
  vtktest::ExpectEnds(deform.Works(), bar, motion);
  deform->ConstrainHandlePositionsOff();
  deform->ConstrainHandleTransformsOn();
  vtktest::ExpectHandle(deform.Works(), bar, 1); // the pinned one
}

TEST(AdviceOnDeformations, SimilarityHoldsAPositionInEachPart)
{
  Advised<vtkSimilarityDeformation> deform;
  const auto bar = MarkedBar();
  deform->SetInputData(bar);
  deform->SetHandleMotion(1, Turn(0.0));
  deform->SetHandleMotion(2, Turn(30.0));
  deform->ConstrainHandlePositionsOff();
  deform.Refuses({ "74 points (ids ", "in connected parts where no position is held",
    Advice("Pin a handle there, or switch ConstrainHandlePositions on.") });
  deform->ConstrainHandlePositionsOn();
  vtktest::ExpectEnds(deform.Works(), bar, Turn(30.0));
  deform->ConstrainHandlePositionsOff();
  deform->RemoveHandleMotion(1);
  vtktest::ExpectHandle(deform.Works(), bar, 1);
}

TEST(AdviceOnDeformations, SimilarityHoldsMoreThanAPlane)
{
  // One layer of points at one end, moved; nothing else is held.
  const auto planar = [](double below, int atMiddle)
  {
    auto bar = MarkedBar();
    vtktest::AddHandles(bar,
      [&](const Eigen::Vector3d& x) { return x.z() < below ? 2
                                        : x.z() == 2.0     ? atMiddle
                                                           : 0; });
    return bar;
  };
  Advised<vtkSimilarityDeformation> deform;
  const auto motion = Turn(30.0);
  deform->SetHandleMotion(2, motion);
  deform->ConstrainHandleTransformsOff();
  deform->SetInputData(planar(0.1, 0));
  deform.Refuses({ "65 points (ids ", "only positions in one plane are held",
    Advice("Pin a handle there, hold points outside of the plane too, or switch "
           "ConstrainHandleTransforms on.") });
  for (const auto& [bar, holdsTransforms] : { std::pair(planar(0.1, 1), false),
         std::pair(planar(0.6, 0), false), std::pair(planar(0.1, 0), true) })
  {
    deform->SetInputData(bar);
    deform->SetConstrainHandleTransforms(holdsTransforms);
    vtktest::ExpectEnds(deform.Works(), bar, motion);
  }
}

TEST(AdviceOnDeformations, SimilarityTakesPositiveScales)
{
  Advised<vtkSimilarityDeformation> deform;
  const auto motion = Turn(30.0);
  deform->SetInputData(MarkedBar());
  deform->SetHandleMotion(2, motion);
  motion->SetScale(-1.0, 1.0, 1.0);
  deform.Warns({ "The motion of 1 handle (id 2) mirrors", Advice("Use positive scales.") });
  motion->SetScale(0.0, 0.0, 0.0);
  deform.Warns({ "The motion of 1 handle (id 2) flattens", Advice("Use scales other than 0.") });
  motion->SetScale(0.5, 0.5, 0.5);
  vtktest::ExpectEnds(deform.Works(), MarkedBar(), motion);
}

template <typename Method>
class AdviceOnMethodsOfPositions : public ::testing::Test
{
};
using MethodsOfPositions = ::testing::Types<vtkLaplacianDeformation, vtkMultiresolutionDeformation>;
TYPED_TEST_SUITE(AdviceOnMethodsOfPositions, MethodsOfPositions);

TYPED_TEST(AdviceOnMethodsOfPositions, TheyHoldPositionsOrAMethodWithFramesHoldsNone)
{
  const auto bar = MarkedBar();
  const auto motion = Turn(30.0);
  Advised<TypeParam> deform;
  deform->SetInputData(bar);
  deform->SetHandleMotion(2, motion);
  deform->ConstrainHandlePositionsOff();
  deform.Refuses({ "knows handles by their positions only",
    Advice("turn ConstrainHandlePositions on, or choose a method with frames.") });
  deform->ConstrainHandlePositionsOn();
  vtktest::ExpectEnds(deform.Works(), bar, motion);
  Advised<vtkShapePreservingDeformation> withFrames;
  withFrames->SetInputData(bar);
  withFrames->SetHandleMotion(2, motion);
  withFrames->ConstrainHandlePositionsOff();
  vtktest::ExpectHandle(withFrames.Works(), bar, 1);
}

template <typename Method>
class AdviceOnMethodsWithAxes : public ::testing::Test
{
};
using MethodsWithAxes =
  ::testing::Types<vtkShapePreservingDeformation, vtkAsRigidAsPossibleDeformation>;
TYPED_TEST_SUITE(AdviceOnMethodsWithAxes, MethodsWithAxes);

TYPED_TEST(AdviceOnMethodsWithAxes, FullTurnsHaveOneAxisOrComeInSteps)
{
  const auto bar = BarWithPinnedPoint();
  const auto turned = Turn(400.0, Y);
  Advised<TypeParam> deform;
  deform->SetInputData(bar);
  deform->SetHandleMotion(1, Turn(10.0, X));
  deform->SetHandleMotion(2, turned);
  deform.Refuses({ "17 handle points turn", "by 360 degrees or more",
    Advice("give all handles the same axis, or turn in several steps.") });
  deform->SetHandleMotion(1, Turn(10.0, Y));
  vtktest::ExpectHandle(deform.Works(), bar, 2, turned);
  // Two steps: the second starts from the result of the first.
  deform->SetHandleMotion(1, Turn(5.0, X));
  deform->SetHandleMotion(2, Turn(200.0, Y));
  const auto half = deform.Works();
  deform->SetInputData(half);
  const auto whole = deform.Works();
  vtktest::ExpectHandle(whole, bar, 2, turned);
}

TEST(AdviceOnDeformations, RotationFieldsConvergeWithMoreIterationsOrInSteps)
{
  Advised<vtkShapePreservingDeformation> deform;
  const auto bar = BarWithPinnedPoint();
  deform->SetInputData(bar);
  deform->SetHandleMotion(1, Turn(60.0));
  deform->SetHandleMotion(2, Turn(120.0, Y));
  deform->SetMaximumIterations(2);
  deform->SetTolerance(1e-6);
  const std::string message = deform.Warns({ "The rotation field has not converged",
    Advice("Allow more iterations, or turn in several steps") });
  EXPECT_EQ(vtktest::NumberAfter(message, "after "), 2.0);
  EXPECT_GT(vtktest::NumberAfter(message, "the last change was "), 1e-6);
  deform->SetMaximumIterations(100);
  deform.Works();
  EXPECT_TRUE(deform->GetConverged());

  // So far that no number of iterations helps.
  deform->SetMaximumIterations(300);
  deform->SetHandleMotion(1, Turn(330.0));
  deform->SetHandleMotion(2, Turn(330.0, Y));
  deform.Warns({ "The rotation field has not converged" });
  deform->SetHandleMotion(1, Turn(82.5));
  deform->SetHandleMotion(2, Turn(82.5, Y));
  for (int step = 0; step < 4; ++step)
  {
    deform->SetInputData(deform.Works());
  }
  vtktest::ExpectHandle(deform->GetOutput(), bar, 2, Turn(330.0, Y));
}

TEST(AdviceOnDeformations, ALimbWhoseBaseCollapsesIsHeldOrMovedWithoutABase)
{
  // A tube that goes on, without a handle, far beyond the end that moves.
  const auto tube = vtktest::MakePolyData(shapes::OpenCylinder(12, 60, 1.0, 30.0));
  vtktest::AddHandles(tube,
    [](const Eigen::Vector3d& x) { return x.z() < 0.7             ? 1
                                     : x.z() > 2.9 && x.z() < 4.1 ? 2
                                                                  : 0; });
  const auto motion = Turn(40.0);
  for (int smoothness = 1; smoothness <= 3; ++smoothness)
  {
    Advised<vtkMultiresolutionDeformation> deform;
    deform->SetInputData(tube);
    deform->SetHandleMotion(2, motion);
    deform->SetSmoothness(smoothness);
    const std::string message = deform.Warns(
      { "The smooth base has collapsed at ", "smaller than a tenth of the surface there",
        Advice("Mark handles there, or use a method without a base, such as Rotation Invariant "
               "Deformation.") });
    const auto count =
      static_cast<vtkIdType>(vtktest::NumberAfter(message, "The smooth base has collapsed at "));
    const vtkIdType first = vtktest::IdsAfter(message, "points (ids ").front();
    ASSERT_EQ(first + count, tube->GetNumberOfPoints()); // it ends with the last point
    const auto held = vtktest::CopyOf(tube);
    for (vtkIdType v = first; v < tube->GetNumberOfPoints(); ++v)
    {
      held->GetPointData()->GetArray("Handle")->SetTuple1(v, 3);
    }
    deform->SetInputData(held);
    vtktest::ExpectEnds(deform.Works(), held, motion);
  }
  Advised<vtkRotationInvariantDeformation> other;
  other->SetInputData(tube);
  other->SetHandleMotion(2, motion);
  const auto bent = other.Works();
  for (vtkIdType v = 0; v < tube->GetNumberOfPoints(); ++v)
  {
    if (tube->GetPoint(v)[2] > 2.9) // the limb goes with its handle
    {
      const Eigen::Vector3d expected = vtktest::MovedBy(motion, tube->GetPoint(v));
      EXPECT_LT((Eigen::Vector3d(bent->GetPoint(v)) - expected).norm(), 1e-9) << v;
    }
  }
}

TEST(AdviceOnDeformations, SystemsOfHighOrderNeedMorePointsOrAMethodOfOrderOne)
{
  // Differences of order 3 over 8000 rings have a condition beyond double precision.
  const auto tube = vtktest::MakePolyData(shapes::OpenCylinder(3, 8000, 1.0, 8000.0));
  vtktest::MarkEnds(tube, 2.5, 7997.5);
  const auto motion = vtkSmartPointer<vtkHandleMotion>::New();
  motion->SetTranslation(100.0, 0.0, 0.0);
  Advised<vtkMultiresolutionDeformation> deform;
  deform->SetInputData(tube);
  deform->SetHandleMotion(2, motion);
  deform->SetSmoothness(3);
  deform->SetLaplacianWeightsToUniform();
  deform.Refuses({ "The system of 23985 unknowns cannot be factorized",
    Advice("Hold more points, or use a method of order 1, such as Rotation Invariant "
           "Deformation.") });
  Advised<vtkRotationInvariantDeformation> other;
  other->SetInputData(tube);
  other->SetHandleMotion(2, motion);
  vtktest::ExpectEnds(other.Works(), tube, motion);

  // Three rings in every five, which go their part of the way.
  vtktest::AddHandles(tube,
    [](const Eigen::Vector3d& x) {
      return x.z() > 7997.5 ? 2 : std::fmod(x.z() + 0.5, 5.0) < 3.0 ? 1 : 0;
    });
  deform->SetInputData(vtktest::CopyOf(tube));
  vtktest::ExpectEnds(deform.Works(), tube, motion);
}

namespace
{
/// A method whose default solver fails, as a broken library would.
class BrokenSolverDeformation : public vtkLaplacianDeformation
{
public:
  static BrokenSolverDeformation* New() { VTK_STANDARD_NEW_BODY(BrokenSolverDeformation); }
  vtkTypeMacro(BrokenSolverDeformation, vtkLaplacianDeformation);

protected:
  cartan::DeformationMethod NewMethod(const cartan::HandleProblem& problem,
    cartan::SolverBackend backend, const cartan::ExecutionContext& context) override
  {
    cartan::RequireSolver(backend == cartan::SolverBackend::Eigen ? cartan::SolverStatus::Ok
                                                                  : cartan::SolverStatus::Failed,
      40);
    return this->Superclass::NewMethod(problem, backend, context);
  }
};
}

TEST(AdviceOnDeformations, AnotherSolverSolvesWhereOneFails)
{
  Advised<BrokenSolverDeformation> deform;
  const auto bar = MarkedBar();
  deform->SetInputData(bar);
  deform->SetHandleMotion(2, Turn(30.0));
  deform.Refuses(
    { "The system of 40 unknowns could not be solved", Advice("Choose another Solver.") });
  deform->SetSolverToEigen();
  vtktest::ExpectEnds(deform.Works(), bar, Turn(30.0));
}

TEST(AdviceOnDeformations, ConjugateGradientsDeformOrNameAnotherSolver)
{
  Advised<vtkLaplacianDeformation> ofOrderTwo;
  Advised<vtkRotationInvariantDeformation> deform;
  const auto bar = MarkedBar();
  const auto prepare = [&bar](vtkSurfaceDeformation* filter)
  {
    filter->SetInputData(bar);
    filter->SetHandleMotion(2, Turn(30.0));
    filter->SetSolverToConjugateGradients();
  };
  prepare(ofOrderTwo.Get());
  prepare(deform.Get());
  if (!cartan::HasHypre())
  {
    deform.Refuses({ "built without hypre", Advice("choose Eigen's solver.") });
    deform->SetSolverToEigen();
    vtktest::ExpectEnds(deform.Works(), bar, Turn(30.0));
    return;
  }
  ofOrderTwo.Refuses(
    { "A method of order 2", Advice("choose another solver, such as Automatic.") });
  ofOrderTwo->SetSolverToAutomatic();
  vtktest::ExpectEnds(ofOrderTwo.Works(), bar, Turn(30.0));
  const cartan::Points iterative = vtktest::PointsOf(deform.Works());
  deform->SetSolverToEigen();
  EXPECT_LT((iterative - vtktest::PointsOf(deform.Works())).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(AdviceOnDeformations, EigenSolvesWhereCholmodIsMissing)
{
  Advised<vtkRotationInvariantDeformation> deform;
  const auto bar = MarkedBar();
  deform->SetInputData(bar);
  deform->SetHandleMotion(2, Turn(30.0));
  deform->SetSolverToCholmod();
  if (!cartan::HasCholmod())
  {
    deform.Refuses({ "built without CHOLMOD", Advice("choose Eigen's solver.") });
    deform->SetSolverToEigen();
  }
  vtktest::ExpectEnds(deform.Works(), bar, Turn(30.0));
}
