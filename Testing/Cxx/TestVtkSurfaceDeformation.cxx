// SPDX-License-Identifier: BSD-3-Clause

// What vtkSurfaceDeformation promises for every method, shown on one of them.
#include "vtkRotationInvariantDeformation.h"

#include "Kernel/Mesh/Geometry.h"
#include "VtkTestHelpers.h"
#include "vtkHandleMotion.h"

#include "vtkDataArray.h"
#include "vtkFloatArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>
#include <sstream>

using shapes::Shape;
using vtktest::MakePolyData;

namespace
{
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinity = std::numeric_limits<double>::infinity();

Shape BarShape()
{
  return shapes::Bar(3, 3, 15, { 1, 1, 5 });
}

int EndHandles(const Eigen::Vector3d& x)
{
  return x[2] < 0.4 ? 1 : x[2] > 4.6 ? 2 : 0;
}

/// A bar with its lower end in handle 1 and its upper end in handle 2.
vtkSmartPointer<vtkPolyData> MarkedBar(int precision = VTK_DOUBLE)
{
  auto bar = MakePolyData(BarShape(), precision);
  vtktest::AddHandles(bar, EndHandles);
  return bar;
}

/// A turn about an axis through the middle of the bar.
vtkSmartPointer<vtkHandleMotion> Turn(double degrees)
{
  auto motion = vtkSmartPointer<vtkHandleMotion>::New();
  motion->SetCenter(0, 0, 2.5);
  motion->SetAxis(1, 0, 0);
  motion->SetAngle(degrees);
  return motion;
}

struct Fixture
{
  vtkNew<vtkRotationInvariantDeformation> Filter;
  vtkSmartPointer<vtktest::Log> Log = vtktest::Observe(Filter);
  vtkSmartPointer<vtkHandleMotion> Motion = Turn(40);
  vtkSmartPointer<vtkPolyData> Good = MarkedBar();

  Fixture()
  {
    this->Filter->SetInputData(this->Good);
    this->Filter->SetHandleMotion(2, this->Motion);
  }
  void ExpectError(const std::vector<std::string>& parts)
  {
    this->Log->Clear();
    this->Filter->Modified();
    this->Filter->Update();
    vtktest::ExpectMessage(this->Log->Errors, parts);
    EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
    EXPECT_EQ(this->Filter->GetOutput()->GetNumberOfCells(), 0);
  }
  void ExpectSuccess()
  {
    this->Log->Clear();
    this->Filter->Update();
    vtktest::ExpectQuiet(*this->Log);
    EXPECT_GT(this->Filter->GetOutput()->GetNumberOfPoints(), 0);
  }
};

/// A quad, a strip, a line, a vertex, a polygon, and points in no triangle.
vtkSmartPointer<vtkPolyData> MixedSurface(int precision)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(precision);
  for (int j = 0; j < 5; ++j)
  {
    for (int i = 0; i < 4; ++i)
    {
      points->InsertNextPoint(i + 0.1, 0.3 * i * j - 0.7, j / 3.0);
    }
  }
  points->InsertNextPoint(0.3, 77.7, 1e9);
  points->InsertNextPoint(NaN, 0.0, Infinity);
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(points);
  vtkNew<vtkCellArray> verts;
  verts->InsertNextCell({ 20, 3 });
  surface->SetVerts(verts);
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell({ 0, 5, 20 });
  lines->InsertNextCell({ 1, 2 });
  surface->SetLines(lines);
  vtkNew<vtkCellArray> polygons;
  for (int j = 0; j < 3; ++j)
  {
    polygons->InsertNextCell({ 4 * j, 4 * j + 1, 4 * j + 5, 4 * j + 4 });
    polygons->InsertNextCell({ 4 * j + 1, 4 * j + 2, 4 * j + 3, 4 * j + 7, 4 * j + 6, 4 * j + 5 });
  }
  surface->SetPolys(polygons);
  vtkNew<vtkCellArray> strips;
  strips->InsertNextCell({ 16, 12, 17, 13, 18, 14, 19, 15 });
  surface->SetStrips(strips);
  vtktest::AddHandles(surface,
    [](const Eigen::Vector3d& x) { return x[2] < 0.1            ? 1
                                     : x[2] > 1.3 && x[2] < 2.0 ? 2
                                                                : 0; });
  return surface;
}

void AddAttributes(vtkPolyData* surface)
{
  vtktest::AddArray(surface, "Vectors", 3, [](vtkIdType v, double* x) { x[0] = x[1] = x[2] = v; });
  vtkNew<vtkStringArray> names;
  names->SetName("Names");
  names->SetNumberOfValues(surface->GetNumberOfPoints());
  surface->GetPointData()->AddArray(names);
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetName("Colors");
  colors->SetNumberOfComponents(3);
  colors->SetNumberOfTuples(surface->GetNumberOfPoints());
  colors->Fill(17);
  surface->GetPointData()->SetScalars(colors);
  vtkNew<vtkIntArray> cells;
  cells->SetName("CellNumbers");
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
  {
    cells->InsertNextValue(static_cast<int>(c));
  }
  surface->GetCellData()->SetScalars(cells);
  vtkNew<vtkDoubleArray> field;
  field->SetName("Field");
  field->InsertNextValue(3.0);
  surface->GetFieldData()->AddArray(field);
}
}

//------------------------------------------------------------------------------
TEST(SurfaceDeformation, FactorizesOnceForTenMotions)
{
  for (const bool constrain : { true, false })
  {
    Fixture fixture;
    fixture.Filter->SetConstrainHandlePositions(constrain);
    for (int step = 0; step < 10; ++step)
    {
      fixture.Motion->SetAngle(10.0 * step);
      fixture.ExpectSuccess();
    }
    // Positions that are free have a system of their own.
    EXPECT_EQ(fixture.Filter->GetNumberOfFactorizations(), constrain ? 1 : 2);
  }
}

TEST(SurfaceDeformation, FactorizesOnceForEachBlock)
{
  Fixture fixture;
  auto other = MakePolyData(shapes::OpenCylinder(8, 12, 0.5, 5.0));
  vtktest::AddHandles(other, EndHandles);
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, fixture.Good);
  blocks->SetBlock(2, other);
  fixture.Filter->SetInputDataObject(blocks);
  std::vector<cartan::Points> alone;
  for (vtkPolyData* block : { fixture.Good.Get(), other.Get() })
  {
    vtkNew<vtkRotationInvariantDeformation> filter;
    filter->SetInputData(block);
    filter->SetHandleMotion(2, Turn(50));
    filter->Update();
    alone.push_back(vtktest::PointsOf(filter->GetOutput()));
  }
  for (const double degrees : { 10.0, 30.0, 50.0 })
  {
    fixture.Motion->SetAngle(degrees);
    fixture.Log->Clear();
    fixture.Filter->Update();
    vtktest::ExpectQuiet(*fixture.Log);
    EXPECT_EQ(fixture.Filter->GetNumberOfFactorizations(), 2);
  }
  auto* output = vtkMultiBlockDataSet::SafeDownCast(fixture.Filter->GetOutputDataObject(0));
  ASSERT_NE(output, nullptr);
  EXPECT_EQ(vtktest::PointsOf(vtkPolyData::SafeDownCast(output->GetBlock(0))), alone[0]);
  EXPECT_EQ(vtktest::PointsOf(vtkPolyData::SafeDownCast(output->GetBlock(2))), alone[1]);
  EXPECT_EQ(output->GetBlock(1), nullptr);
}

TEST(SurfaceDeformation, ServesAHandleThatStopsMovingAndOneThatStartsAgain)
{
  Fixture fixture;
  auto second = Turn(15);
  fixture.Filter->SetHandleMotion(1, second);
  fixture.ExpectSuccess();
  fixture.Filter->RemoveHandleMotion(1);
  fixture.ExpectSuccess();
  const cartan::Points reused = vtktest::PointsOf(fixture.Filter->GetOutput());
  fixture.Filter->SetHandleMotion(1, second);
  fixture.ExpectSuccess();
  EXPECT_EQ(fixture.Filter->GetNumberOfFactorizations(), 2); // both are kept
  Fixture fresh;
  fresh.ExpectSuccess();
  EXPECT_EQ(vtktest::PointsOf(fresh.Filter->GetOutput()), reused);
}

TEST(SurfaceDeformation, FactorizesAgainOnlyForWhatTheMatrixDependsOn)
{
  Fixture fixture;
  vtkNew<vtktest::Producer> producer;
  producer->SetSurface(fixture.Good);
  fixture.Filter->SetInputConnection(producer->GetOutputPort());
  int expected = 1;
  const auto update = [&](const char* what)
  {
    SCOPED_TRACE(what);
    fixture.ExpectSuccess();
    EXPECT_EQ(fixture.Filter->GetNumberOfFactorizations(), expected);
  };
  update("first");

  producer->Modified(); // runs again and makes equal data in new arrays
  update("equal data");
  EXPECT_EQ(producer->Executions, 2);
  auto other = vtktest::CopyOf(fixture.Good);
  vtktest::AddArray(other, "Values", 1, [](vtkIdType, double* value) { *value = 0.0; });
  producer->SetSurface(other);
  update("another array");
  EXPECT_NE(fixture.Filter->GetOutput()->GetPointData()->GetArray("Values"), nullptr);
  fixture.Filter->GenerateFrameChangeOn();
  update("an array on request");
  fixture.Filter->SetFrameProjectionToNone();
  update("projection");

  fixture.Filter->SetLaplacianWeightsToUniform();
  ++expected;
  update("weights");
  fixture.Filter->SetSolverToEigen();
  ++expected;
  update("solver");
  other = vtktest::CopyOf(fixture.Good);
  other->GetPoints()->SetPoint(100, 0.5, 0.5, 2.6);
  producer->SetSurface(other);
  ++expected;
  update("a point");
  other = vtktest::CopyOf(other);
  other->GetPointData()->GetArray("Handle")->SetTuple1(100, 1);
  producer->SetSurface(other);
  ++expected;
  update("a handle");
}

TEST(SurfaceDeformation, SeesPointsAndCellsThatAreChangedInPlace)
{
  Fixture fixture;
  fixture.ExpectSuccess();
  fixture.Good->GetPoints()->SetPoint(100, 0.5, 0.5, 2.6);
  fixture.Good->GetPoints()->Modified();
  fixture.ExpectSuccess();
  EXPECT_EQ(fixture.Filter->GetNumberOfFactorizations(), 2);
  const cartan::Points reused = vtktest::PointsOf(fixture.Filter->GetOutput());
  Fixture fresh;
  fresh.Filter->SetInputData(vtktest::CopyOf(fixture.Good));
  fresh.ExpectSuccess();
  EXPECT_EQ(vtktest::PointsOf(fresh.Filter->GetOutput()), reused);

  // A hole makes the mesh another one.
  auto without = vtkSmartPointer<vtkCellArray>::New();
  for (vtkIdType cell = 1; cell < fixture.Good->GetNumberOfPolys(); ++cell)
  {
    vtkNew<vtkIdList> ids;
    fixture.Good->GetPolys()->GetCellAtId(cell, ids);
    without->InsertNextCell(ids);
  }
  fixture.Good->GetPolys()->DeepCopy(without);
  fixture.Good->GetPolys()->Modified();
  fixture.ExpectSuccess();
  EXPECT_EQ(fixture.Filter->GetNumberOfFactorizations(), 3);
}

TEST(SurfaceDeformation, ASecondUpdateDoesNothing)
{
  Fixture fixture;
  vtkNew<vtktest::ProgressLog> progress;
  fixture.Filter->AddObserver(vtkCommand::ProgressEvent, progress);
  fixture.ExpectSuccess();
  progress->Fractions.clear();
  fixture.Filter->Update();
  // What is as it was is no change.
  fixture.Filter->SetHandleArrayName("Handle");
  fixture.Filter->SetHandleMotion(2, fixture.Motion);
  fixture.Filter->SetLaplacianWeightsToCotangent();
  fixture.Filter->ConstrainHandlePositionsOn();
  fixture.Filter->RemoveHandleMotion(7);
  fixture.Motion->SetAngle(40);
  fixture.Filter->Update();
  EXPECT_TRUE(progress->Fractions.empty());
}

TEST(SurfaceDeformation, EveryParameterMakesItRunAgain)
{
  Fixture fixture;
  vtktest::AddHandles(fixture.Good, EndHandles, "Other");
  vtktest::AddArray(fixture.Good, "Vector", 3,
    [](vtkIdType, double* value) { value[0] = value[1] = value[2] = 0.1; });
  vtktest::AddArray(fixture.Good, "Matrix", 9,
    [](vtkIdType, double* value)
    { Eigen::Matrix3d::Map(value) = 0.5 * Eigen::Matrix3d::Identity(); });
  vtktest::AddArray(fixture.Good, "Weight", 1, [](vtkIdType, double* value) { *value = 2.0; });
  fixture.ExpectSuccess();
  vtkNew<vtktest::ProgressLog> progress;
  fixture.Filter->AddObserver(vtkCommand::ProgressEvent, progress);
  auto* filter = fixture.Filter.Get();
  const std::vector<std::pair<const char*, std::function<void()>>> changes = {
    { "HandleArrayName", [=]() { filter->SetHandleArrayName("Other"); } },
    { "Angle", [&]() { fixture.Motion->SetAngle(41); } },
    { "HandleMotion", [=]() { filter->SetHandleMotion(2, Turn(7)); } },
    { "RemoveHandleMotion", [=]() { filter->RemoveHandleMotion(2); } },
    { "ActiveMotion", [=]() { filter->SetActiveMotion(Turn(9)); } },
    { "ActiveHandle", [=]() { filter->SetActiveHandle(2); } },
    { "RemoveAllHandleMotions", [=]() { filter->RemoveAllHandleMotions(); } },
    { "MotionRow",
      [=]() { filter->SetMotionRow(0, 2, 1, 1, 1, 30, 1, 0, 0, 0, 0, 2.5, 0, 0, 0); } },
    { "the row's angle",
      [=]() { filter->SetMotionRow(0, 2, 1, 1, 1, 31, 1, 0, 0, 0, 0, 2.5, 0, 0, 0); } },
    { "NumberOfMotionRows", [=]() { filter->SetNumberOfMotionRows(0); } },
    { "ConstrainHandlePositions", [=]() { filter->ConstrainHandlePositionsOff(); } },
    { "TargetPositionArrayName",
      [=]()
      {
        filter->ConstrainHandlePositionsOn();
        filter->SetTargetPositionArrayName("Vector");
      } },
    { "RotationVectorArrayName", [=]() { filter->SetRotationVectorArrayName("Vector"); } },
    { "TransformArrayName",
      [=]()
      {
        filter->SetRotationVectorArrayName("");
        filter->SetTransformArrayName("Matrix");
      } },
    { "ConstraintWeightArrayName", [=]() { filter->SetConstraintWeightArrayName("Weight"); } },
    { "RoundingCheckLimit", [=]() { filter->SetRoundingCheckLimit(7); } },
    { "ScaleConstraintWeights", [=]() { filter->ScaleConstraintWeightsOn(); } },
    { "LaplacianWeights", [=]() { filter->SetLaplacianWeightsToMeanValue(); } },
    { "Solver", [=]() { filter->SetSolverToEigen(); } },
    { "GenerateFrameChange", [=]() { filter->GenerateFrameChangeOn(); } },
    { "GenerateRotationVector", [=]() { filter->GenerateRotationVectorOn(); } },
    { "FrameProjection", [=]() { filter->SetFrameProjectionToRotation(); } },
  };
  for (const auto& [name, change] : changes)
  {
    SCOPED_TRACE(name);
    progress->Fractions.clear();
    change();
    fixture.ExpectSuccess();
    EXPECT_FALSE(progress->Fractions.empty());
  }
}

//------------------------------------------------------------------------------
TEST(SurfaceDeformation, KeepsThePrecisionOfItsInput)
{
  for (const int precision : { VTK_FLOAT, VTK_DOUBLE })
  {
    Fixture fixture;
    fixture.Filter->SetInputData(MarkedBar(precision));
    fixture.ExpectSuccess();
    EXPECT_EQ(fixture.Filter->GetOutput()->GetPoints()->GetDataType(), precision);
  }
}

TEST(SurfaceDeformation, KeepsCellsAttributesAndPointsInNoTriangle)
{
  for (const int precision : { VTK_FLOAT, VTK_DOUBLE })
  {
    Fixture fixture;
    const auto input = MixedSurface(precision);
    AddAttributes(input);
    const auto copy = vtktest::CopyOf(input);
    fixture.Filter->SetInputData(input);
    fixture.ExpectSuccess();
    vtktest::ExpectSameSurface(input, copy);

    vtkPolyData* output = fixture.Filter->GetOutput();
    vtktest::ExpectSameCells(output, input);
    vtktest::ExpectArrays(output->GetPointData(), input->GetPointData());
    vtktest::ExpectArrays(output->GetCellData(), input->GetCellData());
    vtktest::ExpectArrays(output->GetFieldData(), input->GetFieldData());
    EXPECT_STREQ(output->GetPointData()->GetScalars()->GetName(), "Colors");
    EXPECT_EQ(output->GetPoints()->GetDataType(), precision);
    for (vtkIdType v = 0; v < input->GetNumberOfPoints(); ++v)
    {
      // Pinned points and those in no triangle, NaN included, to the bit.
      double before[3];
      double after[3];
      input->GetPoint(v, before);
      output->GetPoint(v, after);
      const bool isSame = std::memcmp(before, after, sizeof(before)) == 0;
      EXPECT_EQ(isSame, v < 4 || v >= 20) << v;
    }
  }
}

TEST(SurfaceDeformation, TriangulatesPolygonsAsTheyStand)
{
  // The same surface as triangles gives the same points.
  Fixture quads;
  const auto mixed = MixedSurface(VTK_DOUBLE);
  quads.Filter->SetInputData(mixed);
  quads.ExpectSuccess();
  EXPECT_EQ(quads.Filter->GetNumberOfFreePoints(), 12);
  EXPECT_TRUE(vtktest::PointsOf(quads.Filter->GetOutput()).topRows(20).allFinite());
}

TEST(SurfaceDeformation, UpdatesNormalsAndKeepsTheirSide)
{
  const auto rest = MarkedBar();
  const shapes::Shape shape = BarShape();
  const cartan::TriangleMesh mesh = shapes::MakeMesh(shape);
  const cartan::Points pointNormals = cartan::VertexNormals(mesh, shape.Positions);
  for (const double side : { 1.0, -1.0 })
  {
    for (const int precision : { VTK_FLOAT, VTK_DOUBLE })
    {
      Fixture fixture;
      const auto input = vtktest::CopyOf(rest);
      const auto newArray = [precision](vtkIdType size)
      {
        auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(precision));
        array->SetName("N");
        array->SetNumberOfComponents(3);
        array->SetNumberOfTuples(size);
        return array;
      };
      auto normals = newArray(input->GetNumberOfPoints());
      for (vtkIdType v = 0; v < input->GetNumberOfPoints(); ++v)
      {
        const Eigen::RowVector3d normal = side * pointNormals.row(v);
        normals->SetTuple(v, normal.data());
      }
      input->GetPointData()->SetNormals(normals);
      auto cellNormals = newArray(input->GetNumberOfCells());
      const cartan::Points areas = cartan::TriangleAreaVectors(shape.Positions, shape.Faces);
      for (vtkIdType c = 0; c < input->GetNumberOfCells(); ++c)
      {
        const Eigen::RowVector3d normal = side * areas.row(c).normalized();
        cellNormals->SetTuple(c, normal.data());
      }
      input->GetCellData()->SetNormals(cellNormals);
      fixture.Filter->SetInputData(input);
      fixture.ExpectSuccess();

      vtkPolyData* output = fixture.Filter->GetOutput();
      const cartan::Points points = vtktest::PointsOf(output);
      const cartan::Points expected = side * cartan::VertexNormals(mesh, points);
      const cartan::Points expectedOfCells =
        side * cartan::TriangleAreaVectors(points, shape.Faces).rowwise().normalized();
      vtkDataArray* ofPoints = output->GetPointData()->GetNormals();
      vtkDataArray* ofCells = output->GetCellData()->GetNormals();
      ASSERT_NE(ofPoints, nullptr);
      ASSERT_NE(ofCells, nullptr);
      EXPECT_STREQ(ofPoints->GetName(), "N");
      EXPECT_EQ(ofPoints->GetDataType(), precision);
      double worst = 0.0;
      for (vtkIdType v = 0; v < output->GetNumberOfPoints(); ++v)
      {
        worst =
          std::max(worst, (Eigen::RowVector3d(ofPoints->GetTuple3(v)) - expected.row(v)).norm());
      }
      for (vtkIdType c = 0; c < output->GetNumberOfCells(); ++c)
      {
        worst = std::max(
          worst, (Eigen::RowVector3d(ofCells->GetTuple3(c)) - expectedOfCells.row(c)).norm());
      }
      EXPECT_LT(worst, 1e-6);
      EXPECT_EQ(output->GetPointData()->GetNumberOfArrays(), 2); // no copy of the old
      EXPECT_GT((expected - side * pointNormals).norm(), 0.1);   // they did change
    }
  }
}

TEST(SurfaceDeformation, KeepsTheNormalsOfCellsThatHaveNone)
{
  // Vertices, lines and degenerate triangles between proper ones; inward normals.
  Fixture fixture;
  const auto input = MixedSurface(VTK_DOUBLE);
  vtkNew<vtkFloatArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  const cartan::Points points = vtktest::PointsOf(input);
  for (vtkIdType c = 0; c < input->GetNumberOfCells(); ++c)
  {
    vtkNew<vtkIdList> ids;
    input->GetCellPoints(c, ids);
    Eigen::RowVector3d normal(0, 0, 1);
    if (c >= 3)
    {
      const Eigen::RowVector3d a = points.row(ids->GetId(0));
      normal = (points.row(ids->GetId(1)) - a).cross(points.row(ids->GetId(2)) - a).normalized();
      // All but the strip, which starts the other way round.
      normal *= c == input->GetNumberOfCells() - 1 ? 1.0 : -1.0;
    }
    normals->InsertNextTuple(normal.data());
  }
  input->GetCellData()->SetNormals(normals);
  fixture.Filter->SetInputData(input);
  fixture.ExpectSuccess();
  vtkDataArray* updated = fixture.Filter->GetOutput()->GetCellData()->GetNormals();
  double agreement = 0.0;
  for (vtkIdType c = 0; c < input->GetNumberOfCells(); ++c)
  {
    const Eigen::RowVector3d before(normals->GetTuple3(c));
    const Eigen::RowVector3d after(updated->GetTuple3(c));
    ASSERT_TRUE(after.allFinite()) << c;
    EXPECT_NEAR(after.norm(), 1.0, 1e-6) << c;
    if (c < 3)
    {
      EXPECT_EQ(after, before) << c;
    }
    agreement += before.dot(after);
  }
  EXPECT_GT(agreement, 0.0);
}

TEST(SurfaceDeformation, WritesTheArraysOnRequest)
{
  Fixture fixture;
  fixture.ExpectSuccess();
  EXPECT_EQ(fixture.Filter->GetOutput()->GetPointData()->GetArray("FrameChange"), nullptr);
  EXPECT_EQ(fixture.Filter->GetOutput()->GetPointData()->GetArray("RotationVector"), nullptr);
  fixture.Filter->GenerateFrameChangeOn();
  fixture.Filter->GenerateRotationVectorOn();
  fixture.ExpectSuccess();
  vtkPolyData* output = fixture.Filter->GetOutput();
  vtkDataArray* change = output->GetPointData()->GetArray("FrameChange");
  vtkDataArray* rotation = output->GetPointData()->GetArray("RotationVector");
  ASSERT_NE(change, nullptr);
  ASSERT_NE(rotation, nullptr);
  EXPECT_EQ(change->GetNumberOfComponents(), 1);
  EXPECT_EQ(rotation->GetNumberOfComponents(), 3);
  const double angle = 40.0 * shapes::Pi / 180.0;
  for (vtkIdType v = 0; v < output->GetNumberOfPoints(); ++v)
  {
    const Eigen::Vector3d vector(rotation->GetTuple3(v));
    // |R - I| of a rotation by a is sqrt(8) sin(a / 2).
    EXPECT_NEAR(change->GetTuple1(v), std::sqrt(8.0) * std::sin(0.5 * vector.norm()), 1e-12);
    const double handle = output->GetPointData()->GetArray("Handle")->GetTuple1(v);
    const double expected = handle == 1 ? 0.0 : angle;
    EXPECT_NEAR(vector[1], 0.0, 1e-12);
    EXPECT_NEAR(vector[2], 0.0, 1e-12);
    if (handle > 0)
    {
      EXPECT_NEAR(vector[0], expected, 1e-12);
    }
    else
    {
      EXPECT_GT(vector[0], 0.0);
      EXPECT_LT(vector[0], angle);
    }
  }
}

//------------------------------------------------------------------------------
TEST(SurfaceDeformation, ReportsProgressThatMovesAndStopsWhenAborted)
{
  Fixture fixture;
  fixture.Filter->GenerateFrameChangeOn();
  vtkNew<vtktest::ProgressLog> progress;
  fixture.Filter->AddObserver(vtkCommand::ProgressEvent, progress);
  fixture.ExpectSuccess();
  const cartan::Points expected = vtktest::PointsOf(fixture.Filter->GetOutput());
  const std::vector<double> fractions = progress->Fractions;
  EXPECT_GT(fractions.size(), 6u);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1.0);
  // At each report but the executive's own first and last ones, with a surface
  // that nobody has read yet.
  fixture.Filter->ReleaseKeptMemory();
  for (std::size_t stop = 2; stop < fractions.size(); ++stop)
  {
    vtkNew<vtkRotationInvariantDeformation> filter;
    const auto log = vtktest::Observe(filter);
    filter->SetInputData(fixture.Good);
    filter->SetHandleMotion(2, fixture.Motion);
    filter->GenerateFrameChangeOn();
    vtkNew<vtktest::ProgressLog> aborting;
    aborting->AbortAt = static_cast<int>(stop);
    filter->AddObserver(vtkCommand::ProgressEvent, aborting);
    filter->Update();
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0) << fractions[stop - 1];
    EXPECT_LE(aborting->Fractions.size(), stop + 1) << "went on after the abort";
    aborting->AbortAt = 0;
    filter->SetAbortExecute(0); // VTK does not take an abort back by itself
    filter->Modified();
    filter->Update();
    EXPECT_EQ(vtktest::PointsOf(filter->GetOutput()), expected);
    vtktest::ExpectQuiet(*log);
  }
}

TEST(SurfaceDeformation, OfNothingIsNothing)
{
  Fixture fixture;
  fixture.Filter->SetInputData(vtkSmartPointer<vtkPolyData>::New());
  fixture.Filter->Update();
  vtktest::ExpectQuiet(*fixture.Log);
  EXPECT_EQ(fixture.Filter->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(SurfaceDeformation, WithoutMotionsHandsTheSurfaceOn)
{
  Fixture fixture;
  fixture.Filter->RemoveAllHandleMotions();
  fixture.ExpectSuccess();
  vtktest::ExpectSameSurface(fixture.Filter->GetOutput(), fixture.Good);
  EXPECT_EQ(fixture.Filter->GetNumberOfFreePoints(), 0);
}

TEST(SurfaceDeformation, TakesMotionsFromItsTableAndTheActiveHandle)
{
  Fixture fixture;
  fixture.ExpectSuccess();
  const cartan::Points expected = vtktest::PointsOf(fixture.Filter->GetOutput());
  fixture.Filter->RemoveAllHandleMotions();
  fixture.Filter->SetMotionRow(0, 2, 1, 1, 1, 40, 1, 0, 0, 0, 0, 2.5, 0, 0, 0);
  EXPECT_EQ(fixture.Filter->GetNumberOfMotionRows(), 1);
  fixture.ExpectSuccess();
  EXPECT_EQ(vtktest::PointsOf(fixture.Filter->GetOutput()), expected);
  fixture.Filter->SetNumberOfMotionRows(0);
  fixture.Filter->SetActiveHandle(2);
  fixture.Filter->SetActiveMotion(Turn(40));
  EXPECT_NE(fixture.Filter->GetActiveMotion(), nullptr);
  EXPECT_EQ(fixture.Filter->GetHandleMotion(2), nullptr); // a slot of its own
  fixture.ExpectSuccess();
  EXPECT_EQ(vtktest::PointsOf(fixture.Filter->GetOutput()), expected);
  EXPECT_EQ(fixture.Filter->GetNumberOfFactorizations(), 1);
}

TEST(SurfaceDeformation, ReadsHandlesOfAnyNumericType)
{
  Fixture fixture;
  fixture.ExpectSuccess();
  const cartan::Points expected = vtktest::PointsOf(fixture.Filter->GetOutput());
  for (const int type : { VTK_UNSIGNED_CHAR, VTK_LONG_LONG, VTK_FLOAT, VTK_DOUBLE, VTK_ID_TYPE })
  {
    auto input = vtktest::CopyOf(fixture.Good);
    auto handles = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
    handles->DeepCopy(input->GetPointData()->GetArray("Handle"));
    handles->SetName("Handle");
    input->GetPointData()->AddArray(handles);
    fixture.Filter->SetInputData(input);
    fixture.ExpectSuccess();
    EXPECT_EQ(vtktest::PointsOf(fixture.Filter->GetOutput()), expected);
  }
}

TEST(SurfaceDeformation, IgnoresWeightsOfFreePoints)
{
  Fixture fixture;
  vtkDataArray* handles = fixture.Good->GetPointData()->GetArray("Handle");
  vtktest::AddArray(fixture.Good, "Weight", 1,
    [handles](vtkIdType v, double* value) { *value = handles->GetTuple1(v) > 0 ? Infinity : NaN; });
  fixture.Filter->SetConstraintWeightArrayName("Weight");
  for (int step = 0; step < 3; ++step)
  {
    fixture.Motion->SetAngle(40.0 + step);
    fixture.ExpectSuccess();
  }
  EXPECT_EQ(fixture.Filter->GetNumberOfFactorizations(), 1);
}

TEST(SurfaceDeformation, ScaledWeightsMeanTheSameOnEveryMesh)
{
  // A unit square, one side pinned, the opposite one pulled by t with weight w:
  // 2 integral |grad u|^2 + w^2 mean |u - t|^2 along the side is least for a u
  // that grows evenly to t k / (1 + k), k = w^2 / 2, which every mesh can
  // represent.
  const Eigen::Vector3d pull(0.1, 0.2, 0.3);
  for (const double weight : { 0.5, 2.0 })
  {
    for (const double unit : { 1e-3, 1.0, 1e3 })
    {
      for (const int count : { 3, 10, 40 })
      {
        Shape square = shapes::Plane(count, 1.0, 0.25);
        square.Positions *= unit;
        Fixture fixture;
        fixture.Good = MakePolyData(square);
        vtktest::AddHandles(fixture.Good,
          [unit](const Eigen::Vector3d& x) {
            return x[1] < -0.499 * unit ? 1 : x[1] > 0.499 * unit ? 2 : 0;
          });
        vtkDataArray* handles = fixture.Good->GetPointData()->GetArray("Handle");
        vtktest::AddArray(fixture.Good, "Weight", 1,
          [&](vtkIdType v, double* value)
          { *value = handles->GetTuple1(v) == 2 ? weight : Infinity; });
        fixture.Filter->SetInputData(fixture.Good);
        fixture.Motion->SetAngle(0);
        fixture.Motion->SetTranslation(unit * pull[0], unit * pull[1], unit * pull[2]);
        fixture.Filter->SetConstraintWeightArrayName("Weight");
        fixture.Filter->ScaleConstraintWeightsOn();
        fixture.ExpectSuccess();
        const double k = 0.5 * weight * weight;
        const Eigen::MatrixXd expected = square.Positions +
          k / (1.0 + k) * (square.Positions.col(1).array() + 0.5 * unit).matrix() *
            pull.transpose();
        EXPECT_LT((vtktest::PointsOf(fixture.Filter->GetOutput()) - expected).norm(), 1e-9 * unit)
          << "weight " << weight << ", unit " << unit << ", mesh " << count;
      }
    }
  }
}

TEST(SurfaceDeformation, ScaledWeightsHoldRegionsByTheirBorderAndSinglePoints)
{
  // Handle 2 is a region, 3 a single point. Both turn alike, and with them all
  // else, their insides included: nothing is left unheld.
  Shape plane = shapes::Plane(12, 1.0, 0.2);
  Fixture fixture;
  fixture.Good = MakePolyData(plane);
  vtktest::AddHandles(fixture.Good,
    [&](const Eigen::Vector3d& x) {
      return x[1] > 0.2 ? 2 : x == plane.Positions.row(20).transpose() ? 3 : 0;
    });
  vtktest::AddArray(fixture.Good, "Weight", 1, [&](vtkIdType, double* value) { *value = 0.3; });
  fixture.Filter->SetInputData(fixture.Good);
  fixture.Filter->SetHandleMotion(3, fixture.Motion);
  fixture.Motion->SetCenter(0, 0, 0);
  fixture.Filter->SetConstraintWeightArrayName("Weight");
  fixture.Filter->ScaleConstraintWeightsOn();
  fixture.ExpectSuccess();
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(40.0 * shapes::Pi / 180.0, Eigen::Vector3d::UnitX()).matrix();
  EXPECT_LT((vtktest::PointsOf(fixture.Filter->GetOutput()) - plane.Positions * turn.transpose())
              .cwiseAbs()
              .maxCoeff(),
    1e-10);
}

TEST(SurfaceDeformation, WarnsOfDegenerateTrianglesAndGoesOn)
{
  Shape shape = BarShape();
  const int added = shape.NumberOfVertices();
  const Eigen::RowVector3i face = shape.Faces.row(40);
  shape.Positions.conservativeResize(added + 1, 3);
  shape.Positions.row(added) = 0.5 * (shape.Positions.row(face[0]) + shape.Positions.row(face[1]));
  shape.Faces.row(40) << face[0], added, face[2];
  shape.Faces.conservativeResize(shape.Faces.rows() + 2, 3);
  shape.Faces.bottomRows(2) << added, face[1], face[2], face[0], face[1], added;
  auto input = MakePolyData(shape);
  vtktest::AddHandles(input, EndHandles);
  input->GetPolys()->InsertNextCell({ 5, 5, 6 });
  Fixture fixture;
  fixture.Filter->SetInputData(input);
  fixture.Filter->Update();
  EXPECT_TRUE(fixture.Log->Errors.empty());
  const std::string id = std::to_string(shape.Faces.rows() - 1);
  const std::string repeated = std::to_string(shape.Faces.rows());
  vtktest::ExpectMessage(fixture.Log->Warnings,
    { "1 cell (id " + id + ") without area", "1 cell (id " + repeated + ") using a point twice" });
  EXPECT_TRUE(vtktest::PointsOf(fixture.Filter->GetOutput()).allFinite());
  // And so with every motion: each result is what the input allows.
  fixture.Motion->SetAngle(50);
  fixture.Log->Clear();
  fixture.Filter->Update();
  vtktest::ExpectMessage(fixture.Log->Warnings, { "without area" });
}

TEST(SurfaceDeformation, HoldsTogetherThroughPolygonsWithoutArea)
{
  // A grid of quads whose middle row has no height; it must not become a cut.
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> quads;
  for (int j = 0; j < 5; ++j)
  {
    for (int i = 0; i < 4; ++i)
    {
      points->InsertNextPoint(i, j < 3 ? j : j - 1, 0);
      if (i < 3 && j < 4)
      {
        const vtkIdType corner = 4 * j + i;
        quads->InsertNextCell({ corner, corner + 1, corner + 5, corner + 4 });
      }
    }
  }
  vtkNew<vtkPolyData> input;
  input->SetPoints(points);
  input->SetPolys(quads);
  vtktest::AddHandles(
    input, [](const Eigen::Vector3d& x) { return x[1] < 0.5 ? 1
                                            : x[1] > 2.5    ? 2
                                                            : 0; });
  Fixture fixture;
  fixture.Motion->SetCenter(1.5, 1.5, 0);
  fixture.Motion->SetAxis(0, 0, 1);
  fixture.Motion->SetAngle(10);
  fixture.Filter->SetInputData(input);
  fixture.Filter->Update();
  EXPECT_TRUE(fixture.Log->Errors.empty());
  vtktest::ExpectMessage(
    fixture.Log->Warnings, { "6 cells (ids 6, 6, 7, 7, 8, ...) without area" });
  // Of the two rows in one place one is solved for, and carries the other.
  EXPECT_EQ(fixture.Filter->GetNumberOfFreePoints(), 8);
  const cartan::Points result = vtktest::PointsOf(fixture.Filter->GetOutput());
  ASSERT_TRUE(result.allFinite());
  for (int i = 0; i < 4; ++i)
  {
    EXPECT_LT((result.row(8 + i) - result.row(12 + i)).norm(), 1e-12);
  }
}

//------------------------------------------------------------------------------
TEST(SurfaceDeformation, RefusesBadSurfaces)
{
  Fixture fixture;
  for (const vtktest::BadSurface& bad : vtktest::BadSurfaces())
  {
    SCOPED_TRACE(bad.Name);
    if (bad.Surface->GetPoints())
    {
      vtktest::AddHandles(bad.Surface, [](const Eigen::Vector3d& x) { return x[0] > 0 ? 2 : 1; });
    }
    vtktest::ExpectRefused(fixture.Filter, fixture.Log, bad.Surface, bad.Parts, fixture.Good);
  }
}

TEST(SurfaceDeformation, RefusesPolygonsWithPointsThatAreNotFinite)
{
  // Triangulating them must not hide it.
  Fixture fixture;
  for (const double value : { NaN, Infinity })
  {
    for (const int precision : { VTK_FLOAT, VTK_DOUBLE })
    {
      auto input = MixedSurface(precision);
      input->GetPoints()->SetPoint(6, value, 0, 0);
      vtktest::ExpectRefused(
        fixture.Filter, fixture.Log, input, { "1 point (id 6)", "NaN or infinite" }, fixture.Good);
    }
  }
}

TEST(SurfaceDeformation, RefusesBadHandleArrays)
{
  Fixture fixture;
  const auto expectRefused = [&](vtkPolyData* bad, const std::vector<std::string>& parts)
  { vtktest::ExpectRefused(fixture.Filter, fixture.Log, bad, parts, fixture.Good); };

  expectRefused(MakePolyData(BarShape()), { "no point array \"Handle\"", "Mark Handle" });

  auto vectors = MakePolyData(BarShape());
  vtktest::AddArray(vectors, "Handle", 3, [](vtkIdType, double* x) { x[0] = x[1] = x[2] = 0; });
  expectRefused(vectors, { "\"Handle\"", "3 components", "expected" });

  auto shorter = MakePolyData(BarShape());
  vtkNew<vtkIntArray> few;
  few->SetName("Handle");
  few->InsertNextValue(1);
  shorter->GetPointData()->AddArray(few);
  expectRefused(shorter, { "\"Handle\"", "1 tuples", "expected " });

  auto text = MakePolyData(BarShape());
  vtkNew<vtkStringArray> words;
  words->SetName("Handle");
  words->SetNumberOfValues(text->GetNumberOfPoints());
  text->GetPointData()->AddArray(words);
  expectRefused(text, { "no numeric point array \"Handle\"" });

  for (const double value : { -1.0, 0.5, NaN, Infinity, 1e10 })
  {
    SCOPED_TRACE(value);
    auto bad = MakePolyData(BarShape());
    vtktest::AddArray(bad, "Handle", 1,
      [value](vtkIdType v, double* x) {
        *x = v == 4 || v == 9 ? value : v < 20 ? 1.0 : v > 200 ? 2.0 : 0.0;
      });
    expectRefused(bad, { "2 values (ids 4, 9)", "whole numbers >= 0" });
  }
}

TEST(SurfaceDeformation, RefusesMotionsThatMoveNothingOrAreNoMap)
{
  Fixture fixture;
  fixture.Filter->SetHandleMotion(5, Turn(10));
  fixture.ExpectError({ "Handle 5 has a motion", "Handles with points: 1, 2" });
  fixture.Filter->RemoveHandleMotion(5);
  fixture.ExpectSuccess();

  fixture.Motion->SetAngle(NaN);
  fixture.ExpectError({ "motion of handle 2", "Angle", "NaN" });
  fixture.Motion->SetAngle(40);
  fixture.Motion->SetAxis(0, 0, 0);
  fixture.ExpectError({ "motion of handle 2", "Axis has length zero" });
  fixture.Motion->SetAxis(1, 0, 0);
  fixture.ExpectSuccess();

  auto nobody = vtktest::CopyOf(fixture.Good);
  nobody->GetPointData()->GetArray("Handle")->Fill(0);
  vtktest::ExpectRefused(fixture.Filter, fixture.Log, nobody,
    { "Handle 2 has a motion", "No point belongs to any handle" }, fixture.Good);

  fixture.Filter->SetMotionRow(0, 2, 1, 1, 1, 30, 1, 0, 0, 0, 0, 2.5, 0, 0, 0);
  fixture.ExpectError({ "Handle 2 has two motions" });
  for (const double id : { 0.0, -1.0, 1.5, NaN, 1e20 })
  {
    SCOPED_TRACE(id);
    fixture.Filter->SetMotionRow(0, id, 1, 1, 1, 30, 1, 0, 0, 0, 0, 2.5, 0, 0, 0);
    fixture.ExpectError({ "row", "whole numbers >= 1" });
  }
  fixture.Filter->SetNumberOfMotionRows(0);
  fixture.ExpectSuccess();

  fixture.Filter->SetHandleMotion(0, Turn(10));
  vtktest::ExpectMessage(fixture.Log->Errors, { "Handle ids are >= 1; got 0" });
  fixture.Log->Clear();
  fixture.Filter->SetActiveHandle(-3);
  vtktest::ExpectMessage(fixture.Log->Errors, { "Handle ids are >= 1; got -3" });
  fixture.ExpectSuccess();
}

TEST(SurfaceDeformation, RefusesBadArraysOfTargetsAndWeights)
{
  Fixture fixture;
  fixture.Filter->RemoveAllHandleMotions();
  const auto constant = [](double number, int components)
  {
    return [number, components](vtkIdType, double* value)
    { std::fill(value, value + components, number); };
  };
  using Setter = void (vtkSurfaceDeformation::*)(const std::string&);
  for (const auto& [setter, components] :
    std::vector<std::pair<Setter, int>>{ { &vtkSurfaceDeformation::SetTargetPositionArrayName, 3 },
      { &vtkSurfaceDeformation::SetRotationVectorArrayName, 3 },
      { &vtkSurfaceDeformation::SetTransformArrayName, 9 },
      { &vtkSurfaceDeformation::SetConstraintWeightArrayName, 1 } })
  {
    SCOPED_TRACE(components);
    vtkSurfaceDeformation* filter = fixture.Filter;
    (filter->*setter)("Missing");
    fixture.ExpectError({ "no numeric point array \"Missing\"" });
    (filter->*setter)("Array");
    vtktest::AddArray(fixture.Good, "Array", 2, constant(1.0, 2));
    fixture.ExpectError(
      { "\"Array\"", "2 components", "expected", "of " + std::to_string(components) });
    vtktest::AddArray(fixture.Good, "Array", components, constant(NaN, components));
    fixture.ExpectError({ "\"Array\"", "handle points (ids", "NaN" });
    (filter->*setter)("");
    fixture.ExpectSuccess();
  }
  vtktest::AddArray(fixture.Good, "Array", 1, constant(-1.0, 1));
  fixture.Filter->SetConstraintWeightArrayName("Array");
  fixture.ExpectError({ "weight that is negative or NaN", "0 leaves a point free" });
  fixture.Filter->SetConstraintWeightArrayName("");

  vtktest::AddArray(fixture.Good, "Array", 3, constant(0.5, 3));
  vtktest::AddArray(fixture.Good, "Matrix", 9, constant(0.5, 9));
  fixture.Filter->SetRotationVectorArrayName("Array");
  fixture.Filter->SetTransformArrayName("Matrix");
  fixture.ExpectError({ "rotation vector array and a transform array", "choose one" });
  fixture.Filter->SetTransformArrayName("");
  fixture.ExpectSuccess();
}

TEST(SurfaceDeformation, RefusesSystemsThatNothingDetermines)
{
  // Handles that do not hold leave the bar without a constraint.
  Fixture fixture;
  vtktest::AddArray(fixture.Good, "Weight", 1, [](vtkIdType, double* value) { *value = 0.0; });
  fixture.Filter->SetConstraintWeightArrayName("Weight");
  const std::string all = std::to_string(fixture.Good->GetNumberOfPoints()) + " points";
  fixture.ExpectError({ "singular", all, "have no constraint", "Fix at least" });
  fixture.Filter->SetConstraintWeightArrayName("");
  fixture.ExpectSuccess();
  // Free positions need a handle that is pinned.
  fixture.Filter->ConstrainHandlePositionsOff();
  fixture.Filter->SetHandleMotion(1, Turn(10));
  fixture.ExpectError({ "singular", all, "have no constraint" });
  fixture.Filter->ConstrainHandlePositionsOn();
  fixture.ExpectSuccess();
}

TEST(SurfaceDeformation, PrintsItself)
{
  Fixture fixture;
  std::ostringstream text;
  fixture.Filter->Print(text);
  for (const char* part : { "HandleArrayName: Handle", "LaplacianWeights: 1", "Motion of handle 2",
         "Angle: 40", "FrameProjection: 0" })
  {
    EXPECT_NE(text.str().find(part), std::string::npos) << part;
  }
}
