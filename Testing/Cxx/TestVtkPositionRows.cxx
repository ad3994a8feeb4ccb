// SPDX-License-Identifier: BSD-3-Clause
#include "TestShapes.h"
#include "VtkTestHelpers.h"

#include "vtkHandleMotion.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkShapePreservingDeformation.h"

/// Updates that go from kept fields to the output in one pass, which surfaces above
/// RoundingCheckLimit do, against those that keep the positions.
namespace
{
constexpr double BarLength = 6.0;

vtkSmartPointer<vtkPolyData> LongBar(int type, double size = 1.0)
{
  const auto bar =
    vtktest::MakePolyData(shapes::Bar(3, 3, 60, { size, size, size * BarLength }), type);
  vtktest::AddHandles(bar,
    [size](const Eigen::Vector3d& p)
    {
      const double part = p.z() / size / BarLength;
      return part < 0.2 ? 1 : part > 0.8 ? 2 : 0;
    });
  return bar;
}

vtkSmartPointer<vtkHandleMotion> MotionOfEnd(double scale, double shift)
{
  auto motion = vtkSmartPointer<vtkHandleMotion>::New();
  motion->SetScale(scale, scale, scale);
  motion->SetAxis(1.0, 0.2, 0.1);
  motion->SetAngle(30.0);
  motion->SetTranslation(0.0, shift, 0.1);
  return motion;
}

/// In one pass, and with positions kept; then after another motion.
template <typename Filter>
void ExpectSameInOnePass(Filter* inOnePass, Filter* keeping, vtkPolyData* surface, double scale)
{
  inOnePass->SetRoundingCheckLimit(0);
  for (Filter* filter : { inOnePass, keeping })
  {
    filter->SetInputData(surface);
  }
  for (const double shift : { 0.5, -0.2 })
  {
    const auto motion = MotionOfEnd(scale, shift);
    for (Filter* filter : { inOnePass, keeping })
    {
      filter->SetHandleMotion(2, motion);
      filter->Update();
    }
    vtktest::ExpectSameSurface(inOnePass->GetOutput(), keeping->GetOutput());
    EXPECT_GT((vtktest::PointsOf(inOnePass->GetOutput()) - vtktest::PointsOf(surface)).norm(), 0.1);
  }
}

TEST(VtkPositionRows, AreWhatIsKeptOtherwise)
{
  for (const int type : { VTK_FLOAT, VTK_DOUBLE })
  {
    vtkNew<vtkRotationInvariantDeformation> scaled;
    vtkNew<vtkRotationInvariantDeformation> keeping;
    ExpectSameInOnePass(scaled.Get(), keeping.Get(), LongBar(type), 1.1);
    vtkNew<vtkShapePreservingDeformation> tabulated;
    vtkNew<vtkShapePreservingDeformation> other;
    tabulated->TabulateTurnsOn();
    other->TabulateTurnsOn();
    ExpectSameInOnePass(tabulated.Get(), other.Get(), LongBar(type), 1.0);
    EXPECT_GT(tabulated->GetTabulatedRange(), 0.0);
  }
}

TEST(VtkPositionRows, WarnOfMotionsWithoutDigits)
{
  vtkNew<vtkRotationInvariantDeformation> far;
  far->SetRoundingCheckLimit(0);
  far->SetInputData(LongBar(VTK_DOUBLE));
  far->SetHandleMotion(2, MotionOfEnd(1.1, 1e12));
  const auto log = vtktest::Observe(far);
  far->Update();
  vtktest::ExpectMessage(log->Warnings, { "have no digits for its shape" });
  EXPECT_EQ(log->Errors.size(), 0u);
  log->Clear();
  far->SetHandleMotion(2, MotionOfEnd(1.1, 1.0));
  far->Update();
  vtktest::ExpectQuiet(*log);
}

TEST(VtkPositionRows, RefuseWhatThePrecisionDoesNotHold)
{
  vtkNew<vtkRotationInvariantDeformation> far;
  far->SetRoundingCheckLimit(0);
  far->SetInputData(LongBar(VTK_FLOAT, 1e36));
  far->SetHandleMotion(2, MotionOfEnd(1.1, 1e39));
  const auto log = vtktest::Observe(far);
  far->Update();
  vtktest::ExpectMessage(log->Errors, { "outside the range of single precision", "as double" });
  EXPECT_EQ(far->GetOutput()->GetNumberOfPoints(), 0);
}
}
