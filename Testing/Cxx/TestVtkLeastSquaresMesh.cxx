// SPDX-License-Identifier: BSD-3-Clause
#include "vtkLeastSquaresMesh.h"

#include "Advice.h"

#include "vtkIntArray.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"

namespace
{
using vtktest::MakePolyData;
using vtktest::PointsOf;

class LeastSquaresMeshFilter : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Input = MakePolyData(shapes::Noisy(shapes::Torus(24, 14), 0.02));
    vtktest::AddHandles(this->Input, [](const Eigen::Vector3d& p) { return p[0] > 2.3 ? 2 : 0; });
    this->Log = vtktest::Observe(this->Filter);
    this->Filter->SetInputData(this->Input);
    this->Filter->SetNumberOfAnchors(40);
  }

  cartan::Points Result()
  {
    this->Filter->Update();
    return PointsOf(this->Filter->GetOutput());
  }

  vtkDataArray* Array(const char* name)
  {
    return this->Filter->GetOutput()->GetPointData()->GetArray(name);
  }

  vtkSmartPointer<vtkPolyData> Input;
  vtkNew<vtkLeastSquaresMesh> Filter;
  vtkSmartPointer<vtktest::Log> Log;
};
}

TEST_F(LeastSquaresMeshFilter, WritesAnchorsErrorsAndFunctions)
{
  const cartan::Points points = PointsOf(this->Input);
  this->Filter->GenerateBasisFunctionsOn();
  const cartan::Points result = this->Result();
  vtktest::ExpectQuiet(*this->Log);
  auto* anchors = vtkIntArray::SafeDownCast(this->Array("Anchor"));
  ASSERT_NE(anchors, nullptr);
  std::vector<vtkIdType> order(41, -1);
  for (vtkIdType v = 0; v < points.rows(); ++v)
  {
    if (anchors->GetValue(v) > 0)
    {
      order[anchors->GetValue(v)] = v;
      EXPECT_LT((result.row(v) - points.row(v)).norm(), 1e-11);
    }
    EXPECT_NEAR(this->Array("ApproximationError")->GetTuple1(v),
      (result.row(v) - points.row(v)).norm(), 1e-12);
  }
  EXPECT_TRUE(std::all_of(order.begin() + 1, order.end(), [](vtkIdType v) { return v >= 0; }));
  vtkDataArray* functions = this->Array("BasisFunctions");
  ASSERT_EQ(functions->GetNumberOfComponents(), 40);
  for (vtkIdType v = 0; v < points.rows(); ++v)
  {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (int k = 1; k <= 40; ++k)
    {
      sum += functions->GetComponent(v, k - 1) * points.row(order[k]);
    }
    EXPECT_LT((sum - result.row(v)).norm(), 1e-9);
  }
  vtkTable* table = this->Filter->GetErrorTable();
  ASSERT_EQ(table->GetNumberOfRows(), 40);
  EXPECT_EQ(table->GetValueByName(39, "NumberOfAnchors").ToInt(), 40);
  EXPECT_NEAR(table->GetValueByName(39, "RootMeanSquareError").ToDouble(),
    std::sqrt((result - points).squaredNorm() / points.rows()), 1e-11);
  EXPECT_NEAR(table->GetValueByName(39, "MaximumError").ToDouble(),
    (result - points).rowwise().norm().maxCoeff(), 1e-11);
}

TEST_F(LeastSquaresMeshFilter, PlaysOverTheNumberOfAnchors)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  this->Filter->SetNumberOfAnchors(9);
  const cartan::Points nine = this->Result();
  this->Filter->SetNumberOfAnchors(40);
  this->Filter->PlayAnchorsOn();
  this->Filter->UpdateInformation();
  EXPECT_EQ(this->Filter->GetOutputInformation(0)->Length(Pipeline::TIME_STEPS()), 40);
  this->Filter->UpdateTimeStep(9.0);
  EXPECT_LT((PointsOf(this->Filter->GetOutput()) - nine).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(this->Filter->GetErrorTable()->GetNumberOfRows(), 40);
}

TEST_F(LeastSquaresMeshFilter, TakesHandlesAsAnchors)
{
  this->Filter->SetAnchorSelectionToHandle();
  const cartan::Points points = PointsOf(this->Input);
  const cartan::Points result = this->Result();
  vtktest::ExpectQuiet(*this->Log);
  for (vtkIdType v = 0; v < points.rows(); ++v)
  {
    if (points(v, 0) > 2.3)
    {
      EXPECT_LT((result.row(v) - points.row(v)).norm(), 1e-11);
    }
  }
  EXPECT_EQ(this->Filter->GetErrorTable()->GetNumberOfRows(), 1);
  this->Input->GetPointData()->GetArray("Handle")->Fill(0.0);
  this->Input->Modified();
  this->Result();
  ASSERT_EQ(this->Log->Errors.size(), 1u);
  EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
}

TEST_F(LeastSquaresMeshFilter, RefusesMoreAnchorsThanPointsOrMemory)
{
  this->Filter->SetNumberOfAnchors(337);
  this->Result();
  vtktest::ExpectMessage(this->Log->Errors, { "337 anchors", "Ask for 1 to 336" });
  this->Log->Clear();
  // Follows the advice of both messages.
  this->Filter->SetNumberOfAnchors(336);
  const cartan::Points result = this->Result();
  EXPECT_LT((result - PointsOf(this->Input)).cwiseAbs().maxCoeff(), 1e-9);
  vtktest::ExpectQuiet(*this->Log);
  this->Filter->SetInputData(MakePolyData(shapes::Icosphere(4)));
  this->Filter->SetNumberOfAnchors(100);
  this->Filter->SetBasisMemoryLimit(1);
  this->Result();
  vtktest::ExpectMessage(this->Log->Errors,
    { "100 functions", "at most 48", shapes::Advice("anchors, or raise the memory limit.") });
  this->Log->Clear();
  this->Filter->SetNumberOfAnchors(48);
  EXPECT_EQ(this->Result().rows(), 2562);
  this->Filter->SetNumberOfAnchors(100);
  this->Filter->SetBasisMemoryLimit(10);
  EXPECT_EQ(this->Result().rows(), 2562);
  vtktest::ExpectQuiet(*this->Log);
}

TEST_F(LeastSquaresMeshFilter, PartsThatShrinkToAPointOrALineKeepTheirNormals)
{
  const shapes::Shape torus = shapes::Noisy(shapes::Torus(24, 14), 0.02);
  shapes::Shape far = shapes::Noisy(shapes::Torus(24, 14), 0.02, 2);
  far.Positions.rowwise() += Eigen::RowVector3d(7.3, 0.1, -2.7);
  // One anchor of each part makes it a point, two anchors make it a line.
  for (const shapes::Shape& shape : { shapes::Union(torus, far), far })
  {
    this->Input = MakePolyData(shape);
    const auto normals = vtktest::AddArray(this->Input, "Normals", 3,
      [&shape](vtkIdType v, double* value)
      {
        const Eigen::Vector3d direction = shape.Positions.row(v).transpose().normalized();
        std::copy(direction.data(), direction.data() + 3, value);
      });
    this->Input->GetPointData()->SetNormals(normals);
    this->Filter->SetInputData(this->Input);
    this->Filter->SetNumberOfAnchors(2);
    const cartan::Points result = this->Result();
    vtktest::ExpectQuiet(*this->Log);
    double area = 0.0;
    for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
    {
      const Eigen::RowVector3d a = result.row(shape.Faces(t, 0));
      area += (result.row(shape.Faces(t, 1)) - a).cross(result.row(shape.Faces(t, 2)) - a).norm();
    }
    EXPECT_LT(area, 1e-9);
    vtkDataArray* found = this->Filter->GetOutput()->GetPointData()->GetNormals();
    ASSERT_NE(found, nullptr);
    for (vtkIdType v = 0; v < found->GetNumberOfTuples(); ++v)
    {
      const Eigen::Vector3d expected(normals->GetPointer(3 * v));
      EXPECT_LT((Eigen::Vector3d(found->GetTuple3(v)) - expected).norm(), 1e-12) << v;
    }
  }
}
