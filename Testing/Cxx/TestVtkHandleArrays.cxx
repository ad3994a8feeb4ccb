// SPDX-License-Identifier: BSD-3-Clause
// The Handle array and the arrays of targets, as all filters read them; and what a
// deformation does before its method is prepared.
#include "VtkTestHelpers.h"

#include "vtkHandleMotion.h"
#include "vtkPoissonDeformation.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkSurfaceMorph.h"

#include "Bridge/DeformationMethod.h"

#include <algorithm>

namespace
{
vtkSmartPointer<vtkPolyData> MarkedBar(int length = 8)
{
  auto bar = vtktest::MakePolyData(shapes::Bar(2, 2, length, { 1.0, 1.0, 4.0 }));
  vtktest::AddHandles(
    bar, [](const Eigen::Vector3d& p) { return p.z() < 0.6 ? 1
                                          : p.z() > 3.0    ? 2
                                                           : 0; });
  return bar;
}

vtkSmartPointer<vtkHandleMotion> Turn(double degrees)
{
  auto motion = vtkSmartPointer<vtkHandleMotion>::New();
  motion->SetAxis(1.0, 0.0, 0.0);
  motion->SetAngle(degrees);
  return motion;
}

vtkSmartPointer<vtkPolyData> Deformed(vtkPolyData* input, double degrees)
{
  vtkNew<vtkRotationInvariantDeformation> fresh;
  fresh->SetInputData(vtktest::CopyOf(input));
  fresh->SetHandleMotion(2, Turn(degrees));
  fresh->Update();
  return vtktest::CopyOf(fresh->GetOutput());
}

/// A method that cannot be prepared.
class FailingDeformation : public vtkSurfaceDeformation
{
public:
  static FailingDeformation* New() { VTK_STANDARD_NEW_BODY(FailingDeformation); }
  vtkTypeMacro(FailingDeformation, vtkSurfaceDeformation);

  cartan::ErrorCode Code = cartan::ErrorCode::SolverFailed;

protected:
  cartan::DeformationMethod NewMethod(
    const cartan::HandleProblem&, cartan::SolverBackend, const cartan::ExecutionContext&) override
  {
    throw cartan::Error(this->Code, "It failed.");
  }
};
}

TEST(VtkHandleArrays, AreNotReadAgainBeforeAMotion)
{
  const auto bar = MarkedBar();
  const auto untouched = vtktest::CopyOf(bar);
  vtkNew<vtkRotationInvariantDeformation> deform;
  const auto motion = Turn(10.0);
  deform->SetInputData(bar);
  deform->SetHandleMotion(2, motion);
  deform->Update();

  // Nothing tells the filter of this: an edit through a pointer.
  auto* handles = vtkIntArray::SafeDownCast(bar->GetPointData()->GetArray("Handle"));
  for (vtkIdType v = 0; v < handles->GetNumberOfTuples(); ++v)
  {
    handles->SetValue(v, bar->GetPoint(v)[2] > 3.2 ? 2 : handles->GetValue(v) % 2);
  }
  motion->SetAngle(20.0);
  deform->Update();
  EXPECT_EQ((vtktest::PointsOf(deform->GetOutput()) - vtktest::PointsOf(Deformed(untouched, 20.0)))
              .cwiseAbs()
              .maxCoeff(),
    0.0);
  handles->Modified();
  deform->Update();
  vtktest::ExpectSameSurface(deform->GetOutput(), Deformed(bar, 20.0));
}

TEST(VtkHandleArrays, OfAMorphAreWholeNumbersToo)
{
  const auto first = MarkedBar();
  const auto last = MarkedBar();
  const auto handles =
    vtktest::AddArray(first, "Pinned", 1, [](vtkIdType v, double* value) { *value = v < 9; });
  const double wrong[3] = { 0.5, -1.0, std::numeric_limits<double>::quiet_NaN() };
  std::copy_n(wrong, 3, handles->GetPointer(5));
  vtkNew<vtkSurfaceMorph> morph;
  const auto log = vtktest::Observe(morph);
  morph->AddInputData(first);
  morph->AddInputData(last);
  morph->SetParameter(0.5);
  morph->SetHandleArrayName("Pinned");
  morph->SetPlacementToPinnedHandle();
  morph->Update();
  vtktest::ExpectMessage(
    log->Errors, { "\"Pinned\" has 3 values (ids 5, 6, 7) that are not whole numbers >= 0" });
  EXPECT_EQ(morph->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(VtkHandleArrays, BoundTheActiveHandleOfAnyNumericType)
{
  const auto bar = MarkedBar();
  vtkNew<vtkRotationInvariantDeformation> deform;
  deform->SetInputData(bar);
  const auto boundsOf = [&](const char* array, int id)
  {
    deform->SetHandleArrayName(array);
    deform->SetActiveHandle(id);
    const double* bounds = deform->GetActiveHandleBounds();
    return std::vector<double>(bounds, bounds + 6);
  };
  vtktest::AddArray(bar, "Doubles", 1,
    [&](vtkIdType v, double* value)
    { *value = bar->GetPointData()->GetArray("Handle")->GetTuple1(v); });
  vtktest::AddArray(bar, "Fractions", 1, [](vtkIdType, double* value) { *value = 0.5; });
  const std::vector<double> ofHandle = boundsOf("Handle", 2);
  EXPECT_GT(ofHandle[4], 2.5);
  EXPECT_GT(ofHandle[5], 4.0);
  EXPECT_EQ(boundsOf("Doubles", 2), ofHandle);
  // Where no handle can be read, there is no box: a widget would move nothing.
  const std::vector<double> none = { 1.0, -1.0, 1.0, -1.0, 1.0, -1.0 };
  EXPECT_EQ(boundsOf("Handle", 7), none);
  EXPECT_EQ(boundsOf("Fractions", 2), none);
  EXPECT_EQ(boundsOf("None", 2), none);
  deform->SetInputConnection(nullptr);
  EXPECT_EQ(boundsOf("Handle", 2), none);
}

TEST(VtkHandleArrays, BoundAllHandles)
{
  vtkNew<vtkRotationInvariantDeformation> deform;
  EXPECT_EQ(deform->GetHandleBounds()->GetNumberOfTuples(), 0);
  deform->SetInputData(MarkedBar());
  vtkDoubleArray* table = deform->GetHandleBounds();
  ASSERT_EQ(table->GetNumberOfTuples(), 2);
  for (int id = 1; id <= 2; ++id)
  {
    deform->SetActiveHandle(id);
    const double* bounds = deform->GetActiveHandleBounds();
    EXPECT_EQ(table->GetComponent(id - 1, 0), id);
    for (int i = 0; i < 6; ++i)
    {
      EXPECT_EQ(table->GetComponent(id - 1, i + 1), bounds[i]);
    }
  }
}

TEST(VtkSurfaceDeformation, RefusesTargetsBeforeItPreparesTheMethod)
{
  const auto bar = MarkedBar();
  vtktest::AddArray(bar, "Turn", 3,
    [](vtkIdType, double* vector)
    {
      vector[0] = 0.5;
      vector[1] = vector[2] = 0.0;
    });
  vtkNew<vtkPoissonDeformation> deform;
  const auto log = vtktest::Observe(deform);
  deform->SetInputData(bar);
  deform->SetRotationVectorArrayName("Turn");
  deform->Update();
  vtktest::ExpectMessage(log->Errors, { "Poisson editing", "give each handle a motion" });
  EXPECT_EQ(deform->GetNumberOfFactorizations(), 0);
  // With motions for all handles the arrays have nothing to say.
  log->Clear();
  deform->SetHandleMotion(1, Turn(0.0));
  deform->SetHandleMotion(2, Turn(20.0));
  deform->Update();
  vtktest::ExpectQuiet(*log);
  EXPECT_EQ(deform->GetNumberOfFactorizations(), 1);
}

TEST(VtkSurfaceDeformation, AdvisesSettingsThatItHas)
{
  vtkNew<FailingDeformation> deform;
  const auto log = vtktest::Observe(deform);
  deform->SetInputData(MarkedBar());
  deform->SetHandleMotion(2, Turn(20.0));
  const auto message = [&](cartan::ErrorCode code)
  {
    log->Clear();
    deform->Code = code;
    deform->Modified();
    deform->Update();
    return log->Errors.size() == 1 ? log->Errors[0] : "";
  };
  using cartan::ErrorCode;
  EXPECT_NE(
    message(ErrorCode::SolverFailed).find("It failed. Choose another Solver."), std::string::npos);
  EXPECT_NE(
    message(ErrorCode::NotPositiveDefinite).find("It failed. Hold more points"), std::string::npos);
  for (const ErrorCode code : { ErrorCode::SingularSystem, ErrorCode::TooLarge })
  {
    EXPECT_NE(message(code).find("It failed."), std::string::npos);
    EXPECT_EQ(message(code).find("Hold more points"), std::string::npos);
    EXPECT_EQ(message(code).find("Solver."), std::string::npos);
  }
}
