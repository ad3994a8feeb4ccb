// SPDX-License-Identifier: BSD-3-Clause
#include "TestShapes.h"
#include "VtkTestHelpers.h"

#include "vtkHandleMotion.h"
#include "vtkLaplacianDeformation.h"
#include "vtkMultiresolutionDeformation.h"
#include "vtkPoissonDeformation.h"

namespace
{
/// A bar with its ends as handles 1 (moving) and 2 (pinned).
vtkSmartPointer<vtkPolyData> MarkedBar()
{
  const shapes::Shape bar = shapes::Bar(4, 4, 16, { 1.0, 1.0, 4.0 });
  const double low = bar.Positions.col(2).minCoeff();
  auto surface = vtktest::MakePolyData(bar);
  vtktest::AddHandles(surface,
    [low](const Eigen::Vector3d& p) { return p[2] < low + 0.6 ? 2 : (p[2] > low + 3.4 ? 1 : 0); });
  return surface;
}

/// What every concrete filter owes.
template <typename Filter>
void ExpectContract(Filter* filter)
{
  auto surface = MarkedBar();
  const cartan::Points before = vtktest::PointsOf(surface);
  vtkNew<vtkHandleMotion> motion;
  motion->SetAxis(1.0, 0.0, 0.0);
  filter->SetInputData(surface);
  filter->SetHandleMotion(1, motion);
  filter->GenerateFrameChangeOn();
  auto log = vtktest::Observe(filter);
  int factorizations = 0;
  for (int step = 1; step <= 3; ++step)
  {
    motion->SetAngle(20.0 * step);
    filter->Update();
    factorizations = step == 1 ? filter->GetNumberOfFactorizations() : factorizations;
  }
  vtktest::ExpectQuiet(*log);
  EXPECT_EQ(filter->GetNumberOfFactorizations(), factorizations);
  EXPECT_TRUE(vtktest::PointsOf(surface) == before);
  ASSERT_EQ(filter->GetOutput()->GetNumberOfPoints(), surface->GetNumberOfPoints());
  EXPECT_GT((vtktest::PointsOf(filter->GetOutput()) - before).cwiseAbs().maxCoeff(), 0.5);
  EXPECT_TRUE(vtktest::PointsOf(filter->GetOutput()).allFinite());
  ASSERT_NE(filter->GetOutput()->GetPointData()->GetArray("FrameChange"), nullptr);
}

TEST(vtkLaplacianDeformation, KeepsItsContractInEachMode)
{
  for (int mode = 0; mode < 3; ++mode)
  {
    vtkNew<vtkLaplacianDeformation> filter;
    filter->SetRotations(mode);
    ExpectContract(filter.Get());
  }
}

TEST(vtkPoissonDeformation, KeepsItsContractInEachMode)
{
  for (int mode = 0; mode < 2; ++mode)
  {
    vtkNew<vtkPoissonDeformation> filter;
    filter->SetPropagation(mode);
    ExpectContract(filter.Get());
  }
}

TEST(vtkMultiresolutionDeformation, KeepsItsContractInEachMode)
{
  for (int smoothness = 1; smoothness <= 3; ++smoothness)
  {
    vtkNew<vtkMultiresolutionDeformation> filter;
    filter->SetSmoothness(smoothness);
    ExpectContract(filter.Get());
  }
}

template <typename Filter>
void ExpectRefusalWithoutPositions(const char* method)
{
  vtkNew<Filter> filter;
  vtkNew<vtkHandleMotion> motion;
  motion->SetAngle(10.0);
  filter->SetInputData(MarkedBar());
  filter->SetHandleMotion(1, motion);
  filter->ConstrainHandlePositionsOff();
  auto log = vtktest::Observe(filter);
  filter->Update();
  vtktest::ExpectMessage(log->Errors, { method, "turn ConstrainHandlePositions on" });
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(vtkLaplacianDeformation, RefusesHandlesWithoutPositions)
{
  ExpectRefusalWithoutPositions<vtkLaplacianDeformation>("Laplacian editing");
}

TEST(vtkMultiresolutionDeformation, RefusesHandlesWithoutPositions)
{
  ExpectRefusalWithoutPositions<vtkMultiresolutionDeformation>("Multiresolution editing");
}

TEST(vtkPoissonDeformation, RefusesPerPointArrays)
{
  vtkNew<vtkPoissonDeformation> filter;
  auto surface = MarkedBar();
  vtktest::AddArray(surface, "Turn", 3,
    [](vtkIdType, double* vector)
    {
      vector[0] = 0.5;
      vector[1] = vector[2] = 0.0;
    });
  filter->SetInputData(surface);
  filter->SetRotationVectorArrayName("Turn");
  auto log = vtktest::Observe(filter);
  filter->Update();
  vtktest::ExpectMessage(log->Errors, { "Poisson editing", "give each handle a motion" });
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
}
}
