// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDiscreteForms.h"

#include "VtkTestHelpers.h"

#include "vtkMultiBlockDataSet.h"
#include "vtkTable.h"
#include "vtkTriangleFilter.h"

#include <cmath>
#include <map>

using shapes::Shape;
using vtktest::MakePolyData;

namespace
{
struct Row
{
  double Length;
  double Angle;
  double Height;
  double Orientation;
};
using Rows = std::map<std::pair<vtkIdType, vtkIdType>, Row>;

Rows ReadRows(vtkTable* table)
{
  Rows rows;
  for (vtkIdType r = 0; r < table->GetNumberOfRows(); ++r)
  {
    const auto value = [table, r](const char* column)
    { return table->GetValueByName(r, column).ToDouble(); };
    rows[{ table->GetValueByName(r, "Vertex").ToTypeInt64(),
      table->GetValueByName(r, "Neighbor").ToTypeInt64() }] = { value("Length"), value("Angle"),
      value("Height"), value("Orientation") };
  }
  return rows;
}

Rows FormsOf(vtkPolyData* surface)
{
  vtkNew<vtkDiscreteForms> filter;
  filter->SetInputData(surface);
  filter->Update();
  return ReadRows(filter->GetFormsTable());
}

Eigen::Vector3d Tuple(vtkPolyData* surface, const char* name, vtkIdType point)
{
  Eigen::Vector3d vector;
  surface->GetPointData()->GetArray(name)->GetTuple(point, vector.data());
  return vector;
}
}

TEST(DiscreteFormsFilter, WritesTheDocumentedColumnsAndArrays)
{
  const Shape shape = shapes::Saddle(5, 1.0, 0.2);
  vtkNew<vtkDiscreteForms> filter;
  const auto log = vtktest::Observe(filter);
  filter->SetInputData(MakePolyData(shape));
  filter->Update();
  vtktest::ExpectQuiet(*log);

  vtkTable* table = filter->GetFormsTable();
  EXPECT_EQ(table, filter->GetOutputDataObject(1));
  const std::vector<std::pair<std::string, int>> columns = { { "Vertex", VTK_ID_TYPE },
    { "Neighbor", VTK_ID_TYPE }, { "Length", VTK_DOUBLE }, { "Angle", VTK_DOUBLE },
    { "Height", VTK_DOUBLE }, { "Orientation", VTK_INT } };
  ASSERT_EQ(table->GetNumberOfColumns(), static_cast<vtkIdType>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c)
  {
    EXPECT_EQ(table->GetColumnName(static_cast<vtkIdType>(c)), columns[c].first);
    EXPECT_EQ(table->GetColumn(static_cast<vtkIdType>(c))->GetDataType(), columns[c].second);
  }
  const cartan::TriangleMesh mesh = shapes::MakeMesh(shape);
  EXPECT_EQ(table->GetNumberOfRows(), mesh.NumberOfDirectedEdges());

  vtkPolyData* output = filter->GetOutput();
  for (const char* name : { "FrameTangent1", "FrameTangent2", "FrameNormal" })
  {
    vtkDataArray* array = output->GetPointData()->GetArray(name);
    ASSERT_NE(array, nullptr);
    EXPECT_EQ(array->GetDataType(), VTK_DOUBLE);
    EXPECT_EQ(array->GetNumberOfComponents(), 3);
    EXPECT_EQ(array->GetNumberOfTuples(), shape.NumberOfVertices());
  }
}

TEST(DiscreteFormsFilter, TableSaysWhatTheFramesSee)
{
  // Each column from the output's points and frames, row by row.
  const auto input = MakePolyData(shapes::RealMesh("elephant"));
  vtkNew<vtkDiscreteForms> filter;
  filter->SetInputData(input);
  filter->Update();
  vtkPolyData* output = filter->GetOutput();
  vtkTable* table = filter->GetFormsTable();
  const cartan::Points points = vtktest::PointsOf(output);
  Eigen::Vector3d previous = Eigen::Vector3d::Zero();
  vtkIdType lastVertex = -1;
  for (vtkIdType r = 0; r < table->GetNumberOfRows(); ++r)
  {
    const vtkIdType v = table->GetValueByName(r, "Vertex").ToTypeInt64();
    const vtkIdType w = table->GetValueByName(r, "Neighbor").ToTypeInt64();
    const Eigen::Vector3d normal = Tuple(output, "FrameNormal", v);
    const Eigen::Vector3d edge = (points.row(w) - points.row(v)).transpose();
    const Eigen::Vector3d projected = edge - edge.dot(normal) * normal;
    ASSERT_NEAR(table->GetValueByName(r, "Height").ToDouble(), edge.dot(normal), 1e-15);
    ASSERT_NEAR(table->GetValueByName(r, "Length").ToDouble(), projected.norm(), 1e-15);
    if (v == lastVertex) // the row before says how far it is to this edge
    {
      const double sine = previous.cross(projected).dot(normal);
      const double angle = std::atan2(sine, previous.dot(projected));
      ASSERT_NEAR(table->GetValueByName(r - 1, "Angle").ToDouble(), angle, 1e-9);
      ASSERT_EQ(table->GetValueByName(r - 1, "Orientation").ToInt(), sine > 0.0 ? 1 : -1);
    }
    else
    {
      ASSERT_GT(v, lastVertex); // grouped by vertex, in order
      const Eigen::Vector3d tangent = Tuple(output, "FrameTangent1", v);
      ASSERT_LT((projected.normalized() - tangent).norm(), 1e-9);
      ASSERT_LT((normal.cross(tangent) - Tuple(output, "FrameTangent2", v)).norm(), 1e-12);
    }
    previous = projected;
    lastVertex = v;
  }
}

TEST(DiscreteFormsFilter, HasThreeNumbersPerEdgeAndOneNaNPerBoundaryPoint)
{
  const Shape shape = shapes::OpenCylinder(8, 4);
  const cartan::TriangleMesh mesh = shapes::MakeMesh(shape);
  const Rows rows = FormsOf(MakePolyData(shape));
  std::vector<int> numbers(shape.NumberOfVertices(), 0);
  std::vector<int> missing(shape.NumberOfVertices(), 0);
  for (const auto& [edge, row] : rows)
  {
    for (const double value : { row.Length, row.Angle, row.Height })
    {
      ++(std::isnan(value) ? missing : numbers)[edge.first];
    }
    EXPECT_EQ(row.Orientation == 0.0, std::isnan(row.Angle));
  }
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    EXPECT_EQ(missing[v], mesh.IsBoundary(v));
    EXPECT_EQ(numbers[v], 3 * mesh.Valence(v) - mesh.IsBoundary(v));
  }
}

TEST(DiscreteFormsFilter, TableDoesNotChangeUnderRigidMotions)
{
  // Also far from the origin, up to the digits that the coordinates have there.
  const Shape shape = shapes::RealMesh("elephant");
  const Rows before = FormsOf(MakePolyData(shape));
  for (const auto& [distance, tolerance] :
    std::vector<std::pair<double, double>>{ { 1.0, 1e-12 }, { 1e6, 1e-8 } })
  {
    Rows after = FormsOf(MakePolyData(shapes::RandomRigidMotion(4, distance)(shape)));
    ASSERT_EQ(after.size(), before.size());
    for (const auto& [edge, row] : before)
    {
      const Row& other = after.at(edge);
      ASSERT_NEAR(row.Length, other.Length, tolerance);
      ASSERT_NEAR(row.Height, other.Height, tolerance);
    }
  }
}

TEST(DiscreteFormsFilter, CutsRectanglesAlikeInEveryPosition)
{
  // Both diagonals of these quads are equally long, but for rounding.
  const shapes::Shape tube = shapes::OpenCylinder(7, 6, 0.3, 2.0);
  vtkNew<vtkCellArray> quads;
  for (Eigen::Index t = 0; t < tube.Faces.rows(); t += 2)
  {
    quads->InsertNextCell(
      { tube.Faces(t, 0), tube.Faces(t, 1), tube.Faces(t, 2), tube.Faces(t + 1, 2) });
  }
  std::vector<vtkIdType> edges;
  for (unsigned int seed = 0; seed < 12; ++seed)
  {
    const int precision = seed % 2 == 0 ? VTK_DOUBLE : VTK_FLOAT;
    const auto surface = vtktest::MakePolyData(
      seed == 0 ? tube : shapes::RandomRigidMotion(seed, 5.0)(tube), precision);
    surface->SetPolys(quads);
    vtkNew<vtkDiscreteForms> filter;
    filter->SetInputData(surface);
    filter->Update();
    vtkDataArray* neighbors =
      vtkDataArray::SafeDownCast(filter->GetFormsTable()->GetColumnByName("Neighbor"));
    std::vector<vtkIdType> ids;
    for (vtkIdType row = 0; row < neighbors->GetNumberOfTuples(); ++row)
    {
      ids.push_back(static_cast<vtkIdType>(neighbors->GetTuple1(row)));
    }
    edges = edges.empty() ? ids : edges;
    EXPECT_EQ(ids, edges) << seed;
  }
}

TEST(DiscreteFormsFilter, ScalesLengthsAndHeightsOnly)
{
  const Shape shape = shapes::RealMesh("elephant");
  const Rows before = FormsOf(MakePolyData(shape));
  for (const double unit : { 1e-9, 1e6 })
  {
    Shape scaled = shape;
    scaled.Positions *= unit;
    const Rows after = FormsOf(MakePolyData(scaled));
    for (const auto& [edge, row] : before)
    {
      const Row& other = after.at(edge);
      ASSERT_NEAR(other.Length / unit, row.Length, 1e-13);
      ASSERT_NEAR(other.Height / unit, row.Height, 1e-13);
      ASSERT_LT(std::abs(std::remainder(other.Angle - row.Angle, 2 * shapes::Pi)), 1e-9);
      ASSERT_EQ(other.Orientation, row.Orientation);
    }
  }
}

TEST(DiscreteFormsFilter, KeepsTheSurfaceAndItsAttributes)
{
  // A quad, a strip, a line, a vertex, an unused point with NaN, float points.
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  for (int j = 0; j < 3; ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      points->InsertNextPoint(i, j, 0.1 * i * j);
    }
  }
  points->InsertNextPoint(std::nan(""), 0, 0);
  vtkNew<vtkPolyData> input;
  input->SetPoints(points);
  vtkNew<vtkCellArray> verts;
  verts->InsertNextCell({ 9 });
  input->SetVerts(verts);
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell({ 0, 8, 9 });
  input->SetLines(lines);
  vtkNew<vtkCellArray> polygons;
  polygons->InsertNextCell({ 0, 1, 4, 3 });
  polygons->InsertNextCell({ 1, 2, 5, 4 });
  input->SetPolys(polygons);
  vtkNew<vtkCellArray> strips;
  strips->InsertNextCell({ 6, 3, 7, 4, 8, 5 });
  input->SetStrips(strips);
  vtktest::AddArray(
    input, "Values", 2, [](vtkIdType v, double* value) { value[0] = value[1] = v; });
  vtkNew<vtkIntArray> cellValues;
  cellValues->SetName("Cells");
  for (int cell = 0; cell < 5; ++cell)
  {
    cellValues->InsertNextValue(cell);
  }
  input->GetCellData()->AddArray(cellValues);
  const auto copy = vtktest::CopyOf(input);

  vtkNew<vtkDiscreteForms> filter;
  const auto log = vtktest::Observe(filter);
  filter->SetInputData(input);
  filter->Update();
  vtktest::ExpectQuiet(*log);
  vtktest::ExpectSameSurface(input, copy);
  vtkPolyData* output = filter->GetOutput();
  vtktest::ExpectSameCells(output, input);
  EXPECT_TRUE(vtktest::SameArray(output->GetPoints()->GetData(), points->GetData()));
  vtktest::ExpectArrays(output->GetPointData(), input->GetPointData(), false);
  vtktest::ExpectArrays(output->GetCellData(), input->GetCellData());
  EXPECT_EQ(Tuple(output, "FrameNormal", 9), Eigen::Vector3d::UnitZ());
  // 9 points, 8 triangles of a disk: 16 edges.
  EXPECT_EQ(filter->GetFormsTable()->GetNumberOfRows(), 32);
}

TEST(DiscreteFormsFilter, WarnsOfTrianglesWithoutAreaAndGoesOn)
{
  Shape shape = shapes::Plane(3);
  const int added = shape.NumberOfVertices();
  shape.Positions.conservativeResize(added + 1, 3);
  shape.Positions.row(added) = 0.5 * (shape.Positions.row(0) + shape.Positions.row(1));
  shape.Faces.conservativeResize(shape.Faces.rows() + 1, 3);
  shape.Faces.row(shape.Faces.rows() - 1) << 1, 0, added;
  auto good = MakePolyData(shapes::Icosphere(1));
  vtkNew<vtkDiscreteForms> filter;
  const auto log = vtktest::Observe(filter);

  // The added point has no other triangle, so it has no normal.
  vtktest::ExpectRefused(filter, log, MakePolyData(shape),
    { "1 point (id 16)", "without a normal", "Prepare Surface" }, good);

  // A needle beside proper triangles is no obstacle.
  shape.Faces.row(18) << 0, 1, added;
  shape.Faces.row(0) << added, 1, 5;
  shape.Faces.conservativeResize(shape.Faces.rows() + 1, 3);
  shape.Faces.row(shape.Faces.rows() - 1) << 0, added, 5;
  filter->SetInputData(MakePolyData(shape));
  log->Clear();
  filter->Update();
  EXPECT_TRUE(log->Errors.empty());
  vtktest::ExpectMessage(log->Warnings, { "1 cell (id 18) without area" });
  EXPECT_GT(filter->GetFormsTable()->GetNumberOfRows(), 0);
}

TEST(DiscreteFormsFilter, RefusesBadSurfaces)
{
  const auto good = MakePolyData(shapes::Icosphere(1));
  vtkNew<vtkDiscreteForms> filter;
  const auto log = vtktest::Observe(filter);
  for (const vtktest::BadSurface& bad : vtktest::BadSurfaces())
  {
    SCOPED_TRACE(bad.Name);
    vtktest::ExpectRefused(filter, log, bad.Surface, bad.Parts, good);
  }
}

TEST(DiscreteFormsFilter, OfNothingIsNothing)
{
  vtkNew<vtkDiscreteForms> filter;
  const auto log = vtktest::Observe(filter);
  filter->SetInputData(vtkSmartPointer<vtkPolyData>::New());
  filter->Update();
  vtktest::ExpectQuiet(*log);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_EQ(filter->GetFormsTable()->GetNumberOfRows(), 0);
}

TEST(DiscreteFormsFilter, RunsAgainOnlyWhenTheInputChanges)
{
  vtkNew<vtktest::Producer> producer;
  producer->SetSurface(MakePolyData(shapes::Icosphere(1)));
  vtkNew<vtkDiscreteForms> filter;
  filter->SetInputConnection(producer->GetOutputPort());
  vtkNew<vtktest::ProgressLog> progress;
  filter->AddObserver(vtkCommand::ProgressEvent, progress);
  filter->Update();
  const std::size_t reports = progress->Fractions.size();
  EXPECT_GT(reports, 3u);
  EXPECT_TRUE(std::is_sorted(progress->Fractions.begin(), progress->Fractions.end()));
  filter->Update();
  EXPECT_EQ(progress->Fractions.size(), reports);
  producer->SetSurface(MakePolyData(shapes::Icosphere(2)));
  filter->Update();
  EXPECT_EQ(filter->GetFormsTable()->GetNumberOfRows(), 960);
}

TEST(DiscreteFormsFilter, StopsWhenAborted)
{
  vtkNew<vtkDiscreteForms> filter;
  const auto log = vtktest::Observe(filter);
  vtkNew<vtktest::ProgressLog> progress;
  filter->AddObserver(vtkCommand::ProgressEvent, progress);
  filter->SetInputData(MakePolyData(shapes::Icosphere(2)));
  progress->AbortAt = 3; // after the executive's own
  filter->Update();
  vtktest::ExpectQuiet(*log);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_EQ(filter->GetFormsTable()->GetNumberOfRows(), 0);
  progress->AbortAt = 0;
  filter->SetAbortExecute(0); // VTK does not take an abort back by itself
  filter->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetFormsTable()->GetNumberOfRows(), 960);
}

TEST(DiscreteFormsFilter, WorksBlockByBlock)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, MakePolyData(shapes::Icosphere(1)));
  blocks->SetBlock(2, MakePolyData(shapes::Icosphere(2)));
  vtkNew<vtkDiscreteForms> filter;
  const auto log = vtktest::Observe(filter);
  filter->SetInputDataObject(blocks);
  filter->Update();
  vtktest::ExpectQuiet(*log);
  auto* surfaces = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  auto* tables = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(1));
  ASSERT_NE(surfaces, nullptr);
  ASSERT_NE(tables, nullptr);
  EXPECT_EQ(vtkPolyData::SafeDownCast(surfaces->GetBlock(0))->GetNumberOfPoints(), 42);
  EXPECT_EQ(vtkPolyData::SafeDownCast(surfaces->GetBlock(2))->GetNumberOfPoints(), 162);
  EXPECT_EQ(vtkTable::SafeDownCast(tables->GetBlock(0))->GetNumberOfRows(), 240);
  EXPECT_EQ(vtkTable::SafeDownCast(tables->GetBlock(2))->GetNumberOfRows(), 960);
}
