// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCurvatureError.h"

#include "TestSurfaces.h"

#include <gtest/gtest.h>

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSphereSource.h"

#include <cmath>
#include <limits>
#include <sstream>

namespace
{
class CurvatureError : public ::testing::Test
{
protected:
  CurvatureError() { surfaces::Observe(this->Filter, this->Messages); }

  vtkDoubleArray* PointArray(const char* name)
  {
    return vtkDoubleArray::SafeDownCast(this->Filter->GetOutput()->GetPointData()->GetArray(name));
  }

  double FieldValue(const char* name)
  {
    auto* array =
      vtkDoubleArray::SafeDownCast(this->Filter->GetOutput()->GetFieldData()->GetArray(name));
    return array && array->GetNumberOfValues() == 1 ? array->GetValue(0)
                                                    : std::numeric_limits<double>::quiet_NaN();
  }

  /// Updates, expects one error that contains `text`, and an empty output.
  void ExpectError(const std::string& text)
  {
    this->Messages->Clear();
    this->Filter->Update();
    EXPECT_EQ(this->Messages->GetNumberOfErrors(), 1);
    EXPECT_NE(this->Messages->GetErrorMessage().find(text), std::string::npos)
      << this->Messages->GetErrorMessage();
    EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfCells(), 0);
  }

  vtkNew<surfaces::Observer> Messages;
  vtkNew<vtkCurvatureError> Filter;
};
}

TEST_F(CurvatureError, WithoutReferenceGivesCurvaturesOnly)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetRadius(0.5);
  sphere->SetThetaResolution(40);
  sphere->SetPhiResolution(30);
  this->Filter->SetInputConnection(sphere->GetOutputPort());
  this->Filter->Update();
  ASSERT_FALSE(this->Messages->GetError());
  for (const char* name : { "MeanCurvature", "MaximumCurvature", "MinimumCurvature" })
  {
    ASSERT_NE(this->PointArray(name), nullptr) << name;
    double range[2];
    this->PointArray(name)->GetRange(range);
    // Points in single precision, poles included.
    EXPECT_NEAR(range[0], 2.0, 1e-3) << name;
    EXPECT_NEAR(range[1], 2.0, 1e-3) << name;
  }
  double range[2];
  this->PointArray("GaussianCurvature")->GetRange(range);
  EXPECT_NEAR(range[0], 4.0, 2e-3);
  EXPECT_NEAR(range[1], 4.0, 2e-3);
  EXPECT_EQ(this->PointArray("MeanCurvatureError"), nullptr);
  EXPECT_EQ(this->PointArray("MaximumCurvatureDirection"), nullptr);
  EXPECT_TRUE(std::isnan(this->Filter->GetMeanCurvatureErrorRMS()));
  EXPECT_TRUE(std::isnan(this->Filter->GetGaussianCurvatureErrorMax()));
}

TEST_F(CurvatureError, DirectionsOnRequest)
{
  this->Filter->SetInputData(surfaces::OpenCylinder(32, 10));
  this->Filter->ComputeDirectionsOn();
  this->Filter->Update();
  vtkDoubleArray* directions = this->PointArray("MinimumCurvatureDirection");
  ASSERT_NE(directions, nullptr);
  ASSERT_EQ(directions->GetNumberOfComponents(), 3);
  EXPECT_NEAR(std::abs(directions->GetComponent(0, 2)), 1.0, 0.02);
  EXPECT_NE(this->PointArray("MaximumCurvatureDirection"), nullptr);
}

TEST_F(CurvatureError, ErrorOfAScaledSphereIsKnown)
{
  const surfaces::Surface reference = surfaces::Sphere(20);
  this->Filter->SetInputData(surfaces::Scaled(reference, 2.0, 2.0, 2.0));
  this->Filter->SetReferenceData(reference);
  this->Filter->Update();
  ASSERT_FALSE(this->Messages->GetError());
  double range[2];
  this->PointArray("MeanCurvatureError")->GetRange(range);
  EXPECT_NEAR(range[0], -0.5, 1e-8);
  EXPECT_NEAR(range[1], -0.5, 1e-8);
  this->PointArray("GaussianCurvatureError")->GetRange(range);
  EXPECT_NEAR(range[0], -0.75, 1e-8);
  EXPECT_NEAR(range[1], -0.75, 1e-8);
  EXPECT_NEAR(this->Filter->GetMeanCurvatureErrorRMS(), 0.5, 1e-8);
  EXPECT_NEAR(this->Filter->GetMeanCurvatureErrorMax(), 0.5, 1e-8);
  EXPECT_NEAR(this->Filter->GetGaussianCurvatureErrorRMS(), 0.75, 1e-8);
  EXPECT_NEAR(this->Filter->GetGaussianCurvatureErrorMax(), 0.75, 1e-8);
  EXPECT_EQ(this->FieldValue("MeanCurvatureErrorRMS"), this->Filter->GetMeanCurvatureErrorRMS());
  EXPECT_EQ(this->FieldValue("MeanCurvatureErrorMax"), this->Filter->GetMeanCurvatureErrorMax());
  EXPECT_EQ(
    this->FieldValue("GaussianCurvatureErrorRMS"), this->Filter->GetGaussianCurvatureErrorRMS());
  EXPECT_EQ(
    this->FieldValue("GaussianCurvatureErrorMax"), this->Filter->GetGaussianCurvatureErrorMax());

  // Results of an earlier reference must not outlive it.
  this->Filter->SetReferenceConnection(nullptr);
  this->Filter->Update();
  EXPECT_TRUE(std::isnan(this->Filter->GetMeanCurvatureErrorRMS()));
}

TEST_F(CurvatureError, RigidMotionIsNoError)
{
  const surfaces::Surface torus = surfaces::Torus(24, 16);
  this->Filter->SetInputData(surfaces::RigidlyMoved(torus));
  this->Filter->SetReferenceData(torus);
  this->Filter->Update();
  EXPECT_LT(this->Filter->GetMeanCurvatureErrorMax(), 1e-9);
}

TEST_F(CurvatureError, QuadsAreTriangulatedAsInTheReference)
{
  // The shorter diagonals of the input's quads are the others.
  surfaces::Surface reference = surfaces::QuadGrid(4, 0.2);
  surfaces::Surface input = surfaces::QuadGrid(4, -0.2);
  this->Filter->SetInputData(input);
  this->Filter->SetReferenceData(reference);
  this->Filter->Update();
  ASSERT_FALSE(this->Messages->GetError()) << this->Messages->GetErrorMessage();
  EXPECT_EQ(this->Filter->GetMeanCurvatureErrorMax(), 0.0);
  EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPolys(), 16);
}

TEST_F(CurvatureError, InputIsUntouchedAndUpdatesOnlyWhenNeeded)
{
  surfaces::Surface input = surfaces::Torus(16, 12);
  surfaces::AddPointIds(input);
  const vtkMTimeType before = input->GetMTime();
  this->Filter->SetInputData(input);
  this->Filter->SetReferenceData(input);
  this->Filter->Update();
  EXPECT_EQ(input->GetMTime(), before);
  EXPECT_EQ(input->GetPointData()->GetNumberOfArrays(), 1);
  EXPECT_NE(this->Filter->GetOutput()->GetPointData()->GetArray("Ids"), nullptr);
  EXPECT_EQ(this->Filter->GetOutput()->GetPoints(), input->GetPoints());

  const vtkMTimeType first = this->Filter->GetOutput()->GetMTime();
  this->Filter->Update();
  EXPECT_EQ(this->Filter->GetOutput()->GetMTime(), first);
  this->Filter->ComputeDirectionsOn();
  this->Filter->Update();
  EXPECT_GT(this->Filter->GetOutput()->GetMTime(), first);
}

TEST_F(CurvatureError, UnusedPointsAndSingleTrianglesAreZero)
{
  surfaces::Surface input = surfaces::SingleTriangleWithUnusedPoint();
  this->Filter->SetInputData(input);
  this->Filter->Update();
  ASSERT_FALSE(this->Messages->GetError());
  for (vtkIdType i = 0; i < 4; ++i)
  {
    EXPECT_EQ(this->PointArray("MeanCurvature")->GetValue(i), 0.0);
  }
}

TEST_F(CurvatureError, EmptyInputGivesEmptyOutput)
{
  vtkNew<vtkPolyData> empty;
  this->Filter->SetInputData(empty);
  this->Filter->Update();
  EXPECT_FALSE(this->Messages->GetError());
  EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
}

TEST_F(CurvatureError, BadInputIsExplained)
{
  surfaces::Surface good = surfaces::Sphere(8);

  this->Filter->SetInputData(surfaces::WithPoint(good, 7, std::nan("")));
  this->ExpectError("The input has 1 point (id 7) with a NaN or infinite coordinate");

  this->Filter->SetInputData(surfaces::ThreeTrianglesAtAnEdge());
  this->ExpectError("with more than two triangles");

  this->Filter->SetInputData(good);
  this->Filter->SetReferenceData(surfaces::Sphere(12));
  this->ExpectError("The input has 50 points, the reference 122.");

  this->Filter->SetReferenceData(surfaces::WithPoint(good, 3, std::nan("")));
  this->ExpectError("The reference has 1 point (id 3) with a NaN or infinite coordinate");

  this->Filter->SetReferenceData(surfaces::WithCellsRotated(good, { 2, 5 }));
  this->ExpectError("The input has 2 cells (ids 2, 5) with other points than in the reference.");

  vtkNew<vtkPolyData> empty;
  this->Filter->SetReferenceData(empty);
  this->ExpectError("The reference has no triangles");

  // And it recovers.
  this->Messages->Clear();
  this->Filter->SetReferenceData(good);
  this->Filter->Update();
  EXPECT_FALSE(this->Messages->GetError());
  EXPECT_EQ(this->Filter->GetMeanCurvatureErrorMax(), 0.0);
}

TEST_F(CurvatureError, AbortLeavesAnEmptyOutputAndNoMessage)
{
  this->Filter->SetInputData(surfaces::Sphere(12));
  surfaces::AbortAtFirstProgress(this->Filter);
  this->Filter->Update();
  EXPECT_FALSE(this->Messages->GetError());
  EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
}

TEST_F(CurvatureError, PrintsItsState)
{
  std::ostringstream text;
  this->Filter->Print(text);
  EXPECT_NE(text.str().find("ComputeDirections: 0"), std::string::npos);
}
