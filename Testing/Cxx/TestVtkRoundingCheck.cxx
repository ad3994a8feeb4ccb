// SPDX-License-Identifier: BSD-3-Clause
#include "AdviceWords.h"
#include "TestShapes.h"
#include "VtkTestHelpers.h"

#include "vtkAsRigidAsPossibleDeformation.h"
#include "vtkHandleMotion.h"
#include "vtkLaplacianDeformation.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkShapePreservingDeformation.h"

/// Where rounding decides about a deformation, it says so, and what helps.
namespace
{
/// Triangles around a point; two points of the rim are handles.
vtkSmartPointer<vtkPolyData> Fan()
{
  shapes::Shape fan;
  fan.Positions = cartan::Points::Zero(8, 3);
  fan.Faces.resize(6, 3);
  for (int i = 0; i < 7; ++i)
  {
    fan.Positions.row(i + 1) << std::cos(0.9 * i), std::sin(0.9 * i), 0.05 * (i % 2);
  }
  for (int i = 0; i < 6; ++i)
  {
    fan.Faces.row(i) << 0, i + 1, i + 2;
  }
  auto surface = vtktest::MakePolyData(fan);
  vtktest::AddHandles(surface,
    [&fan](const Eigen::Vector3d& p)
    {
      const auto is = [&](int v) { return (p - fan.Positions.row(v).transpose()).norm() < 1e-9; };
      return is(3) ? 1 : is(6) ? 2 : 0;
    });
  return surface;
}

/// The messages of a filter that turns handle 1.
template <typename Filter>
std::string WarningsOf(Filter* filter, vtkPolyData* surface, double angle)
{
  vtkNew<vtkHandleMotion> motion;
  motion->SetAxis(0.3, 1.0, 0.2);
  motion->SetAngle(angle);
  filter->SetInputData(surface);
  filter->SetHandleMotion(1, motion);
  auto log = vtktest::Observe(filter);
  filter->Update();
  EXPECT_EQ(log->Errors.size(), 0u);
  return log->Warnings.empty() ? std::string() : log->Warnings.front();
}

TEST(RoundingCheck, SaysWhereHandlesLeaveThePlaceOpen)
{
  // Two points say nothing of how the triangles turn about the line through them.
  auto fan = Fan();
  vtkNew<vtkLaplacianDeformation> implicit;
  implicit->SetRotations(vtkLaplacianDeformation::IMPLICIT);
  implicit->SetLaplacianWeightsToUniform();
  const std::string warning = WarningsOf(implicit.Get(), fan, 40.0);
  for (const std::string& part : { std::string("Rounding decides"),
         shapes::Advice("hold more points, use smaller motions, or Rotation Invariant Deformation "
                        "with uniform LaplacianWeights and FrameProjection off.") })
  {
    EXPECT_NE(warning.find(part), std::string::npos) << warning;
  }

  vtkNew<vtkLaplacianDeformation> unchecked;
  unchecked->SetRotations(vtkLaplacianDeformation::IMPLICIT);
  unchecked->SetLaplacianWeightsToUniform();
  unchecked->SetRoundingCheckLimit(0);
  EXPECT_EQ(WarningsOf(unchecked.Get(), fan, 40.0), "");

  // What it advises.
  vtkNew<vtkRotationInvariantDeformation> linear;
  linear->SetLaplacianWeightsToUniform();
  linear->SetFrameProjection(vtkRotationInvariantDeformation::NONE);
  EXPECT_EQ(WarningsOf(linear.Get(), fan, 40.0), "");
}

TEST(RoundingCheck, IsQuietWhereThePlaceIsDetermined)
{
  auto bar = vtktest::MakePolyData(shapes::Bar(3, 3, 12, { 0.6, 0.6, 2.0 }));
  vtktest::AddHandles(
    bar, [](const Eigen::Vector3d& p) { return p[2] < 0.4 ? 2 : (p[2] > 1.6 ? 1 : 0); });
  const auto expectQuiet = [&bar](auto filter)
  {
    filter->GenerateRotationVectorOn();
    EXPECT_EQ(WarningsOf(filter.Get(), bar, 100.0), "");
    EXPECT_EQ(filter->GetNumberOfFactorizations(), 1) << "those of the check do not count";
  };
  expectQuiet(vtkSmartPointer<vtkRotationInvariantDeformation>::New());
  expectQuiet(vtkSmartPointer<vtkShapePreservingDeformation>::New());
}

TEST(RoundingCheck, EnergiesBeyondDoublePrecisionAreErrors)
{
  auto bar = vtktest::MakePolyData(shapes::Bar(3, 3, 12, { 0.6, 0.6, 2.0 }));
  vtktest::AddHandles(
    bar, [](const Eigen::Vector3d& p) { return p[2] < 0.4 ? 2 : (p[2] > 1.6 ? 1 : 0); });
  vtkNew<vtkHandleMotion> motion;
  motion->SetTranslation(1e199, 0.0, 0.0);
  vtkNew<vtkAsRigidAsPossibleDeformation> filter;
  filter->SetInputData(bar);
  filter->SetHandleMotion(1, motion);
  auto log = vtktest::Observe(filter.Get());
  filter->Update();
  EXPECT_EQ(log->Errors.size(), 1u);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
}
}
