// SPDX-License-Identifier: BSD-3-Clause
#include "vtkAsRigidAsPossibleDeformation.h"

#include "VtkTestHelpers.h"
#include "vtkHandleMotion.h"
#include "vtkShapePreservingDeformation.h"

#include "vtkMatrix4x4.h"

#include <algorithm>
#include <sstream>

namespace
{
/// A bar of length 10 along z; its ends are handles 1 and 2.
vtkSmartPointer<vtkPolyData> MarkedBar(int precision = VTK_DOUBLE)
{
  vtkSmartPointer<vtkPolyData> bar =
    vtktest::MakePolyData(shapes::Bar(4, 4, 40, { 1.0, 1.0, 10.0 }), precision);
  vtktest::AddHandles(
    bar, [](const Eigen::Vector3d& p) { return p[2] < 1.0 ? 1
                                          : p[2] > 9.0    ? 2
                                                          : 0; });
  return bar;
}

class AsRigidAsPossibleDeformation : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Motion->SetAxis(1.0, 0.0, 0.0);
    this->Motion->SetCenter(0.0, 0.0, 9.0);
    this->Motion->SetAngle(60.0);
    this->Motion->SetTranslation(0.0, -3.0, -1.0);
    this->Filter->SetInputData(MarkedBar());
    this->Filter->SetHandleMotion(2, this->Motion);
    this->Log = vtktest::Observe(this->Filter);
  }

  vtkNew<vtkHandleMotion> Motion;
  vtkNew<vtkAsRigidAsPossibleDeformation> Filter;
  vtkSmartPointer<vtktest::Log> Log;
};
}

TEST_F(AsRigidAsPossibleDeformation, LowersTheEnergyOfTheGuess)
{
  // Thick, so that ten iterations from the rest shape are enough.
  this->Filter->SetBending(0.3);
  for (const int energy :
    { vtkAsRigidAsPossibleDeformation::SPOKES, vtkAsRigidAsPossibleDeformation::SPOKES_AND_RIMS,
      vtkAsRigidAsPossibleDeformation::SMOOTHED_ROTATIONS })
  {
    this->Filter->SetEnergy(energy);
    for (const int guess : { vtkAsRigidAsPossibleDeformation::REST_SHAPE,
           vtkAsRigidAsPossibleDeformation::PREVIOUS_RESULT,
           vtkAsRigidAsPossibleDeformation::ROTATION_INVARIANT,
           vtkAsRigidAsPossibleDeformation::SHAPE_PRESERVING })
    {
      this->Filter->SetInitialGuess(guess);
      if (energy == vtkAsRigidAsPossibleDeformation::SMOOTHED_ROTATIONS &&
        guess == vtkAsRigidAsPossibleDeformation::REST_SHAPE)
      {
        this->Filter->SetMaximumIterations(2);
        this->Filter->Update();
        vtktest::ExpectMessage(this->Log->Warnings,
          { "have not settled: the last of 2 iterations", "Raise MaximumIterations" });
        this->Log->Clear();
        this->Filter->SetMaximumIterations(10);
      }
      this->Filter->Update();
      vtktest::ExpectQuiet(*this->Log);
      EXPECT_GT(this->Filter->GetNumberOfIterations(), 0);
      EXPECT_LE(this->Filter->GetNumberOfIterations(), 10);
      EXPECT_GT(this->Filter->GetFinalEnergy(), 0.0);
      EXPECT_LT(this->Filter->GetFinalEnergy(), this->Filter->GetInitialEnergy());
      EXPECT_GT(this->Filter->GetResidual(), 0.0);
      EXPECT_LT(this->Filter->GetResidual(), 1.0);
    }
  }
}

TEST_F(AsRigidAsPossibleDeformation, MovesHandlesExactlyAndHandsArraysOn)
{
  vtkSmartPointer<vtkPolyData> input = MarkedBar(VTK_FLOAT);
  const vtkSmartPointer<vtkPolyData> before = vtktest::CopyOf(input);
  this->Filter->SetInputData(input);
  this->Filter->GenerateRigidityEnergyOn();
  this->Filter->GenerateRotationVectorOn();
  this->Filter->Update();
  vtktest::ExpectQuiet(*this->Log);
  vtktest::ExpectSameSurface(input, before);
  vtkPolyData* output = this->Filter->GetOutput();
  EXPECT_EQ(output->GetPoints()->GetDataType(), VTK_FLOAT);
  vtktest::ExpectSameCells(output, input);
  vtktest::ExpectArrays(output->GetPointData(), input->GetPointData(), false);
  vtkDataArray* energies = output->GetPointData()->GetArray("RigidityEnergy");
  vtkDataArray* rotations = output->GetPointData()->GetArray("RotationVector");
  ASSERT_TRUE(energies && rotations);
  vtkNew<vtkMatrix4x4> transform;
  this->Motion->GetTransform(transform);
  double sum = 0.0;
  for (vtkIdType v = 0; v < input->GetNumberOfPoints(); ++v)
  {
    sum += energies->GetTuple1(v);
    Eigen::Vector3d p(input->GetPoint(v));
    if (p[2] > 9.0)
    {
      const double point[4] = { p[0], p[1], p[2], 1.0 };
      double expected[4];
      transform->MultiplyPoint(point, expected);
      EXPECT_LT((Eigen::Vector3d(output->GetPoint(v)) - Eigen::Vector3d(expected)).norm(), 1e-5);
    }
    if (p[2] > 9.6)
    {
      Eigen::Vector3d rotation;
      rotations->GetTuple(v, rotation.data());
      EXPECT_LT((rotation - Eigen::Vector3d(shapes::Pi / 3.0, 0.0, 0.0)).norm(), 1e-5);
    }
  }
  EXPECT_NEAR(sum, this->Filter->GetFinalEnergy(), 1e-9 * sum);
}

TEST_F(AsRigidAsPossibleDeformation, FactorizesOnceForAllMotions)
{
  for (int motion = 0; motion < 10; ++motion)
  {
    this->Motion->SetAngle(10.0 * motion);
    this->Filter->SetMaximumIterations(motion);
    this->Filter->SetBending(0.01 * motion);
    this->Filter->Update();
  }
  EXPECT_EQ(this->Filter->GetNumberOfFactorizations(), 1);
  this->Filter->SetEnergyToSpokesAndRims();
  this->Filter->Update();
  EXPECT_EQ(this->Filter->GetNumberOfFactorizations(), 2);
  vtktest::ExpectQuiet(*this->Log);
}

TEST_F(AsRigidAsPossibleDeformation, WithoutIterationsIsTheGuess)
{
  // The bar's cotangents are not negative: nothing is clamped.
  this->Filter->SetMaximumIterations(0);
  this->Filter->Update();
  EXPECT_EQ(this->Filter->GetNumberOfIterations(), 0);
  EXPECT_FALSE(this->Filter->GetConverged());
  EXPECT_EQ(this->Filter->GetInitialEnergy(), this->Filter->GetFinalEnergy());
  vtkNew<vtkShapePreservingDeformation> linear;
  linear->SetVolumeCorrectionToNone();
  linear->SetInputData(this->Filter->GetInput());
  linear->SetHandleMotion(2, this->Motion);
  linear->Update();
  EXPECT_LT((vtktest::PointsOf(this->Filter->GetOutput()) - vtktest::PointsOf(linear->GetOutput()))
              .cwiseAbs()
              .maxCoeff(),
    1e-9);
}

TEST_F(AsRigidAsPossibleDeformation, ConvergesToItsTolerance)
{
  this->Filter->SetMaximumIterations(1000);
  this->Filter->SetTolerance(1e-8);
  this->Filter->Update();
  EXPECT_TRUE(this->Filter->GetConverged());
  EXPECT_LT(this->Filter->GetNumberOfIterations(), 1000);
}

TEST_F(AsRigidAsPossibleDeformation, RefusesLapsAboutDifferentAxes)
{
  // Between two moving handles there is one axis; a pinned point amid the first
  // makes two.
  const vtkSmartPointer<vtkPolyData> bar = MarkedBar();
  bar->GetPointData()->GetArray("Handle")->SetTuple1(bar->FindPoint(0.0, 0.0, 0.0), 3.0);
  this->Filter->SetInputData(bar);
  vtkNew<vtkHandleMotion> other;
  other->SetAxis(0.0, 0.0, 1.0);
  other->SetAngle(400.0);
  this->Filter->SetHandleMotion(1, other);
  this->Filter->Update();
  vtktest::ExpectMessage(this->Log->Errors, { "different axes", "360 degrees" });
  EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
  // Other guesses see where the points go.
  this->Log->Clear();
  this->Filter->SetInitialGuessToRotationInvariant();
  this->Filter->Update();
  vtktest::ExpectQuiet(*this->Log);
  EXPECT_GT(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
}

TEST_F(AsRigidAsPossibleDeformation, HasDocumentedDefaultsAndClamps)
{
  vtkNew<vtkAsRigidAsPossibleDeformation> filter;
  EXPECT_EQ(filter->GetEnergy(), vtkAsRigidAsPossibleDeformation::SPOKES);
  EXPECT_EQ(filter->GetInitialGuess(), vtkAsRigidAsPossibleDeformation::SHAPE_PRESERVING);
  EXPECT_EQ(filter->GetBending(), 0.03);
  EXPECT_EQ(filter->GetMaximumIterations(), 10);
  EXPECT_EQ(filter->GetTolerance(), 1e-4);
  filter->SetEnergy(17);
  EXPECT_EQ(filter->GetEnergy(), vtkAsRigidAsPossibleDeformation::SMOOTHED_ROTATIONS);
  filter->SetInitialGuess(-3);
  EXPECT_EQ(filter->GetInitialGuess(), vtkAsRigidAsPossibleDeformation::REST_SHAPE);
  filter->SetBending(-1.0);
  EXPECT_EQ(filter->GetBending(), 0.0);
  std::ostringstream text;
  filter->Print(text);
  EXPECT_NE(text.str().find("InitialGuess: 0"), std::string::npos);
}

TEST_F(AsRigidAsPossibleDeformation, LeavesMostOfTheProgressToTheIterations)
{
  this->Filter->SetMaximumIterations(40);
  this->Filter->SetTolerance(0.0);
  vtkNew<vtktest::ProgressLog> progress;
  this->Filter->AddObserver(vtkCommand::ProgressEvent, progress);
  this->Filter->Update();
  ASSERT_GT(this->Filter->GetNumberOfIterations(), 10);
  const auto inTheLastHalf = std::count_if(progress->Fractions.begin(), progress->Fractions.end(),
    [](double fraction) { return fraction > 0.4 && fraction < 0.9; });
  EXPECT_GT(inTheLastHalf, 20);
  EXPECT_TRUE(std::is_sorted(progress->Fractions.begin(), progress->Fractions.end()));
}
