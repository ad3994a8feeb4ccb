// SPDX-License-Identifier: BSD-3-Clause
#include "PrepareShapes.h"
#include "TestSurfaces.h"
#include "VtkTestHelpers.h"

#include "vtkConeSource.h"
#include "vtkCylinderSource.h"
#include "vtkIdTypeArray.h"
#include "vtkPlatonicSolidSource.h"
#include "vtkPrepareSurface.h"
#include "vtkStringArray.h"
#include "vtkStripper.h"
#include "vtkTable.h"
#include "vtkTexturedSphereSource.h"
#include "vtkVariant.h"
#include "vtkVolumeChange.h"

namespace
{
vtkIdType Count(vtkPolyData* output, const char* name)
{
  vtkDataArray* array = output->GetFieldData()->GetArray(name);
  EXPECT_NE(array, nullptr) << name;
  return array ? static_cast<vtkIdType>(array->GetTuple1(0)) : -1;
}

std::vector<vtkIdType> Ids(vtkFieldData* data, const char* name)
{
  auto* array = vtkIdTypeArray::SafeDownCast(data->GetArray(name));
  EXPECT_NE(array, nullptr) << name;
  return array ? std::vector<vtkIdType>(
                   array->GetPointer(0), array->GetPointer(0) + array->GetNumberOfValues())
               : std::vector<vtkIdType>();
}

/// What a source makes, with names for arrays that have none.
vtkSmartPointer<vtkPolyData> OutputOf(vtkPolyDataAlgorithm* source)
{
  source->Update();
  auto output = vtktest::CopyOf(source->GetOutput());
  for (int i = 0; i < output->GetPointData()->GetNumberOfArrays(); ++i)
  {
    output->GetPointData()->GetAbstractArray(i)->SetName(("Array" + std::to_string(i)).c_str());
  }
  for (int i = 0; i < output->GetCellData()->GetNumberOfArrays(); ++i)
  {
    output->GetCellData()->GetAbstractArray(i)->SetName(("Array" + std::to_string(i)).c_str());
  }
  return output;
}

/// The volume by Volume Change, which is NaN for an open surface.
double VolumeOf(vtkPolyData* surface)
{
  vtkNew<vtkVolumeChange> filter;
  filter->SetInputData(surface);
  filter->SetReferenceData(surface);
  filter->Update();
  vtkTable* table = filter->GetChangeTable();
  for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
  {
    if (table->GetValueByName(row, "Quantity").ToString() == "Volume")
    {
      return table->GetValueByName(row, "Current").ToDouble();
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// A filter that fails the test when it says anything.
class PrepareSurface : public ::testing::Test
{
protected:
  PrepareSurface()
    : Log(vtktest::Observe(this->Filter))
  {
  }

  vtkPolyData* Run(vtkPolyData* input)
  {
    const auto copy = vtktest::CopyOf(input);
    this->Filter->SetInputData(input);
    this->Filter->Update();
    vtktest::ExpectQuiet(*this->Log);
    vtktest::ExpectSameSurface(input, copy);
    return this->Filter->GetOutput();
  }

  vtkNew<vtkPrepareSurface> Filter;
  vtkSmartPointer<vtktest::Log> Log;
};
}

TEST_F(PrepareSurface, SoundSurfacesPassUnchanged)
{
  surfaces::Surface grid = surfaces::QuadGrid(4, 0.3);
  grid->GetPoints()->InsertNextPoint(9.0, 9.0, 9.0);
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell({ 3, 7, 25 });
  grid->SetLines(lines);
  vtkNew<vtkCellArray> verts;
  verts->InsertNextCell({ 25 });
  grid->SetVerts(verts);
  surfaces::AddPointIds(grid);
  vtkNew<vtkIntArray> cellArray;
  cellArray->SetName("Cells");
  for (int cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    cellArray->InsertNextValue(100 + cell);
  }
  grid->GetCellData()->AddArray(cellArray);

  vtkPolyData* output = this->Run(grid);
  EXPECT_TRUE(vtktest::SameArray(output->GetPoints()->GetData(), grid->GetPoints()->GetData()));
  vtktest::ExpectSameCells(output, grid);
  vtktest::ExpectArrays(output->GetPointData(), grid->GetPointData(), false);
  vtktest::ExpectArrays(output->GetCellData(), grid->GetCellData(), false);
  EXPECT_STREQ(this->Filter->GetReport(), "Nothing was to repair.");
  for (vtkIdType v = 0; v < 26; ++v)
  {
    EXPECT_EQ(Ids(output->GetPointData(), "OriginalPointIds")[v], v);
    EXPECT_EQ(Ids(output->GetPointData(), "CopyOf")[v], v);
    EXPECT_EQ(Ids(output->GetFieldData(), "PreparedPointIds")[v], v);
  }
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    EXPECT_EQ(Ids(output->GetCellData(), "OriginalCellIds")[cell], cell);
  }
}

TEST_F(PrepareSurface, VtkSourcesBecomeClosed)
{
  vtkNew<vtkCubeSource> cube;
  cube->SetXLength(3.0);
  vtkPolyData* box = this->Run(OutputOf(cube));
  EXPECT_EQ(box->GetNumberOfPoints(), 8);
  EXPECT_EQ(box->GetNumberOfPolys(), 6); // its quads
  EXPECT_EQ(Count(box, "MergedPoints"), 16);
  EXPECT_STREQ(this->Filter->GetReport(), "16 points merged with others in the same place.");
  EXPECT_NEAR(VolumeOf(box), 3.0, 1e-12);

  vtkNew<vtkCylinderSource> cylinder;
  cylinder->SetResolution(24);
  const double polygon = 0.5 * 24 * std::sin(2 * shapes::Pi / 24); // of radius 1
  EXPECT_NEAR(VolumeOf(this->Run(OutputOf(cylinder))), 0.25 * polygon, 1e-6);

  vtkNew<vtkConeSource> cone;
  cone->SetResolution(24);
  EXPECT_NEAR(VolumeOf(this->Run(OutputOf(cone))), 0.25 * polygon / 3.0, 1e-6);

  vtkNew<vtkPlatonicSolidSource> solid;
  solid->SetSolidTypeToDodecahedron();
  EXPECT_GT(VolumeOf(this->Run(OutputOf(solid))), 0.0);
}

TEST_F(PrepareSurface, ToleranceClosesSeamsOfRounding)
{
  vtkNew<vtkTexturedSphereSource> sphere;
  sphere->SetThetaResolution(40);
  sphere->SetPhiResolution(20);
  this->Filter->SetTolerance(1e-6);
  const double volume = VolumeOf(this->Run(OutputOf(sphere)));
  EXPECT_NEAR(volume, shapes::Pi / 6.0, 0.02);
  this->Filter->ToleranceIsAbsoluteOn();
  this->Filter->SetTolerance(1e-6 * std::sqrt(3.0));
  EXPECT_EQ(VolumeOf(this->Run(OutputOf(sphere))), volume);
}

TEST_F(PrepareSurface, CoordinatesAndPrecisionStay)
{
  for (const int precision : { VTK_FLOAT, VTK_DOUBLE })
  {
    const shapes::Shape sphere = shapes::Noisy(shapes::Icosphere(2), 0.05, 3);
    const auto input = vtktest::MakePolyData(shapes::Soup(sphere), precision);
    vtkPolyData* output = this->Run(input);
    ASSERT_EQ(output->GetPoints()->GetDataType(), precision);
    ASSERT_EQ(output->GetNumberOfPoints(), sphere.NumberOfVertices());
    const std::vector<vtkIdType> original = Ids(output->GetPointData(), "OriginalPointIds");
    for (vtkIdType v = 0; v < output->GetNumberOfPoints(); ++v)
    {
      double a[3];
      double b[3];
      output->GetPoint(v, a);
      input->GetPoint(original[v], b);
      EXPECT_EQ(std::memcmp(a, b, sizeof a), 0);
    }
    EXPECT_GT(VolumeOf(output), 0.0);
  }
}

TEST_F(PrepareSurface, MergedArraysAreTheFirstsOrTheirMean)
{
  vtkNew<vtkCubeSource> cube;
  cube->Update();
  const auto input = vtktest::CopyOf(cube->GetOutput());
  vtktest::AddArray(input, "Number", 1, [](vtkIdType v, double* x) { *x = std::pow(2.0, v); });
  surfaces::AddPointIds(input);
  const auto first = vtktest::CopyOf(this->Run(input));
  const std::vector<vtkIdType> original = Ids(first->GetPointData(), "OriginalPointIds");
  const std::vector<vtkIdType> prepared = Ids(first->GetFieldData(), "PreparedPointIds");
  this->Filter->AverageMergedArraysOn();
  vtkPolyData* mean = this->Run(input);
  for (vtkIdType v = 0; v < 8; ++v)
  {
    double sum = 0.0;
    for (vtkIdType from = 0; from < 24; ++from)
    {
      sum += prepared[from] == v ? std::pow(2.0, from) / 3.0 : 0.0;
    }
    EXPECT_EQ(first->GetPointData()->GetArray("Number")->GetTuple1(v), std::pow(2.0, original[v]));
    EXPECT_NEAR(mean->GetPointData()->GetArray("Number")->GetTuple1(v), sum, 1e-9 * sum);
    EXPECT_EQ(mean->GetPointData()->GetArray("Ids")->GetTuple1(v), original[v]);
    // The mean normal at a corner points along the diagonal.
    const Eigen::Vector3d normal(mean->GetPointData()->GetNormals()->GetTuple3(v));
    const Eigen::Vector3d corner(mean->GetPoint(v));
    EXPECT_NEAR(normal.dot(corner.normalized()), 1.0, 1e-6);
  }
}

TEST_F(PrepareSurface, StripsBecomeTrianglesThatKnowTheirStrip)
{
  const surfaces::Surface sphere = surfaces::Sphere(12);
  vtkNew<vtkStripper> stripper;
  stripper->SetInputData(sphere);
  stripper->Update();
  ASSERT_GT(stripper->GetOutput()->GetNumberOfStrips(), 0);
  vtkPolyData* output = this->Run(stripper->GetOutput());
  EXPECT_EQ(output->GetNumberOfStrips(), 0);
  EXPECT_EQ(output->GetNumberOfPolys(), sphere->GetNumberOfPolys());
  for (const vtkIdType cell : Ids(output->GetCellData(), "OriginalCellIds"))
  {
    EXPECT_LT(cell, stripper->GetOutput()->GetNumberOfCells());
  }
}

TEST_F(PrepareSurface, PolygonsStayWhereOnlyIdsOrDirectionChange)
{
  // Two boxes of quads that share an edge, one of them inside out.
  const surfaces::Surface boxes = surfaces::Union(surfaces::Inverted(surfaces::Box(1, 1, 1)),
    surfaces::Moved(surfaces::Box(1, 1, 1),
      [](const surfaces::Point& p) {
        return surfaces::Point{ p[0] + 1, p[1] + 1, p[2] };
      }));
  vtkPolyData* output = this->Run(boxes);
  EXPECT_EQ(Count(output, "MergedPoints"), 0);
  this->Filter->MergeInnerPointsOn();
  output = this->Run(boxes);
  EXPECT_EQ(output->GetNumberOfPolys(), 12);
  EXPECT_EQ(output->GetNumberOfPoints(), 16);
  EXPECT_NEAR(VolumeOf(output), 2.0, 1e-12);
  EXPECT_EQ(Count(output, "NonManifoldEdges"), 1);
  EXPECT_EQ(Count(output, "CopiedPoints"), 2);
  EXPECT_EQ(Count(output, "ReversedComponents"), 1);
  const auto* report =
    vtkStringArray::SafeDownCast(output->GetFieldData()->GetAbstractArray("PreparationReport"));
  ASSERT_NE(report, nullptr);
  EXPECT_EQ(
    const_cast<vtkStringArray*>(report)->GetValue(0), std::string(this->Filter->GetReport()));
  // Every point is there once, so that each box gets its own back.
  std::vector<vtkIdType> original = Ids(output->GetPointData(), "OriginalPointIds");
  std::sort(original.begin(), original.end());
  for (vtkIdType v = 0; v < 16; ++v)
  {
    EXPECT_EQ(original[v], v);
  }
}

TEST_F(PrepareSurface, DoubledPolygonsGo)
{
  const surfaces::Surface grid = surfaces::QuadGrid(5, 0.0); // either diagonal is as good
  const surfaces::Surface back = surfaces::Inverted(grid);
  const auto doubled = vtktest::CopyOf(grid);
  for (vtkIdType cell = 0; cell < back->GetNumberOfCells(); ++cell)
  {
    vtkNew<vtkIdList> ids;
    back->GetCellPoints(cell, ids);
    doubled->GetPolys()->InsertNextCell(ids);
  }
  vtkPolyData* output = this->Run(doubled);
  vtktest::ExpectSameCells(output, grid);
  EXPECT_EQ(Count(output, "DoubledTriangles"), 50);
}

TEST_F(PrepareSurface, WhatIsRemovedTakesItsPointsAndLinesAlong)
{
  const surfaces::Surface both = surfaces::Union(surfaces::Sphere(16),
    surfaces::Moved(surfaces::Scaled(surfaces::Sphere(6), 0.01, 0.01, 0.01),
      [](const surfaces::Point& p) {
        return surfaces::Point{ p[0] + 3, p[1], p[2] };
      }));
  const vtkIdType big = surfaces::Sphere(16)->GetNumberOfPoints();
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell({ 0, 1, 2 });
  lines->InsertNextCell({ big, big + 1 });
  both->SetLines(lines);
  this->Filter->SetMinimumComponentArea(0.01);
  vtkPolyData* output = this->Run(both);
  EXPECT_EQ(output->GetNumberOfPoints(), big);
  EXPECT_EQ(output->GetNumberOfLines(), 1);
  EXPECT_EQ(Count(output, "RemovedComponents"), 1);
  EXPECT_EQ(Ids(output->GetFieldData(), "PreparedPointIds")[big], -1);
}

TEST_F(PrepareSurface, HolesFillOnRequest)
{
  vtkNew<vtkCylinderSource> tube;
  tube->CappingOff();
  tube->SetResolution(20);
  tube->Update();
  EXPECT_EQ(Count(this->Run(tube->GetOutput()), "FilledHoles"), 0);
  this->Filter->SetMaximumHoleEdges(20);
  vtkPolyData* output = this->Run(tube->GetOutput());
  EXPECT_EQ(Count(output, "FilledHoles"), 2);
  EXPECT_EQ(Count(output, "FillTriangles"), 36);
  EXPECT_NEAR(VolumeOf(output), 0.25 * 10 * std::sin(2 * shapes::Pi / 20), 1e-6);
  EXPECT_EQ(output->GetNumberOfPolys(), 20 + 36); // the quads stay
  EXPECT_EQ(Ids(output->GetCellData(), "OriginalCellIds").back(), -1);
  this->Filter->SetMaximumHoleLength(1.0);
  EXPECT_EQ(Count(this->Run(tube->GetOutput()), "OpenHoles"), 2);
}

TEST_F(PrepareSurface, MakesWhatOtherFiltersRefuseFitForThem)
{
  int cured = 0;
  for (const vtktest::BadSurface& bad : vtktest::BadSurfaces())
  {
    vtkNew<vtkVolumeChange> measure;
    const auto log = vtktest::Observe(measure);
    if (bad.Name == "non-manifold edge" || bad.Name == "bow tie" || bad.Name == "orientation")
    {
      measure->SetInputData(this->Run(bad.Surface));
      measure->SetReferenceData(this->Filter->GetOutput());
      measure->Update();
      vtktest::ExpectQuiet(*log);
      ++cured;
    }
  }
  EXPECT_EQ(cured, 3);
}

TEST_F(PrepareSurface, RefusesWhatItCannotRepair)
{
  const auto good = vtktest::MakePolyData(shapes::Icosphere(1));
  for (const vtktest::BadSurface& bad : vtktest::BadSurfaces())
  {
    if (bad.Name != "non-manifold edge" && bad.Name != "bow tie" && bad.Name != "orientation")
    {
      SCOPED_TRACE(bad.Name);
      vtktest::ExpectRefused(this->Filter, this->Log, bad.Surface, bad.Parts, good);
    }
  }
  this->Log->Clear();
  this->Filter->SetTolerance(10.0);
  this->Filter->SetInputData(good);
  this->Filter->Update();
  vtktest::ExpectMessage(this->Log->Errors, { "No triangle is left", "smaller tolerance" });
  EXPECT_TRUE(std::string(this->Filter->GetReport()).empty());
}

TEST_F(PrepareSurface, StopsOnRequestAndReportsProgressThatRises)
{
  const auto input = vtktest::MakePolyData(shapes::Soup(shapes::Icosphere(4)));
  vtkNew<vtktest::ProgressLog> progress;
  this->Filter->AddObserver(vtkCommand::ProgressEvent, progress);
  this->Run(input);
  EXPECT_TRUE(std::is_sorted(progress->Fractions.begin(), progress->Fractions.end()));
  EXPECT_GT(progress->Fractions.size(), 3u);
  progress->Fractions.clear();
  progress->AbortAt = 2;
  this->Filter->Modified();
  this->Filter->Update();
  vtktest::ExpectQuiet(*this->Log);
  EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
}
