// SPDX-License-Identifier: BSD-3-Clause
#include "vtkVolumeChange.h"

#include "TestSurfaces.h"
#include "VtkTestHelpers.h"

#include <gtest/gtest.h>

#include "vtkPrepareSurface.h"

#include "vtkCellData.h"
#include "vtkCubeSource.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <string>

namespace
{
struct Row
{
  double Reference;
  double Current;
  double RelativeChange;
  std::string Note;
};

class VolumeChange : public ::testing::Test
{
protected:
  VolumeChange() { surfaces::Observe(this->Filter, this->Messages); }

  void Compare(vtkPolyData* current, vtkPolyData* reference)
  {
    this->Filter->SetInputData(current);
    this->Filter->SetReferenceData(reference);
    this->Filter->Update();
    ASSERT_FALSE(this->Messages->GetError()) << this->Messages->GetErrorMessage();
  }

  vtkDoubleArray* PointArray(const char* name)
  {
    return vtkDoubleArray::SafeDownCast(this->Filter->GetOutput()->GetPointData()->GetArray(name));
  }

  std::map<std::string, Row> Rows()
  {
    std::map<std::string, Row> rows;
    vtkTable* table = this->Filter->GetChangeTable();
    auto* quantity = vtkStringArray::SafeDownCast(table->GetColumnByName("Quantity"));
    auto* reference = vtkDoubleArray::SafeDownCast(table->GetColumnByName("Reference"));
    auto* current = vtkDoubleArray::SafeDownCast(table->GetColumnByName("Current"));
    auto* change = vtkDoubleArray::SafeDownCast(table->GetColumnByName("RelativeChange"));
    auto* note = vtkStringArray::SafeDownCast(table->GetColumnByName("Note"));
    for (vtkIdType i = 0; i < table->GetNumberOfRows(); ++i)
    {
      rows[quantity->GetValue(i)] = { reference->GetValue(i), current->GetValue(i),
        change->GetValue(i), note->GetValue(i) };
    }
    return rows;
  }

  /// Updates, expects one error that contains `text`, and empty outputs.
  void ExpectError(const std::string& text)
  {
    this->Messages->Clear();
    this->Filter->Update();
    EXPECT_EQ(this->Messages->GetNumberOfErrors(), 1);
    EXPECT_NE(this->Messages->GetErrorMessage().find(text), std::string::npos)
      << this->Messages->GetErrorMessage();
    EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_EQ(this->Filter->GetChangeTable()->GetNumberOfRows(), 0);
    EXPECT_TRUE(std::isnan(this->Filter->GetRelativeVolumeChange()));
    EXPECT_TRUE(std::isnan(this->Filter->GetShapeDistance()));
  }

  vtkNew<surfaces::Observer> Messages;
  vtkNew<vtkVolumeChange> Filter;
};

surfaces::Surface Scaled(vtkPolyData* surface, double factor)
{
  return surfaces::Scaled(surface, factor, factor, factor);
}
}

TEST_F(VolumeChange, ScalingHasKnownEffects)
{
  const surfaces::Surface bar = surfaces::Box(1.0, 1.0, 2.0);
  this->Compare(Scaled(bar, 1.1), bar);
  EXPECT_NEAR(this->Filter->GetRelativeVolumeChange(), 0.331, 1e-12);
  EXPECT_NEAR(this->Filter->GetRelativeAreaChange(), 0.21, 1e-12);
  EXPECT_NEAR(this->Filter->GetEdgeLengthRMS(), 0.1, 1e-12);
  EXPECT_NEAR(this->Filter->GetEdgeLengthMax(), 0.1, 1e-12);
  EXPECT_NEAR(this->Filter->GetShapeDistance(), 0.0, 1e-12);

  std::map<std::string, Row> rows = this->Rows();
  EXPECT_EQ(rows.size(), 5u);
  EXPECT_NEAR(rows["Volume"].Reference, 2.0, 1e-12);
  EXPECT_NEAR(rows["Volume"].Current, 2.662, 1e-12);
  EXPECT_NEAR(rows["Volume"].RelativeChange, 0.331, 1e-12);
  EXPECT_EQ(rows["Volume"].Note, "");
  EXPECT_NEAR(rows["Area"].Reference, 10.0, 1e-12);
  EXPECT_NEAR(rows["Area"].RelativeChange, 0.21, 1e-12);
  EXPECT_NEAR(rows["EdgeLengthRMS"].RelativeChange, 0.1, 1e-12);
  EXPECT_NEAR(rows["EdgeLengthMax"].Current, 0.1, 1e-12);
  EXPECT_NEAR(rows["ShapeDistance"].Current, 0.0, 1e-12);
  EXPECT_TRUE(std::isnan(rows["ShapeDistance"].RelativeChange));
  EXPECT_NE(rows["ShapeDistance"].Note, "");

  const std::map<std::string, double> expected = { { "AreaRatio", 1.21 },
    { "EdgeLengthRatio", 1.1 }, { "LocalVolumeRatio", 1.331 }, { "ShapeDistanceDensity", 0.0 } };
  for (const auto& [name, value] : expected)
  {
    ASSERT_NE(this->PointArray(name.c_str()), nullptr) << name;
    double range[2];
    this->PointArray(name.c_str())->GetRange(range);
    EXPECT_NEAR(range[0], value, 1e-10) << name;
    EXPECT_NEAR(range[1], value, 1e-10) << name;
  }
  double sum = 0.0;
  for (vtkIdType i = 0; i < this->PointArray("LocalVolume")->GetNumberOfValues(); ++i)
  {
    sum += this->PointArray("LocalVolume")->GetValue(i);
  }
  EXPECT_NEAR(sum, 2.662, 1e-12);

  auto* cells =
    vtkDoubleArray::SafeDownCast(this->Filter->GetOutput()->GetCellData()->GetArray("AreaRatio"));
  ASSERT_NE(cells, nullptr);
  ASSERT_EQ(cells->GetNumberOfValues(), 6);
  EXPECT_NEAR(cells->GetValue(0), 1.21, 1e-12);

  auto* field = this->Filter->GetOutput()->GetFieldData();
  const auto value = [&](const char* name) { return field->GetArray(name)->GetComponent(0, 0); };
  EXPECT_EQ(field->GetNumberOfArrays(), 5);
  EXPECT_EQ(value("RelativeVolumeChange"), this->Filter->GetRelativeVolumeChange());
  EXPECT_EQ(value("RelativeAreaChange"), this->Filter->GetRelativeAreaChange());
  EXPECT_EQ(value("EdgeLengthRMS"), this->Filter->GetEdgeLengthRMS());
  EXPECT_EQ(value("EdgeLengthMax"), this->Filter->GetEdgeLengthMax());
  EXPECT_EQ(value("ShapeDistance"), this->Filter->GetShapeDistance());
}

TEST_F(VolumeChange, RigidMotionChangesNothing)
{
  const surfaces::Surface torus = surfaces::Torus(24, 12);
  this->Compare(surfaces::RigidlyMoved(torus), torus);
  EXPECT_NEAR(this->Filter->GetRelativeVolumeChange(), 0.0, 1e-12);
  EXPECT_NEAR(this->Filter->GetEdgeLengthMax(), 0.0, 1e-12);
  EXPECT_NEAR(this->Filter->GetShapeDistance(), 0.0, 1e-12);
  double range[2];
  this->PointArray("LocalVolumeRatio")->GetRange(range);
  EXPECT_NEAR(range[0], 1.0, 1e-9);
  EXPECT_NEAR(range[1], 1.0, 1e-9);
}

TEST_F(VolumeChange, OpenSurfacesHaveNoVolumeAndSayWhy)
{
  const surfaces::Surface cylinder = surfaces::OpenCylinder(16, 4);
  this->Compare(Scaled(cylinder, 2.0), cylinder);
  EXPECT_TRUE(std::isnan(this->Filter->GetRelativeVolumeChange()));
  Row volume = this->Rows()["Volume"];
  EXPECT_TRUE(std::isnan(volume.Reference));
  EXPECT_TRUE(std::isnan(volume.Current));
  EXPECT_TRUE(std::isnan(volume.RelativeChange));
  EXPECT_EQ(volume.Note, "the surface is open and encloses no volume");
  EXPECT_TRUE(std::isnan(this->PointArray("LocalVolume")->GetValue(0)));
  EXPECT_NEAR(this->Filter->GetRelativeAreaChange(), 3.0, 1e-12);
}

TEST_F(VolumeChange, ComponentsAreReportedOneByOne)
{
  const surfaces::Surface unit = surfaces::Moved(surfaces::Box(1.0, 1.0, 1.0),
    [](const surfaces::Point& p) {
      return surfaces::Point{ p[0] + 10.0, p[1], p[2] };
    });
  const surfaces::Surface large = surfaces::Box(2.0, 2.0, 2.0);
  this->Compare(surfaces::Union(Scaled(large, 2.0), unit), surfaces::Union(large, unit));
  std::map<std::string, Row> rows = this->Rows();
  EXPECT_NEAR(rows["Volume"].Reference, 9.0, 1e-12);
  EXPECT_NEAR(rows["Volume"].Current, 65.0, 1e-12);
  EXPECT_NEAR(rows["Volume of component 0"].RelativeChange, 7.0, 1e-12);
  EXPECT_NEAR(rows["Volume of component 1"].RelativeChange, 0.0, 1e-12);
  auto* field = this->Filter->GetOutput()->GetFieldData();
  const char* name = "RelativeVolumeChange of component 0";
  EXPECT_NEAR(field->GetArray(name)->GetComponent(0, 0), 7.0, 1e-12);
  EXPECT_EQ(field->GetNumberOfArrays(), 7);

  // With one of them open there is no total, but the other keeps its volume.
  const surfaces::Surface half = surfaces::Union(surfaces::OpenCylinder(8, 2), unit);
  this->Compare(half, half);
  rows = this->Rows();
  EXPECT_TRUE(std::isnan(rows["Volume"].Current));
  EXPECT_EQ(rows["Volume"].Note, "1 of 2 components are open and enclose no volume");
  EXPECT_TRUE(std::isnan(rows["Volume of component 0"].Current));
  EXPECT_EQ(rows["Volume of component 0"].Note, "open: it encloses no volume");
  EXPECT_NEAR(rows["Volume of component 1"].Current, 1.0, 1e-12);
}

TEST_F(VolumeChange, OrientationIsTold)
{
  const surfaces::Surface inverted = surfaces::Inverted(surfaces::Box(1.0, 1.0, 1.0));
  this->Compare(Scaled(inverted, 2.0), inverted);
  EXPECT_NEAR(this->Rows()["Volume"].Reference, -1.0, 1e-12);
  EXPECT_NEAR(this->Filter->GetRelativeVolumeChange(), 7.0, 1e-12);
  EXPECT_EQ(this->Rows()["Volume"].Note, "negative: the surface is oriented inward");

  const surfaces::Surface bar = surfaces::Box(1.0, 1.0, 1.0);
  this->Compare(surfaces::Scaled(bar, -1.0, 1.0, 1.0), bar);
  EXPECT_EQ(this->Rows()["Volume"].Note, "the deformation turned it inside out");
}

TEST_F(VolumeChange, FlatReferencesHaveNoRelativeChange)
{
  const surfaces::Surface bar = surfaces::Box(1.0, 1.0, 1.0);
  this->Filter->SetInputData(bar);
  this->Filter->SetReferenceData(surfaces::Scaled(bar, 1.0, 1.0, 0.0));
  this->Filter->Update();
  EXPECT_FALSE(this->Messages->GetError());
  EXPECT_TRUE(std::isnan(this->Filter->GetRelativeVolumeChange()));
  EXPECT_EQ(this->Rows()["Volume"].Note, "the reference is zero");
  EXPECT_NE(this->Rows()["EdgeLengthRMS"].Note, "");
  EXPECT_TRUE(std::isfinite(this->Filter->GetShapeDistance()));
}

TEST_F(VolumeChange, VolumesThatCancelAreZeroWhereverTheSurfaceIs)
{
  // Both sides of a shell: what is left of the sum is rounding.
  const shapes::Shape ball = shapes::Icosphere(2);
  const shapes::Shape shell = shapes::Union(ball, shapes::Inverted(ball));
  for (unsigned int seed = 1; seed < 10; ++seed)
  {
    shapes::Shape moved = shapes::RandomRigidMotion(seed, 3.0)(shell);
    const auto reference = vtktest::MakePolyData(moved);
    moved.Positions.col(0) *= 1.3;
    this->Compare(vtktest::MakePolyData(moved), reference);
    EXPECT_EQ(this->Rows()["Volume"].Reference, 0.0) << seed;
    EXPECT_EQ(this->Rows()["Volume"].Current, 0.0) << seed;
    EXPECT_TRUE(std::isnan(this->Filter->GetRelativeVolumeChange())) << seed;
    EXPECT_NEAR(this->Rows()["Volume of component 1"].RelativeChange, 0.3, 1e-12) << seed;
  }
}

TEST_F(VolumeChange, TrianglesWithoutAreaAreWarnedOf)
{
  const surfaces::Surface torus = surfaces::Torus(12, 8);
  this->Filter->SetInputData(torus);
  this->Filter->SetReferenceData(surfaces::Moved(torus,
    [](const surfaces::Point& p) {
      return surfaces::Point{ p[0], p[1], p[2] < 0.0 ? 0.0 : p[2] };
    }));
  this->Filter->Update();
  EXPECT_FALSE(this->Messages->GetError());
  this->Filter->SetReferenceData(surfaces::Moved(torus,
    [](const surfaces::Point&) {
      return surfaces::Point{ 0, 0, 0 };
    }));
  this->Filter->Update();
  EXPECT_FALSE(this->Messages->GetError());
  EXPECT_NE(
    this->Messages->GetWarningMessage().find("The reference has 192 cells"), std::string::npos);
  EXPECT_TRUE(std::isnan(this->Filter->GetRelativeAreaChange()));
  EXPECT_TRUE(std::isfinite(this->Filter->GetShapeDistance()));
}

TEST_F(VolumeChange, LocalVolumeIsOptional)
{
  const surfaces::Surface bar = surfaces::Box(1.0, 1.0, 1.0);
  this->Filter->ComputeLocalVolumeOff();
  this->Compare(bar, bar);
  EXPECT_EQ(this->PointArray("LocalVolume"), nullptr);
  EXPECT_EQ(this->PointArray("LocalVolumeRatio"), nullptr);
  EXPECT_NE(this->PointArray("AreaRatio"), nullptr);
}

TEST_F(VolumeChange, ANewReferenceOfEqualTrianglesIsNoticed)
{
  const surfaces::Surface bar = surfaces::Box(1.0, 1.0, 1.0);
  this->Compare(bar, bar);
  EXPECT_NEAR(this->PointArray("LocalVolumeRatio")->GetValue(0), 1.0, 1e-10);
  this->Compare(bar, Scaled(bar, 2.0));
  EXPECT_NEAR(this->PointArray("LocalVolumeRatio")->GetValue(0), 0.125, 1e-10);
}

TEST_F(VolumeChange, QuadsAndLinesKeepTheirCells)
{
  surfaces::Surface quads = surfaces::QuadGrid(3, 0.2);
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell({ 0, 5 });
  quads->SetLines(lines);
  this->Filter->SetInputData(quads);
  this->Filter->SetReferenceData(surfaces::QuadGrid(3, -0.2));
  this->Filter->Update();
  ASSERT_FALSE(this->Messages->GetError()) << this->Messages->GetErrorMessage();
  auto* ratios =
    vtkDoubleArray::SafeDownCast(this->Filter->GetOutput()->GetCellData()->GetArray("AreaRatio"));
  ASSERT_EQ(ratios->GetNumberOfValues(), 10);
  for (vtkIdType i = 0; i < 10; ++i)
  {
    EXPECT_NEAR(ratios->GetValue(i), 1.0, 1e-12);
  }
}

TEST_F(VolumeChange, UnusedPointsHaveNotChanged)
{
  surfaces::Surface triangle = surfaces::SingleTriangleWithUnusedPoint();
  this->Filter->SetInputData(triangle);
  this->Filter->SetReferenceData(triangle);
  this->Filter->Update();
  ASSERT_FALSE(this->Messages->GetError());
  EXPECT_EQ(this->PointArray("AreaRatio")->GetValue(3), 1.0);
  EXPECT_EQ(this->PointArray("EdgeLengthRatio")->GetValue(3), 1.0);
  EXPECT_EQ(this->PointArray("ShapeDistanceDensity")->GetValue(3), 0.0);
}

TEST_F(VolumeChange, InputIsUntouchedAndUpdatesOnlyWhenNeeded)
{
  surfaces::Surface input = surfaces::Torus(16, 12);
  surfaces::AddPointIds(input);
  const vtkMTimeType before = input->GetMTime();
  this->Filter->SetInputData(input);
  this->Filter->SetReferenceData(input);
  this->Filter->Update();
  EXPECT_EQ(input->GetMTime(), before);
  EXPECT_EQ(input->GetPointData()->GetNumberOfArrays(), 1);
  EXPECT_EQ(input->GetFieldData()->GetNumberOfArrays(), 0);
  EXPECT_NE(this->PointArray("AreaRatio"), nullptr);
  EXPECT_NE(this->Filter->GetOutput()->GetPointData()->GetArray("Ids"), nullptr);

  const vtkMTimeType first = this->Filter->GetOutput()->GetMTime();
  this->Filter->Update();
  EXPECT_EQ(this->Filter->GetOutput()->GetMTime(), first);
  this->Filter->ComputeLocalVolumeOff();
  this->Filter->Update();
  EXPECT_GT(this->Filter->GetOutput()->GetMTime(), first);
}

TEST_F(VolumeChange, EmptyInputGivesEmptyOutputs)
{
  vtkNew<vtkPolyData> empty;
  this->Filter->SetInputData(empty);
  this->Filter->SetReferenceData(empty);
  this->Filter->Update();
  EXPECT_FALSE(this->Messages->GetError());
  EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_EQ(this->Filter->GetChangeTable()->GetNumberOfRows(), 0);
}

TEST_F(VolumeChange, BadInputIsExplained)
{
  surfaces::Surface good = surfaces::Sphere(8);
  this->Filter->SetReferenceData(good);

  this->Filter->SetInputData(surfaces::WithPoint(good, 7, std::nan("")));
  this->ExpectError("The input has 1 point (id 7) with a NaN or infinite coordinate");

  this->Filter->SetInputData(surfaces::ThreeTrianglesAtAnEdge());
  this->ExpectError("with more than two triangles");

  this->Filter->SetInputData(surfaces::WithCellsRotated(good, { 4 }));
  this->ExpectError("The input has 1 cell (id 4) with other points than in the reference.");

  this->Filter->SetInputData(good);
  this->Filter->SetReferenceData(surfaces::Sphere(12));
  this->ExpectError("The input has 50 points, the reference 122.");

  this->Filter->SetReferenceData(surfaces::WithPoint(good, 3, HUGE_VAL));
  this->ExpectError("The reference has 1 point (id 3) with a NaN or infinite coordinate");

  vtkNew<vtkPolyData> empty;
  this->Filter->SetReferenceData(empty);
  this->ExpectError("The reference has no triangles");

  // And it recovers.
  this->Messages->Clear();
  this->Filter->SetReferenceData(good);
  this->Filter->Update();
  EXPECT_FALSE(this->Messages->GetError());
  EXPECT_NEAR(this->Filter->GetRelativeVolumeChange(), 0.0, 1e-12);
}

TEST_F(VolumeChange, AbortLeavesEmptyOutputsAndNoMessage)
{
  surfaces::Surface torus = surfaces::Torus(24, 16);
  this->Filter->SetInputData(torus);
  this->Filter->SetReferenceData(torus);
  surfaces::AbortAtFirstProgress(this->Filter);
  this->Filter->Update();
  EXPECT_FALSE(this->Messages->GetError());
  EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_EQ(this->Filter->GetChangeTable()->GetNumberOfRows(), 0);
}

TEST_F(VolumeChange, PrintsItsState)
{
  std::ostringstream text;
  this->Filter->Print(text);
  EXPECT_NE(text.str().find("ComputeLocalVolume: 1"), std::string::npos);
}

TEST_F(VolumeChange, SaysWhatLiesInside)
{
  // A box of 4 with one of 2 inside, its wall turned either way.
  const auto box = [](double size)
  {
    shapes::Shape shape = shapes::Bar(2, 2, 2, { size, size, size });
    shape.Positions.col(2).array() -= 0.5 * size;
    return shape;
  };
  const auto measure = [this](const shapes::Shape& shape)
  {
    const auto surface = vtktest::MakePolyData(shape);
    this->Filter->SetInputData(surface);
    this->Filter->SetReferenceData(surface);
    this->Filter->Update();
  };
  measure(shapes::Union(box(4.0), shapes::Inverted(box(2.0))));
  EXPECT_NEAR(this->Rows()["Volume"].Reference, 56.0, 1e-12);
  EXPECT_EQ(this->Rows()["Volume of component 1"].Note,
    "negative: the wall of a cavity inside component 0");
  measure(shapes::Union(box(4.0), box(2.0)));
  EXPECT_NEAR(this->Rows()["Volume"].Reference, 72.0, 1e-12);
  EXPECT_NE(this->Rows()["Volume of component 1"].Note.find("inside component 0 and oriented like"),
    std::string::npos);
  EXPECT_EQ(this->Rows()["Volume of component 0"].Note, "");
}

TEST_F(VolumeChange, SaysHowToCloseWhatLooksClosed)
{
  vtkNew<vtkCubeSource> cube; // each face has points of its own
  cube->Update();
  this->Filter->SetInputData(cube->GetOutput());
  this->Filter->SetReferenceData(cube->GetOutput());
  this->Filter->Update();
  EXPECT_TRUE(std::isnan(this->Rows()["Volume"].Reference));
  EXPECT_NE(this->Rows()["Volume"].Note.find("24 border edges coincide"), std::string::npos);

  // The advice works.
  vtkNew<vtkPrepareSurface> prepare;
  prepare->SetInputConnection(cube->GetOutputPort());
  prepare->Update();
  this->Filter->SetInputData(prepare->GetOutput());
  this->Filter->SetReferenceData(prepare->GetOutput());
  this->Filter->Update();
  EXPECT_NEAR(this->Rows()["Volume"].Reference, 1.0, 1e-12);
}
