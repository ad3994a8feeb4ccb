// SPDX-License-Identifier: BSD-3-Clause
#include "vtkLaplacianSpectrum.h"

#include "Advice.h"

#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"

namespace
{
using vtktest::MakePolyData;
using vtktest::PointsOf;

class SpectrumFilter : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Input = MakePolyData(shapes::Noisy(shapes::Icosphere(3), 0.05));
    this->Log = vtktest::Observe(this->Filter);
    this->Filter->SetInputData(this->Input);
    this->Filter->SetNumberOfModes(30);
  }

  double Value(vtkIdType row, const char* column)
  {
    return this->Filter->GetSpectrumTable()->GetValueByName(row, column).ToDouble();
  }

  cartan::Points Result()
  {
    this->Filter->Update();
    return PointsOf(this->Filter->GetOutput());
  }

  vtkSmartPointer<vtkPolyData> Input;
  vtkNew<vtkLaplacianSpectrum> Filter;
  vtkSmartPointer<vtktest::Log> Log;
};
}

TEST_F(SpectrumFilter, ReconstructsThePointsFromItsTableAndModes)
{
  // Far from the origin: coefficients are those of the positions where they are.
  for (vtkIdType v = 0; v < this->Input->GetNumberOfPoints(); ++v)
  {
    Eigen::Vector3d point(this->Input->GetPoint(v));
    point += Eigen::Vector3d(5.0, -3.0, 2.0);
    this->Input->GetPoints()->SetPoint(v, point.data());
  }
  this->Filter->GenerateModesOn();
  const cartan::Points result = this->Result();
  vtktest::ExpectQuiet(*this->Log);
  vtkTable* table = this->Filter->GetSpectrumTable();
  ASSERT_EQ(table->GetNumberOfRows(), 30);
  vtkDataArray* modes = this->Filter->GetOutput()->GetPointData()->GetArray("Modes");
  ASSERT_EQ(modes->GetNumberOfComponents(), 30);
  for (vtkIdType v = 0; v < result.rows(); ++v)
  {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (int k = 0; k < 30; ++k)
    {
      sum += modes->GetComponent(v, k) *
        Eigen::RowVector3d(this->Value(k, "X"), this->Value(k, "Y"), this->Value(k, "Z"));
    }
    ASSERT_LT((sum - result.row(v)).norm(), 1e-11) << v;
  }
  EXPECT_NEAR(this->Value(0, "Eigenvalue"), 0.0, 1e-10);
  for (int k = 1; k < 30; ++k)
  {
    EXPECT_GE(this->Value(k, "Eigenvalue"), this->Value(k - 1, "Eigenvalue"));
    EXPECT_GE(this->Value(k, "Energy"), this->Value(k - 1, "Energy"));
  }
  // The three modes of first order are nearly the coordinates of a sphere.
  EXPECT_LT(this->Value(0, "Energy"), 1e-12);
  EXPECT_GT(this->Value(3, "Energy"), 0.97);
  EXPECT_LE(this->Value(29, "Energy"), 1.0 + 1e-12);
}

TEST_F(SpectrumFilter, SplitsTheSurfaceIntoBands)
{
  const cartan::Points points = PointsOf(this->Input);
  this->Filter->SetApproximationModes(10);
  const cartan::Points low = this->Result();
  this->Filter->SetApproximationToHighPass();
  const cartan::Points high = this->Result();
  const Eigen::RowVector3d center = points.colwise().mean();
  EXPECT_LT(((low + high - points).rowwise() - center).cwiseAbs().maxCoeff(), 1e-12);
  this->Filter->SetApproximationToBandPass();
  this->Filter->SetFirstMode(4);
  const cartan::Points band = this->Result();
  this->Filter->SetApproximationToLowPass();
  this->Filter->SetApproximationModes(4);
  const cartan::Points lowest = this->Result();
  EXPECT_LT(((lowest + band - low).rowwise() - center).cwiseAbs().maxCoeff(), 1e-12);
  this->Filter->SetApproximationToNone();
  EXPECT_EQ(this->Result(), points);
  this->Filter->SetApproximationToLowPass();
  this->Filter->SetNumberOfModes(642);
  this->Filter->SetApproximationModes(0);
  EXPECT_LT((this->Result() - points).cwiseAbs().maxCoeff(), 1e-12);
  vtktest::ExpectQuiet(*this->Log);
}

TEST_F(SpectrumFilter, PlaysOverTheNumberOfModes)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  this->Filter->SetApproximationModes(7);
  const cartan::Points expected = this->Result();
  this->Filter->PlayModesOn();
  this->Filter->UpdateInformation();
  vtkInformation* info = this->Filter->GetOutputInformation(0);
  ASSERT_EQ(info->Length(Pipeline::TIME_STEPS()), 30);
  EXPECT_EQ(info->Get(Pipeline::TIME_STEPS(), 6), 7.0);
  this->Filter->UpdateTimeStep(7.0);
  EXPECT_EQ(PointsOf(this->Filter->GetOutput()), expected);
  EXPECT_EQ(this->Filter->GetOutput()->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), 7.0);
  this->Filter->PlayModesOff();
  this->Filter->UpdateInformation();
  EXPECT_FALSE(info->Has(Pipeline::TIME_STEPS()));
}

TEST_F(SpectrumFilter, TreatsAPointArrayLikeThePositions)
{
  const cartan::Points points = PointsOf(this->Input);
  vtktest::AddArray(this->Input, "Copy", 3,
    [&](vtkIdType v, double* value) { Eigen::RowVector3d::Map(value) = points.row(v); });
  this->Filter->SetCoefficientArrayName("Copy");
  const cartan::Points result = this->Result();
  vtkDataArray* copy = this->Filter->GetOutput()->GetPointData()->GetArray("CopyApproximation");
  ASSERT_NE(copy, nullptr);
  for (vtkIdType v = 0; v < result.rows(); ++v)
  {
    EXPECT_NEAR(copy->GetComponent(v, 2), result(v, 2), 1e-12);
  }
  for (int k = 0; k < 30; ++k)
  {
    EXPECT_NEAR(this->Value(k, "Copy_1"), this->Value(k, "Y"), 1e-11);
  }
  this->Filter->SetCoefficientArrayName("Missing");
  this->Result();
  vtktest::ExpectMessage(this->Log->Errors, { "Missing" });
}

TEST_F(SpectrumFilter, RefusesMoreModesThanPointsOrMemory)
{
  this->Filter->SetNumberOfModes(643);
  this->Result();
  vtktest::ExpectMessage(this->Log->Errors, { "643 modes", "1 to 642" });
  this->Log->Clear();
  this->Filter->SetNumberOfModes(100);
  this->Filter->SetModeMemoryLimit(1);
  this->Result();
  vtktest::ExpectMessage(this->Log->Errors,
    { "100 modes", "at most 33", shapes::Advice(", or raise the memory limit.") });
  EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_EQ(this->Filter->GetSpectrumTable()->GetNumberOfRows(), 0);
  this->Log->Clear();
  this->Filter->SetNumberOfModes(33);
  EXPECT_EQ(this->Result().rows(), 642);
  this->Filter->SetNumberOfModes(100);
  this->Filter->SetModeMemoryLimit(10);
  EXPECT_EQ(this->Result().rows(), 642);
  vtktest::ExpectQuiet(*this->Log);
  // Not one mode fits.
  this->Filter->SetInputData(MakePolyData(shapes::Icosphere(5)));
  this->Filter->SetNumberOfModes(2);
  this->Filter->SetModeMemoryLimit(1);
  this->Result();
  vtktest::ExpectMessage(this->Log->Errors, { shapes::Advice(": raise the memory limit.") });
  this->Log->Clear();
  this->Filter->SetModeMemoryLimit(10);
  EXPECT_EQ(this->Result().rows(), 10242);
  vtktest::ExpectQuiet(*this->Log);
}
