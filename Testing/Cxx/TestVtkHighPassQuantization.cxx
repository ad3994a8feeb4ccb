// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHighPassQuantization.h"

#include "Advice.h"

namespace
{
class QuantizationFilter : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Input = vtktest::MakePolyData(shapes::Noisy(shapes::Torus(40, 24), 0.03));
    this->Log = vtktest::Observe(this->Filter);
    this->Filter->SetInputData(this->Input);
  }

  double FieldValue(const char* name)
  {
    vtkDataArray* array = this->Filter->GetOutput()->GetFieldData()->GetArray(name);
    return array ? array->GetTuple1(0) : -1.0;
  }

  vtkSmartPointer<vtkPolyData> Input;
  vtkNew<vtkHighPassQuantization> Filter;
  vtkSmartPointer<vtktest::Log> Log;
};
}

TEST_F(QuantizationFilter, WritesTheDocumentedArraysAndNumbers)
{
  this->Filter->Update();
  vtktest::ExpectQuiet(*this->Log);
  vtkPointData* arrays = this->Filter->GetOutput()->GetPointData();
  vtkDataArray* errors = arrays->GetArray("VisualError");
  ASSERT_NE(errors, nullptr);
  double squares = 0.0;
  for (vtkIdType v = 0; v < errors->GetNumberOfTuples(); ++v)
  {
    squares += errors->GetTuple1(v) * errors->GetTuple1(v);
  }
  EXPECT_NEAR(this->Filter->GetVisualErrorRMS(),
    std::sqrt(squares / static_cast<double>(errors->GetNumberOfTuples())), 1e-15);
  EXPECT_EQ(this->FieldValue("VisualErrorRMS"), this->Filter->GetVisualErrorRMS());
  EXPECT_EQ(this->FieldValue("BitsPerPoint"), this->Filter->GetBitsPerPoint());
  EXPECT_EQ(this->FieldValue("Bits"), 7.0);
  EXPECT_GT(this->FieldValue("VisualErrorMax"), this->Filter->GetVisualErrorRMS());
  EXPECT_GT(this->Filter->GetBitsPerPoint(), 10.0);
  EXPECT_LT(this->Filter->GetBitsPerPoint(), 23.0);
  double anchors = 0.0;
  for (vtkIdType v = 0; v < errors->GetNumberOfTuples(); ++v)
  {
    anchors += arrays->GetArray("Anchor")->GetTuple1(v);
  }
  EXPECT_EQ(anchors, 20.0);
}

TEST_F(QuantizationFilter, MeetsAnErrorWithTheFewestBits)
{
  const double diagonal = this->Input->GetLength();
  for (const double bound : { 1e-3, 1e-4 })
  {
    this->Filter->SetMaximumError(bound);
    this->Filter->Update();
    const int bits = this->Filter->GetUsedBits();
    EXPECT_LE(this->Filter->GetVisualErrorRMS(), bound * diagonal);
    this->Filter->SetMaximumError(0.0);
    this->Filter->SetBits(bits - 1);
    this->Filter->Update();
    EXPECT_GT(this->Filter->GetVisualErrorRMS(), bound * diagonal);
  }
  vtktest::ExpectQuiet(*this->Log);
}

TEST_F(QuantizationFilter, SaysWhatCannotBeMetAndHowItCan)
{
  this->Filter->SetNumberOfAnchors(1);
  this->Filter->SetMaximumError(1e-9);
  this->Filter->Update();
  vtktest::ExpectMessage(this->Log->Errors,
    { "16 bits with 1 anchors", shapes::Advice("; allow a larger MaximumError.") });
  EXPECT_EQ(this->Filter->GetUsedBits(), 0);
  const double reached = vtktest::NumberAfter(this->Log->Errors[0], "visual error of");
  this->Log->Clear();
  this->Filter->SetMaximumError(1.01 * reached);
  this->Filter->Update();
  EXPECT_EQ(this->Filter->GetUsedBits(), 16);
  vtktest::ExpectQuiet(*this->Log);
  this->Filter->SetMaximumError(0.0);
  this->Filter->SetNumberOfAnchors(961);
  this->Filter->Update();
  vtktest::ExpectMessage(this->Log->Errors, { "961 anchors", "960 points" });
  this->Log->Clear();
  this->Filter->SetNumberOfAnchors(960);
  this->Filter->Update();
  vtktest::ExpectQuiet(*this->Log);
}
