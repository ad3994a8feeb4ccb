// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceMorph.h"

#include "Kernel/Measure/ComponentVolumes.h"
#include "MorphShapes.h"
#include "TimeSource.h"
#include "VtkTestHelpers.h"
#include "vtkVolumeChange.h"

#include "vtkFloatArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPolyDataNormals.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"

#include <cmath>
#include <set>
#include <sstream>

using cartan::Points;
using shapes::Shape;
using vtktest::MakePolyData;
using vtktest::PointsOf;
using vtktest::TimeSource;
using Pipeline = vtkStreamingDemandDrivenPipeline;

namespace
{
Shape BarShape()
{
  return shapes::Bar(3, 3, 18, { 1, 1, 6 });
}

struct Fixture
{
  vtkNew<vtkSurfaceMorph> Filter;
  vtkSmartPointer<vtktest::Log> Log = vtktest::Observe(Filter);
  Shape Bar = BarShape();
  std::vector<vtkSmartPointer<vtkPolyData>> Keys;

  explicit Fixture(int precision = VTK_DOUBLE)
  {
    this->AddKey(this->Bar.Positions, precision);
    this->AddKey(morphshapes::Bend(this->Bar, 150, 1, 5), precision);
  }
  void AddKey(const Points& positions, int precision = VTK_DOUBLE)
  {
    this->Keys.push_back(MakePolyData({ positions, this->Bar.Faces }, precision));
    this->Filter->AddInputData(this->Keys.back());
  }
  Points At(double parameter)
  {
    this->Filter->SetParameter(parameter);
    this->Log->Clear();
    this->Filter->Update();
    vtktest::ExpectQuiet(*this->Log);
    return PointsOf(this->Filter->GetOutput());
  }
  void ExpectError(const std::vector<std::string>& parts)
  {
    this->Log->Clear();
    this->Filter->Update();
    vtktest::ExpectMessage(this->Log->Errors, parts);
    EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfCells(), 0);
  }
};

double Distance(const Points& a, const Points& b)
{
  return (a - b).cwiseAbs().maxCoeff();
}
}

TEST(VtkSurfaceMorph, MeetsTheKeyFramesToTheLastBit)
{
  for (const int precision : { VTK_FLOAT, VTK_DOUBLE })
  {
    for (int method = vtkSurfaceMorph::DISCRETE_FORMS; method <= vtkSurfaceMorph::LINEAR; ++method)
    {
      Fixture fixture(precision);
      fixture.AddKey(morphshapes::Twist(fixture.Bar, 70, 1, 5), precision);
      fixture.Filter->SetMethod(method);
      for (int k = 0; k < 3; ++k)
      {
        fixture.At(0.5 * k);
        vtktest::ExpectSameSurface(fixture.Filter->GetOutput(), fixture.Keys[k]);
      }
      // And next to them.
      EXPECT_LT(Distance(fixture.At(0.5 - 1e-8), PointsOf(fixture.Keys[1])), 1e-6) << method;
      EXPECT_LT(Distance(fixture.At(0.5 + 1e-8), PointsOf(fixture.Keys[1])), 1e-6) << method;
    }
  }
}

TEST(VtkSurfaceMorph, KeepsEdgesWhereLinearInterpolationShrinks)
{
  Fixture fixture;
  const auto keys =
    morphshapes::Keys(fixture.Bar, { PointsOf(fixture.Keys[0]), PointsOf(fixture.Keys[1]) });
  for (const int method : { vtkSurfaceMorph::DISCRETE_FORMS, vtkSurfaceMorph::ISOMETRIC,
         vtkSurfaceMorph::DEFORMATION_GRADIENT, vtkSurfaceMorph::PYRAMID_COORDINATES })
  {
    fixture.Filter->SetMethod(method);
    const auto figures = morphshapes::MeasureMorph(keys, fixture.At(0.5), 0.5);
    EXPECT_NEAR(figures.Volume, 1.0, 0.01) << method;
    EXPECT_LT(figures.EdgeRms, 0.01) << method;
    EXPECT_EQ(fixture.Filter->GetNumberOfKeyFrames(), 2);
  }
  fixture.Filter->SetMethodToLinear();
  EXPECT_GT(morphshapes::MeasureMorph(keys, fixture.At(0.5), 0.5).EdgeRms, 0.05);
  EXPECT_LT(Distance(fixture.At(0.25), 0.75 * keys.Positions[0] + 0.25 * keys.Positions[1]), 1e-12);
}

TEST(VtkSurfaceMorph, OffersTimeStepsAndFollowsTime)
{
  Fixture fixture;
  fixture.AddKey(morphshapes::Twist(fixture.Bar, 70, 1, 5));
  fixture.Filter->SetStepsBetweenKeyFrames(4);
  fixture.Filter->UpdateInformation();
  vtkInformation* info = fixture.Filter->GetOutputInformation(0);
  ASSERT_EQ(info->Length(Pipeline::TIME_STEPS()), 9);
  for (int i = 0; i < 9; ++i)
  {
    EXPECT_EQ(info->Get(Pipeline::TIME_STEPS())[i], i / 8.0);
  }
  EXPECT_EQ(info->Get(Pipeline::TIME_RANGE())[1], 1.0);

  const Points expected = fixture.At(0.375);
  fixture.Filter->SetParameter(0.0);
  fixture.Filter->UpdateTimeStep(0.375);
  EXPECT_LT(Distance(PointsOf(fixture.Filter->GetOutput()), expected), 1e-9);
  EXPECT_EQ(
    fixture.Filter->GetOutput()->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), 0.375);
  // Time stays within the key frames, Parameter need not.
  fixture.Filter->UpdateTimeStep(7.0);
  EXPECT_EQ(Distance(PointsOf(fixture.Filter->GetOutput()), PointsOf(fixture.Keys[2])), 0.0);
  fixture.Filter->FollowTimeOff();
  fixture.Filter->UpdateTimeStep(0.375);
  EXPECT_EQ(Distance(PointsOf(fixture.Filter->GetOutput()), PointsOf(fixture.Keys[0])), 0.0);
  EXPECT_FALSE(fixture.Filter->GetOutputInformation(0)->Has(Pipeline::TIME_STEPS()));
}

TEST(VtkSurfaceMorph, OffersTimesThatMeetThoseOfOthers)
{
  // Each time is the number that one would write: 0.6, not 0.6000000000000001.
  Fixture fixture;
  for (const int steps : { 3, 5, 10, 15, 30 })
  {
    fixture.Filter->SetStepsBetweenKeyFrames(steps);
    fixture.Filter->UpdateInformation();
    vtkInformation* info = fixture.Filter->GetOutputInformation(0);
    ASSERT_EQ(info->Length(Pipeline::TIME_STEPS()), steps + 1);
    for (int i = 0; i <= steps; ++i)
    {
      EXPECT_EQ(info->Get(Pipeline::TIME_STEPS())[i], static_cast<double>(i) / steps);
    }
  }
}

TEST(VtkSurfaceMorph, InterpolatesTheTimeStepsOfOneInput)
{
  // Six time steps at uneven times, against the same as six inputs.
  const Shape bar = BarShape();
  const std::vector<double> times = { 10, 11, 13, 16, 18, 20 };
  std::vector<vtkSmartPointer<vtkPolyData>> surfaces;
  for (int k = 0; k < 6; ++k)
  {
    surfaces.push_back(MakePolyData({ morphshapes::Bend(bar, 1 + 20.0 * k * k, 1, 5), bar.Faces }));
  }
  vtkNew<TimeSource> source;
  source->SetSteps(times, surfaces);
  vtkNew<vtkSurfaceMorph> filter;
  const auto log = vtktest::Observe(filter);
  filter->SetInputConnection(source->GetOutputPort());
  filter->SetStepsBetweenKeyFrames(2);
  filter->UpdateInformation();
  vtkInformation* info = filter->GetOutputInformation(0);
  ASSERT_EQ(info->Length(Pipeline::TIME_STEPS()), 11);
  EXPECT_EQ(info->Get(Pipeline::TIME_STEPS())[3], 12.0);

  for (int k = 0; k < 6; ++k)
  {
    filter->UpdateTimeStep(times[k]);
    vtktest::ExpectSameSurface(filter->GetOutput(), surfaces[k]);
  }
  EXPECT_EQ(filter->GetNumberOfKeyFrames(), 6);
  // Each was read once on the way through.
  EXPECT_EQ(source->Requests.size(), 6u);
  source->Requests.clear();
  filter->UpdateTimeStep(17);
  const std::set<double> read(source->Requests.begin(), source->Requests.end());
  for (const double time : read)
  {
    EXPECT_TRUE(time >= 13 && time <= 20) << "read time step " << time << " for time 17";
  }
  filter->UpdateTimeStep(17.5);
  EXPECT_EQ(filter->GetSetupTime(), 0.0);

  // More than four key frames change nothing: the same from the four around.
  const auto keys = morphshapes::Keys(bar, { PointsOf(surfaces[3]), PointsOf(surfaces[4]) });
  const morphshapes::MorphFigures figures =
    morphshapes::MeasureMorph(keys, PointsOf(filter->GetOutput()), 0.75);
  EXPECT_NEAR(figures.Volume, 1.0, 0.02);
  EXPECT_LT(figures.EdgeRms, 0.03);

  // Without a time, by the parameter.
  vtkNew<vtkSurfaceMorph> byParameter;
  byParameter->SetInputConnection(source->GetOutputPort());
  byParameter->SetParameter(0.1);
  byParameter->Update();
  EXPECT_EQ(Distance(PointsOf(byParameter->GetOutput()), PointsOf(surfaces[1])), 0.0);
  vtktest::ExpectQuiet(*log);

  // A source that changes is read again.
  surfaces[4] = MakePolyData({ morphshapes::Twist(bar, 20, 1, 5), bar.Faces });
  source->SetSteps(times, surfaces);
  filter->UpdateTimeStep(18);
  vtktest::ExpectSameSurface(filter->GetOutput(), surfaces[4]);
}

TEST(VtkSurfaceMorph, KeepsWhatItComputedUntilKeyFramesChange)
{
  Fixture fixture;
  fixture.At(0.3);
  EXPECT_GT(fixture.Filter->GetSetupTime(), 0.0);
  fixture.At(0.4);
  EXPECT_EQ(fixture.Filter->GetSetupTime(), 0.0);
  EXPECT_GT(fixture.Filter->GetNumberOfIterations(), 0);
  const Points before = fixture.At(0.5);
  // Equal points in a new array are the same.
  fixture.Keys[1]->SetPoints(vtktest::CopyOf(fixture.Keys[1])->GetPoints());
  fixture.At(0.5);
  EXPECT_EQ(fixture.Filter->GetSetupTime(), 0.0);
  fixture.Keys[1]->GetPoints()->SetPoint(0, -0.4, -0.4, -0.1);
  fixture.Keys[1]->GetPoints()->Modified();
  EXPECT_GT(Distance(fixture.At(0.5), before), 1e-3);
  EXPECT_GT(fixture.Filter->GetSetupTime(), 0.0);
}

TEST(VtkSurfaceMorph, EverySettingHasAnEffect)
{
  Fixture fixture;
  for (auto& key : fixture.Keys)
  {
    vtktest::AddHandles(key, [](const Eigen::Vector3d& x) { return x[2] < 1 ? 1 : 0; });
  }
  const Points before = fixture.At(0.5);
  vtkSurfaceMorph* filter = fixture.Filter;
  const std::vector<std::pair<std::string, std::function<void()>>> changes = {
    { "FrameSolver", [=]() { filter->SetFrameSolverToDirect(); } },
    { "TransitionInterpolation", [=]() { filter->SetTransitionInterpolationToForms(); } },
    { "CloseVolume", [=]() { filter->CloseVolumeOn(); } },
    { "Placement", [=]() { filter->SetPlacementToPinnedHandle(); } },
    { "Method", [=]() { filter->SetMethodToIsometric(); } },
    { "Stitching", [=]() { filter->SetStitchingToTree(); } },
    { "Stitching again", [=]() { filter->SetStitchingToTreeAverage(); } },
    { "LengthPolish",
      [=]()
      {
        filter->SetStitchingToAllHinges();
        filter->SetLengthPolish(3);
      } },
  };
  Points last = before;
  for (const auto& [name, change] : changes)
  {
    change();
    const Points now = fixture.At(0.5);
    EXPECT_GT(Distance(now, last), 1e-9) << name;
    EXPECT_LT(Distance(now, last), 3.0) << name;
    last = now;
  }
  EXPECT_GT(filter->GetMTime(), 0u);
}

TEST(VtkSurfaceMorph, PinsAHandle)
{
  Fixture fixture;
  for (auto& key : fixture.Keys)
  {
    vtktest::AddHandles(key, [](const Eigen::Vector3d& x) { return x[2] < 0.9 ? 1 : 0; });
  }
  const auto drift = [&]()
  {
    const Points now = fixture.At(0.5);
    double worst = 0.0;
    for (int v = 0; v < fixture.Bar.NumberOfVertices(); ++v)
    {
      if (fixture.Bar.Positions(v, 2) < 0.9)
      {
        worst = std::max(worst, (now.row(v) - fixture.Bar.Positions.row(v)).norm());
      }
    }
    return worst;
  };
  EXPECT_GT(drift(), 0.2);
  fixture.Filter->SetPlacementToPinnedHandle();
  EXPECT_LT(drift(), 0.01);
}

TEST(VtkSurfaceMorph, ClosesTheVolumeOnThatBetweenTheKeyFrames)
{
  Fixture fixture;
  fixture.AddKey(2.0 * fixture.Bar.Positions);
  fixture.Filter->CloseVolumeOn();
  const cartan::TriangleMesh mesh(fixture.Bar.NumberOfVertices(), fixture.Bar.Faces);
  const auto volume = [&](const Points& points)
  { return cartan::MeasureComponents(mesh, points)[0].Volume; };
  // Monotone cubic through the volumes: between those of the neighbors.
  const double first = volume(PointsOf(fixture.Keys[0]));
  const double second = volume(PointsOf(fixture.Keys[1]));
  const double third = volume(PointsOf(fixture.Keys[2]));
  const double between = volume(fixture.At(0.25));
  EXPECT_TRUE(between >= std::min(first, second) && between <= std::max(first, second));
  const double later = volume(fixture.At(0.75));
  EXPECT_TRUE(later > second && later < third);
}

TEST(VtkSurfaceMorph, InterpolatesPointDataAndPassesTheRest)
{
  Fixture fixture;
  for (int k = 0; k < 2; ++k)
  {
    vtktest::AddArray(fixture.Keys[k], "Heat", 2,
      [k](vtkIdType v, double* value)
      {
        value[0] = static_cast<double>(v) + 10.0 * k;
        value[1] = -1.0;
      });
    vtktest::AddHandles(fixture.Keys[k], [k](const Eigen::Vector3d&) { return k; });
    vtkNew<vtkIntArray> ids;
    ids->SetName("Cell");
    for (vtkIdType cell = 0; cell < fixture.Keys[k]->GetNumberOfCells(); ++cell)
    {
      ids->InsertNextValue(static_cast<int>(cell) + k);
    }
    fixture.Keys[k]->GetCellData()->AddArray(ids);
  }
  vtktest::AddArray(fixture.Keys[0], "Only first", 1, [](vtkIdType, double* x) { *x = 5.0; });
  fixture.Filter->SetParameter(0.25);
  fixture.Filter->Update();
  EXPECT_TRUE(fixture.Log->Errors.empty());
  vtktest::ExpectMessage(fixture.Log->Warnings, { "\"Only first\"", "not all key frames" });
  vtkPolyData* output = fixture.Filter->GetOutput();
  vtkDataArray* heat = output->GetPointData()->GetArray("Heat");
  EXPECT_EQ(heat->GetComponent(7, 0), 9.5);
  EXPECT_EQ(heat->GetComponent(7, 1), -1.0);
  EXPECT_EQ(output->GetPointData()->GetArray("Handle")->GetComponent(3, 0), 0.0);
  EXPECT_EQ(output->GetPointData()->GetArray("Only first"), nullptr);
  EXPECT_EQ(output->GetCellData()->GetArray("Cell")->GetComponent(3, 0), 3.0);
  vtktest::ExpectSameCells(output, fixture.Keys[0]);
  // Beyond the middle the last one is nearer; at its parameter all is its own.
  for (const double parameter : { 0.75, 1.0 })
  {
    fixture.Filter->SetParameter(parameter);
    fixture.Filter->Update();
    EXPECT_EQ(output->GetPointData()->GetArray("Handle")->GetComponent(3, 0), 1.0);
    EXPECT_EQ(output->GetCellData()->GetArray("Cell")->GetComponent(3, 0), 4.0);
  }
  vtktest::ExpectSameSurface(fixture.Filter->GetOutput(), fixture.Keys[1]);
}

TEST(VtkSurfaceMorph, ComputesNormalsAnew)
{
  vtkNew<vtkPolyDataNormals> normals;
  Fixture fixture;
  vtkNew<vtkSurfaceMorph> filter;
  for (auto& key : fixture.Keys)
  {
    normals->SetInputData(key);
    normals->SplittingOff();
    normals->Update();
    filter->AddInputData(vtktest::CopyOf(normals->GetOutput()));
  }
  filter->SetParameter(0.5);
  filter->Update();
  vtkDataArray* array = filter->GetOutput()->GetPointData()->GetNormals();
  ASSERT_NE(array, nullptr);
  for (vtkIdType v = 0; v < array->GetNumberOfTuples(); ++v)
  {
    EXPECT_NEAR(Eigen::Vector3d(array->GetTuple3(v)).norm(), 1.0, 1e-6);
  }
}

TEST(VtkSurfaceMorph, TakesPolygonsAndPointsInNoCell)
{
  Fixture fixture;
  vtkNew<vtkSurfaceMorph> filter;
  const auto log = vtktest::Observe(filter);
  for (int k = 0; k < 2; ++k)
  {
    vtkNew<vtkPolyData> quads;
    vtkNew<vtkPoints> points;
    const double bend = 0.4 * k;
    for (int i = 0; i < 6; ++i)
    {
      points->InsertNextPoint(i, 0.0, bend * i * i);
      points->InsertNextPoint(i, 1.0, bend * i * i);
    }
    points->InsertNextPoint(k, 2.0 * k, 9.0);
    quads->SetPoints(points);
    vtkNew<vtkCellArray> cells;
    for (vtkIdType i = 0; i < 5; ++i)
    {
      cells->InsertNextCell({ 2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1 });
    }
    quads->SetPolys(cells);
    filter->AddInputData(quads);
  }
  filter->SetParameter(0.25);
  filter->Update();
  vtktest::ExpectQuiet(*log);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 5);
  const Points points = PointsOf(filter->GetOutput());
  EXPECT_LT((points.row(12) - Eigen::RowVector3d(0.25, 0.5, 9.0)).norm(), 1e-12);
  EXPECT_TRUE(points.allFinite());
}

TEST(VtkSurfaceMorph, FarFromTheOriginAndTiny)
{
  Fixture fixture;
  const Points expected = fixture.At(0.5);
  for (const double unit : { 1e-9, 1.0 })
  {
    const double far = unit == 1.0 ? 1e6 : 0.0;
    vtkNew<vtkSurfaceMorph> filter;
    for (auto& key : fixture.Keys)
    {
      const Points moved = (unit * PointsOf(key)).array() + far;
      filter->AddInputData(MakePolyData({ moved, fixture.Bar.Faces }));
    }
    filter->SetParameter(0.5);
    filter->Update();
    const Points found = (PointsOf(filter->GetOutput()).array() - far) / unit;
    EXPECT_LT(Distance(found, expected), 1e-8);
  }
}

TEST(VtkSurfaceMorph, TheMeasuresFollowItOverTime)
{
  Fixture fixture;
  vtkNew<vtkVolumeChange> change;
  change->SetInputConnection(fixture.Filter->GetOutputPort());
  change->SetReferenceData(fixture.Keys[0]);
  change->UpdateInformation();
  vtkInformation* info = change->GetOutputInformation(1);
  ASSERT_TRUE(info->Has(Pipeline::TIME_STEPS()));
  double last = -1.0;
  for (const double time : { 0.0, 0.5, 1.0 })
  {
    change->UpdateTimeStep(time);
    EXPECT_GT(change->GetEdgeLengthRMS(), last) << time;
    last = change->GetEdgeLengthRMS();
  }
}

TEST(VtkSurfaceMorph, RefusesBadKeyFrames)
{
  const auto good = MakePolyData(shapes::Plane(4));
  for (const vtktest::BadSurface& bad : vtktest::BadSurfaces())
  {
    vtkNew<vtkSurfaceMorph> filter;
    const auto log = vtktest::Observe(filter);
    filter->AddInputData(good);
    filter->AddInputData(bad.Surface);
    const auto copy = vtktest::CopyOf(bad.Surface);
    filter->Update();
    std::vector<std::string> parts = bad.Parts;
    parts.emplace_back("key frame 1");
    vtktest::ExpectMessage(log->Errors, parts);
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0) << bad.Name;
    vtktest::ExpectSameSurface(bad.Surface, copy);
  }
}

TEST(VtkSurfaceMorph, SaysWhatDiffersBetweenKeyFrames)
{
  Fixture fixture;
  const auto refuse = [&](vtkPolyData* other, const std::vector<std::string>& parts)
  {
    vtkNew<vtkSurfaceMorph> filter;
    const auto log = vtktest::Observe(filter);
    filter->AddInputData(fixture.Keys[0]);
    filter->AddInputData(fixture.Keys[1]);
    filter->AddInputData(other);
    filter->SetParameter(0.25);
    filter->Update();
    vtktest::ExpectMessage(log->Errors, parts);
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  };
  refuse(MakePolyData(shapes::Plane(4)), { "key frame 0", "points", "key frame 2", "25" });
  Shape flipped = fixture.Bar;
  flipped.Faces.row(5).swap(flipped.Faces.row(6));
  refuse(MakePolyData(flipped), { "2 cells (ids 5, 6)", "key frame 2", "same points and cells" });

  fixture.Filter->RemoveAllInputConnections(0);
  fixture.Filter->AddInputData(fixture.Keys[0]);
  fixture.ExpectError({ "one key frame", "two surfaces or more", "time steps" });
  fixture.Filter->AddInputData(fixture.Keys[1]);
  EXPECT_EQ(Distance(fixture.At(1.0), PointsOf(fixture.Keys[1])), 0.0);
}

TEST(VtkSurfaceMorph, RefusesWhatHasNoPlaceOrNoLength)
{
  Fixture fixture;
  fixture.Filter->SetParameter(0.5);
  fixture.Filter->SetPlacementToPinnedHandle();
  fixture.ExpectError({ "no numeric point array \"Handle\"" });
  vtktest::AddHandles(fixture.Keys[0], [](const Eigen::Vector3d&) { return 0; });
  fixture.Filter->Modified();
  fixture.ExpectError({ "No point", "\"Handle\"", "Mark Handle" });
  vtktest::AddHandles(
    fixture.Keys[0], [](const Eigen::Vector3d& x) { return x[0] < -0.4 && x[1] < -0.4 ? 1 : 0; });
  fixture.Filter->Modified();
  fixture.ExpectError({ "on one line", "three points" });
  fixture.Filter->SetPlacementToRigidInterpolation();
  fixture.At(0.5);

  fixture.Keys[1]->GetPoints()->SetPoint(0, fixture.Keys[1]->GetPoint(1));
  fixture.Keys[1]->GetPoints()->Modified();
  vtkNew<vtkSurfaceMorph> enlarging;
  const auto log = vtktest::Observe(enlarging);
  enlarging->AddInputData(fixture.Keys[0]);
  enlarging->AddInputData(MakePolyData({ 3.0 * fixture.Bar.Positions, fixture.Bar.Faces }));
  enlarging->SetParameter(-1.0);
  enlarging->Update();
  vtktest::ExpectMessage(log->Errors, { "negative length", "parameter" });
}

TEST(VtkSurfaceMorph, RefusesCompositeKeyFrames)
{
  Fixture fixture;
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, fixture.Keys[0]);
  vtkNew<vtkSurfaceMorph> filter;
  const auto log = vtktest::Observe(filter);
  filter->SetInputDataObject(0, blocks);
  filter->Update();
  vtktest::ExpectMessage(log->Errors, { "composite", "Extract Block", "Merge Blocks" });
}

TEST(VtkSurfaceMorph, ReportsProgressAndStops)
{
  Fixture fixture;
  vtkNew<vtktest::ProgressLog> progress;
  fixture.Filter->AddObserver(vtkCommand::ProgressEvent, progress);
  fixture.At(0.5);
  EXPECT_GT(progress->Fractions.size(), 3u);
  EXPECT_TRUE(std::is_sorted(progress->Fractions.begin(), progress->Fractions.end()));
  progress->AbortAt = static_cast<int>(progress->Fractions.size()) + 2;
  fixture.Filter->SetMethodToDeformationGradient();
  fixture.Filter->Update();
  EXPECT_EQ(fixture.Filter->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_TRUE(fixture.Log->Errors.empty());
  progress->AbortAt = 0;
  fixture.Filter->SetAbortExecute(0);
  fixture.Filter->Modified();
  EXPECT_TRUE(fixture.At(0.5).allFinite());
}

TEST(VtkSurfaceMorph, PrintsItself)
{
  Fixture fixture;
  std::ostringstream text;
  fixture.Filter->Print(text);
  for (const char* name : { "Method: 0", "Parameter: 0", "FollowTime: 1",
         "StepsBetweenKeyFrames: 10", "Placement: 0", "HandleArrayName: Handle", "CloseVolume: 0",
         "TransitionInterpolation: 0", "FrameSolver: 0", "Stitching: 0", "LengthPolish: 0" })
  {
    EXPECT_NE(text.str().find(name), std::string::npos) << name;
  }
}
