// SPDX-License-Identifier: BSD-3-Clause
#include "VtkTestHelpers.h"
#include "vtkHandleMotion.h"
#include "vtkPoissonDeformation.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkShapePreservingDeformation.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{
const shapes::Shape Bar = shapes::Bar(6, 6, 30, { 1.0, 1.0, 5.0 });
const double Diagonal = std::sqrt(27.0);

/// A bar whose upper end turns.
template <typename Filter>
struct Turning
{
  explicit Turning(bool isTabulated)
  {
    auto surface = vtktest::MakePolyData(Bar);
    vtktest::AddHandles(
      surface, [](const Eigen::Vector3d& p) { return p[2] < 0.6 ? 1 : (p[2] > 4.4 ? 2 : 0); });
    this->Deform->SetInputData(surface);
    this->Deform->SetHandleMotion(2, this->Motion);
    this->Deform->SetTabulateTurns(isTabulated);
  }

  cartan::Points At(double degrees, const Eigen::Vector3d& axis)
  {
    this->Motion->SetAxis(axis.data());
    this->Motion->SetAngle(degrees);
    this->Motion->SetCenter(0.2, 0.1, 4.0);
    this->Motion->SetTranslation(0.1, 0.2, -0.3);
    this->Deform->Update();
    return vtktest::PointsOf(this->Deform->GetOutput());
  }

  vtkNew<Filter> Deform;
  vtkNew<vtkHandleMotion> Motion;
};

double Distance(const cartan::Points& a, const cartan::Points& b)
{
  return (a - b).rowwise().norm().maxCoeff();
}
}

TEST(TurnTableOfAFilter, GivesTheSolutionWithinItsTolerance)
{
  Turning<vtkShapePreservingDeformation> tabulated(true);
  Turning<vtkShapePreservingDeformation> solved(false);
  auto log = vtktest::Observe(tabulated.Deform);
  const int factorizations =
    (solved.At(10.0, { 1.0, 0.0, 0.0 }), solved.Deform->GetNumberOfFactorizations());
  for (const double degrees : { 30.0, -75.0, 160.0 })
  {
    for (const Eigen::Vector3d& axis :
      { Eigen::Vector3d(1.0, 0.0, 0.0), Eigen::Vector3d(1.0, 2.0, -0.5) })
    {
      EXPECT_LT(Distance(tabulated.At(degrees, axis), solved.At(degrees, axis)), 1e-5 * Diagonal);
      EXPECT_NEAR(tabulated.Deform->GetTabulatedRange(), 180.0, 1e-9);
      EXPECT_GT(tabulated.Deform->GetTabulationError(), 0.0);
      EXPECT_LE(tabulated.Deform->GetTabulationError(), 1e-5);
      EXPECT_EQ(solved.Deform->GetTabulatedRange(), 0.0);
    }
  }
  EXPECT_EQ(tabulated.Deform->GetNumberOfFactorizations(), factorizations);
  // Beyond its range and without one, motions are solved for.
  EXPECT_EQ(
    Distance(tabulated.At(190.0, { 1.0, 0.0, 0.0 }), solved.At(190.0, { 1.0, 0.0, 0.0 })), 0.0);
  EXPECT_EQ(tabulated.Deform->GetTabulatedRange(), 0.0);
  EXPECT_EQ(tabulated.Deform->GetTabulationError(), 0.0);
  vtktest::ExpectQuiet(*log);
}

TEST(TurnTableOfAFilter, FollowsItsSettings)
{
  Turning<vtkRotationInvariantDeformation> tabulated(true);
  Turning<vtkRotationInvariantDeformation> solved(false);
  tabulated.Deform->SetTurnRange(60.0);
  tabulated.Deform->SetTurnTolerance(1e-3);
  const Eigen::Vector3d axis(0.0, 1.0, 0.0);
  EXPECT_LT(Distance(tabulated.At(59.0, axis), solved.At(59.0, axis)), 1e-3 * Diagonal);
  EXPECT_NEAR(tabulated.Deform->GetTabulatedRange(), 60.0, 1e-9);
  const double coarse = tabulated.Deform->GetTabulationError();
  tabulated.Deform->SetTurnTolerance(1e-6);
  EXPECT_LT(Distance(tabulated.At(59.0, axis), solved.At(59.0, axis)), 1e-6 * Diagonal);
  EXPECT_LT(tabulated.Deform->GetTabulationError(), 0.1 * coarse);
  tabulated.At(61.0, axis);
  EXPECT_EQ(tabulated.Deform->GetTabulatedRange(), 0.0);
  // Corrections that are not linear in the frames have no table.
  tabulated.Deform->SetVolumeCorrectionToFrameScaling();
  tabulated.At(30.0, axis);
  EXPECT_EQ(tabulated.Deform->GetTabulatedRange(), 0.0);
}

TEST(TurnTableOfAFilter, IsCountedAsKeptMemory)
{
  Turning<vtkShapePreservingDeformation> tabulated(true);
  Turning<vtkShapePreservingDeformation> solved(false);
  tabulated.At(20.0, { 1.0, 0.0, 0.0 });
  solved.At(20.0, { 1.0, 0.0, 0.0 });
  const double more = tabulated.Deform->GetKeptMemory() - solved.Deform->GetKeptMemory();
  const double perPoint = 1e6 * more / tabulated.Deform->GetNumberOfFreePoints();
  EXPECT_GT(perPoint, 100.0);
  EXPECT_LT(perPoint, 250.0);
}

TEST(TurnTableOfAFilter, MakesNoDifferenceWithoutATable)
{
  Turning<vtkPoissonDeformation> tabulated(true);
  Turning<vtkPoissonDeformation> solved(false);
  EXPECT_EQ(
    Distance(tabulated.At(70.0, { 1.0, 1.0, 0.0 }), solved.At(70.0, { 1.0, 1.0, 0.0 })), 0.0);
  EXPECT_EQ(tabulated.Deform->GetTabulatedRange(), 0.0);
}

TEST(TurnTableOfAFilter, RefusesNumbersThatAreNone)
{
  Turning<vtkShapePreservingDeformation> tabulated(true);
  auto log = vtktest::Observe(tabulated.Deform);
  const double before = tabulated.Deform->GetTurnTolerance();
  tabulated.Deform->SetTurnTolerance(std::numeric_limits<double>::quiet_NaN());
  ASSERT_EQ(log->Errors.size(), 1u);
  vtktest::ExpectMessage(log->Errors, { "TurnTolerance must be a number" });
  EXPECT_EQ(tabulated.Deform->GetTurnTolerance(), before);
  tabulated.At(20.0, { 1.0, 0.0, 0.0 });
  EXPECT_EQ(log->Errors.size(), 1u);
  EXPECT_GT(tabulated.Deform->GetTabulatedRange(), 0.0);
}

// Nothing turns: no table is made, and nothing moves.
TEST(TurnTableOfAFilter, LeavesASurfaceWithoutMotions)
{
  Turning<vtkShapePreservingDeformation> shape(true);
  Turning<vtkRotationInvariantDeformation> rotation(true);
  for (vtkSurfaceDeformation* deform : { static_cast<vtkSurfaceDeformation*>(shape.Deform),
         static_cast<vtkSurfaceDeformation*>(rotation.Deform) })
  {
    auto log = vtktest::Observe(deform);
    deform->RemoveAllHandleMotions();
    deform->Update();
    vtktest::ExpectQuiet(*log);
    EXPECT_EQ(Distance(vtktest::PointsOf(deform->GetOutput()), Bar.Positions), 0.0);
  }
}
