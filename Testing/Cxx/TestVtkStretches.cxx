// SPDX-License-Identifier: BSD-3-Clause
// The stretches and strains of vtkVolumeChange; what they are is tested in
// TestKernelStretches.cxx.
#include "vtkVolumeChange.h"

#include "AdviceWords.h"
#include "TestShapes.h"
#include "TimeSource.h"
#include "VtkTestHelpers.h"

#include <cmath>

namespace
{
using vtktest::MakePolyData;

/// A plane, and the same stretched to twice its length along x.
class VtkStretches : public testing::Test
{
protected:
  void SetUp() override
  {
    const shapes::Shape plane = shapes::Plane(6, 1.0, 0.2);
    this->Log = vtktest::Observe(this->Filter);
    this->Filter->ComputeLocalVolumeOff();
    shapes::Shape stretched = plane;
    stretched.Positions.col(0) *= 2.0;
    this->Filter->SetInputData(MakePolyData(stretched));
    this->Filter->SetReferenceData(MakePolyData(plane));
  }

  void Update()
  {
    this->Log->Clear();
    this->Filter->Update();
    vtktest::ExpectQuiet(*this->Log);
  }

  /// The array of points, or of cells.
  vtkDataArray* Find(const std::string& name, bool ofPoints)
  {
    vtkPolyData* output = this->Filter->GetOutput();
    vtkDataSetAttributes* attributes = output->GetCellData();
    return (ofPoints ? static_cast<vtkDataSetAttributes*>(output->GetPointData()) : attributes)
      ->GetArray(name.c_str());
  }

  void ExpectAll(const std::string& name, double value)
  {
    for (const bool ofPoints : { true, false })
    {
      vtkDataArray* array = this->Find(name, ofPoints);
      ASSERT_NE(array, nullptr) << name;
      double range[2];
      array->GetRange(range);
      EXPECT_NEAR(range[0], value, 1e-10) << name << ofPoints;
      EXPECT_NEAR(range[1], value, 1e-10) << name << ofPoints;
    }
  }

  vtkNew<vtkVolumeChange> Filter;
  vtkSmartPointer<vtktest::Log> Log;
};
}

TEST_F(VtkStretches, AreArraysOfPointsAndCells)
{
  this->Update();
  this->ExpectAll("Stretch1", 2.0);
  this->ExpectAll("Stretch2", 1.0);
  for (const bool ofPoints : { true, false })
  {
    vtkDataArray* along = this->Find("StretchDirection1", ofPoints);
    vtkDataArray* across = this->Find("StretchDirection2", ofPoints);
    for (vtkIdType i = 0; i < along->GetNumberOfTuples(); ++i)
    {
      EXPECT_NEAR(std::abs(along->GetComponent(i, 0)), 1.0, 1e-10);
      EXPECT_NEAR(std::abs(across->GetComponent(i, 1)), 1.0, 1e-10);
    }
  }
  EXPECT_EQ(this->Find("HenckyStrain1", true), nullptr);
  this->Filter->ComputeStretchesOff();
  this->Update();
  EXPECT_EQ(this->Find("Stretch1", true), nullptr);
}

TEST_F(VtkStretches, GiveStrainsByName)
{
  this->Filter->ComputeStretchesOff();
  this->Filter->SetStrainMeasureToBiot();
  this->Update();
  this->ExpectAll("BiotStrain1", 1.0);
  this->Filter->SetStrainMeasureToGreenLagrange();
  this->Update();
  this->ExpectAll("GreenLagrangeStrain1", 1.5);
  this->ExpectAll("GreenLagrangeStrain2", 0.0);
  EXPECT_EQ(this->Find("BiotStrain1", true), nullptr);
  this->Filter->SetStrainMeasureToHencky();
  this->Update();
  this->ExpectAll("HenckyStrain1", std::log(2.0));
  this->Filter->SetStrainMeasureToEulerAlmansi();
  this->Update();
  this->ExpectAll("EulerAlmansiStrain1", 0.375);
}

// A polygon has the stretches of its largest triangle, a line none.
TEST_F(VtkStretches, OfPolygonsAndLinesToo)
{
  const auto make = [](double width)
  {
    auto surface = vtkSmartPointer<vtkPolyData>::New();
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (const auto& [x, y] : { std::pair(0.0, 0.0), std::pair(1.0, 0.0), std::pair(width, 1.0),
           std::pair(0.0, 1.0), std::pair(5.0, 5.0) })
    {
      points->InsertNextPoint(x, y, 0.0);
    }
    surface->SetPoints(points);
    vtkNew<vtkCellArray> polygons;
    polygons->InsertNextCell({ 0, 1, 2, 3 });
    vtkNew<vtkCellArray> lines;
    lines->InsertNextCell({ 3, 4 });
    surface->SetPolys(polygons);
    surface->SetLines(lines);
    return surface;
  };
  this->Filter->SetInputData(make(1.0));
  this->Filter->SetReferenceData(make(1.0));
  this->Update();
  this->ExpectAll("Stretch1", 1.0);
  ASSERT_EQ(this->Find("Stretch1", false)->GetNumberOfTuples(), 2);
  this->Filter->SetInputData(make(2.0));
  this->Update();
  EXPECT_EQ(this->Find("Stretch1", false)->GetTuple1(0), 1.0); // the line comes first
  EXPECT_GT(this->Find("Stretch1", false)->GetTuple1(1), 0.9);
  EXPECT_EQ(this->Find("Stretch1", true)->GetTuple1(4), 1.0);
}

namespace
{
/// A plane at some times, moved by a function of place and time.
template <typename Move>
vtkSmartPointer<vtktest::TimeSource> MovingPlane(const std::vector<double>& times, const Move& move)
{
  std::vector<vtkSmartPointer<vtkPolyData>> steps;
  for (const double time : times)
  {
    shapes::Shape plane = shapes::Plane(6, 1.0, 0.2);
    for (int v = 0; v < plane.NumberOfVertices(); ++v)
    {
      plane.Positions.row(v) = move(Eigen::RowVector3d(plane.Positions.row(v)), time);
    }
    steps.push_back(MakePolyData(plane));
  }
  auto source = vtkSmartPointer<vtktest::TimeSource>::New();
  source->SetSteps(times, steps);
  return source;
}
}

// Of an exponential growth the rate is the exponent, whatever the steps.
TEST_F(VtkStretches, RatesOfExponentialGrowthAreItsExponents)
{
  const auto source = MovingPlane({ 0.0, 0.5, 2.0, 2.2 },
    [](const Eigen::RowVector3d& x, double t) -> Eigen::RowVector3d {
      return { x[0] * std::exp(0.3 * t), x[1] * std::exp(-0.2 * t), 0.0 };
    });
  this->Filter->SetInputConnection(source->GetOutputPort());
  this->Filter->ComputeRatesOn();
  for (const double time : { 0.0, 0.5, 2.0, 2.2 })
  {
    this->Log->Clear();
    this->Filter->UpdateTimeStep(time);
    vtktest::ExpectQuiet(*this->Log);
    this->ExpectAll("StretchRate1", 0.3);
    this->ExpectAll("StretchRate2", -0.2);
    // The surface is that of the time itself.
    this->ExpectAll("Stretch1", std::exp(0.3 * time));
  }
  EXPECT_LE(source->Requests.size(), 12u);
}

// A simple shear of gamma = rate * time has over an interval h the stretches
// rate h / 2 +- sqrt(1 + (rate h / 2)^2), whose logarithms are +- asinh(rate h / 2).
TEST_F(VtkStretches, RatesOfASimpleShearAreKnown)
{
  const double rate = 0.8;
  const auto source = MovingPlane({ 0.0, 0.1, 0.2 },
    [rate](const Eigen::RowVector3d& x, double t) -> Eigen::RowVector3d {
      return { x[0] + rate * t * x[1], x[1], 0.0 };
    });
  this->Filter->SetInputConnection(source->GetOutputPort());
  this->Filter->ComputeRatesOn();
  this->Filter->UpdateTimeStep(0.1);
  vtktest::ExpectQuiet(*this->Log);
  this->ExpectAll("StretchRate1", std::asinh(0.5 * rate * 0.2) / 0.2);
  this->ExpectAll("StretchRate2", -std::asinh(0.5 * rate * 0.2) / 0.2);
}

TEST_F(VtkStretches, RatesNeedTimeSteps)
{
  this->Filter->ComputeRatesOn();
  this->Filter->Update();
  vtktest::ExpectMessage(this->Log->Errors,
    { "two time steps or more",
      shapes::Advice("turn ComputeRates off, or connect a series and ask for one of its times.") });
  this->Filter->ComputeRatesOff();
  this->Update();
  this->ExpectAll("Stretch1", 2.0);

  const auto source = MovingPlane({ 0.0, 1.0 },
    [](const Eigen::RowVector3d& x, double t) -> Eigen::RowVector3d { return (1.0 + t) * x; });
  const auto other = MakePolyData(shapes::Plane(3));
  const auto same = MakePolyData(shapes::Plane(6, 1.0, 0.2));
  vtkNew<vtktest::TimeSource> changing;
  changing->SetSteps({ 0.0, 1.0 }, { same, other });
  this->Filter->ComputeRatesOn();
  this->Filter->SetInputConnection(changing->GetOutputPort());
  this->Log->Clear();
  this->Filter->UpdateTimeStep(0.0);
  vtktest::ExpectMessage(this->Log->Errors,
    { "time step after",
      shapes::Advice("Give all time steps the same points and cells in the same order.") });
  this->Filter->SetInputConnection(source->GetOutputPort());
  this->Log->Clear();
  this->Filter->UpdateTimeStep(0.0);
  vtktest::ExpectQuiet(*this->Log);
  this->ExpectAll("StretchRate1", std::log(2.0));
}
