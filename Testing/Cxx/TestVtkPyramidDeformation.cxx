// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPyramidDeformation.h"

#include "AdviceWords.h"
#include "VtkTestHelpers.h"
#include "vtkHandleMotion.h"

namespace
{
/// A bar of length 10 along z; its ends are handles 1 and 2.
vtkSmartPointer<vtkPolyData> BarWithEnds()
{
  vtkSmartPointer<vtkPolyData> bar =
    vtktest::MakePolyData(shapes::Bar(4, 4, 40, { 1.0, 1.0, 10.0 }), VTK_DOUBLE);
  vtktest::AddHandles(
    bar, [](const Eigen::Vector3d& p) { return p[2] < 1.0 ? 1
                                          : p[2] > 9.0    ? 2
                                                          : 0; });
  return bar;
}

class PyramidDeformation : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Motion->SetAxis(1.0, 0.0, 0.0);
    this->Motion->SetCenter(0.0, 0.0, 9.0);
    this->Motion->SetAngle(60.0);
    this->Motion->SetTranslation(0.0, -3.0, -1.0);
    this->Filter->SetInputData(BarWithEnds());
    this->Filter->SetHandleMotion(2, this->Motion);
    this->Log = vtktest::Observe(this->Filter);
  }

  vtkNew<vtkHandleMotion> Motion;
  vtkNew<vtkPyramidDeformation> Filter;
  vtkSmartPointer<vtktest::Log> Log;
};
}

TEST_F(PyramidDeformation, ReportsEnergiesAndConvergence)
{
  this->Filter->GeneratePyramidEnergyOn();
  this->Filter->Update();
  vtktest::ExpectQuiet(*this->Log);
  EXPECT_TRUE(this->Filter->GetConverged());
  EXPECT_GT(this->Filter->GetNumberOfIterations(), 1);
  EXPECT_GT(this->Filter->GetFinalEnergy(), 0.0);
  EXPECT_LT(this->Filter->GetFinalEnergy(), this->Filter->GetInitialEnergy());
  vtkDataArray* energies = this->Filter->GetOutput()->GetPointData()->GetArray("PyramidEnergy");
  ASSERT_TRUE(energies);
  double sum = 0.0;
  for (vtkIdType v = 0; v < energies->GetNumberOfTuples(); ++v)
  {
    sum += energies->GetTuple1(v);
  }
  EXPECT_NEAR(sum, this->Filter->GetFinalEnergy(), 1e-9 * sum);
}

TEST_F(PyramidDeformation, SettlesWithMoreIterations)
{
  this->Filter->SetInitialGuessToRestShape();
  this->Filter->SetMaximumIterations(3);
  this->Filter->Update();
  EXPECT_FALSE(this->Filter->GetConverged());
  vtktest::ExpectMessage(this->Log->Warnings,
    { "has not settled: the last of 3 iterations", shapes::Advice("Raise MaximumIterations.") });
  this->Log->Clear();
  this->Filter->SetMaximumIterations(2000);
  this->Filter->Update();
  vtktest::ExpectQuiet(*this->Log);
  EXPECT_TRUE(this->Filter->GetConverged());
}

TEST_F(PyramidDeformation, WantsHandlesInPosition)
{
  this->Filter->ConstrainHandlePositionsOff();
  this->Filter->Update();
  vtktest::ExpectMessage(
    this->Log->Errors, { shapes::Advice("turn ConstrainHandlePositions on.") });
  EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
  this->Log->Clear();
  this->Filter->ConstrainHandlePositionsOn();
  this->Filter->Update();
  vtktest::ExpectQuiet(*this->Log);
}
