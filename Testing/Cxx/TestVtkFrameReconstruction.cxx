// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFrameReconstruction.h"

#include "Kernel/Mesh/Geometry.h"
#include "VtkTestHelpers.h"

#include "vtkDiscreteForms.h"
#include "vtkIdTypeArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkXMLTableReader.h"
#include "vtkXMLTableWriter.h"

#include <cmath>
#include <numeric>

using shapes::Shape;
using vtktest::MakePolyData;

namespace
{
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

vtkSmartPointer<vtkTable> FormsTable(vtkPolyData* surface)
{
  vtkNew<vtkDiscreteForms> filter;
  filter->SetInputData(surface);
  filter->Update();
  auto table = vtkSmartPointer<vtkTable>::New();
  table->DeepCopy(filter->GetFormsTable());
  return table;
}

/// Connectivity whose coordinates mean nothing.
vtkSmartPointer<vtkPolyData> Scrambled(const Shape& shape, bool withNaN = false)
{
  Shape scrambled = shape;
  shapes::Random random(13);
  scrambled.Positions =
    cartan::Points::NullaryExpr(shape.NumberOfVertices(), 3, [&random]() { return random(); });
  if (withNaN)
  {
    scrambled.Positions.row(1).setConstant(NaN);
    scrambled.Positions.bottomRows(3).setZero();
  }
  return MakePolyData(scrambled);
}

double DistanceUpToRigidMotion(const cartan::Points& points, const cartan::Points& expected)
{
  const shapes::RigidMotion motion = shapes::BestRigidMotion(points, expected);
  return (motion(points) - expected).rowwise().norm().maxCoeff() /
    cartan::BoundingDiagonal(expected);
}

vtkSmartPointer<vtkFrameReconstruction> Reconstruct(vtkPolyData* connectivity, vtkTable* table)
{
  auto filter = vtkSmartPointer<vtkFrameReconstruction>::New();
  filter->SetInputData(connectivity);
  filter->SetFormsData(table);
  return filter;
}

/// The table with its rows in another order.
vtkSmartPointer<vtkTable> Shuffled(vtkTable* table)
{
  std::vector<vtkIdType> order(table->GetNumberOfRows());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(2));
  auto shuffled = vtkSmartPointer<vtkTable>::New();
  shuffled->DeepCopy(table);
  for (vtkIdType r = 0; r < table->GetNumberOfRows(); ++r)
  {
    for (vtkIdType c = 0; c < table->GetNumberOfColumns(); ++c)
    {
      shuffled->GetColumn(c)->SetTuple(r, order[r], table->GetColumn(c));
    }
  }
  return shuffled;
}

/// A surface with a Handle-like selection and the frames of vtkDiscreteForms.
vtkSmartPointer<vtkPolyData> WithFrames(const Shape& shape)
{
  vtkNew<vtkDiscreteForms> filter;
  filter->SetInputData(MakePolyData(shape));
  filter->Update();
  return vtktest::CopyOf(filter->GetOutput());
}
}

TEST(FrameReconstructionFilter, ReturnsRealMeshesFromATableOnDiskAlone)
{
  for (const std::string name : { "armadillo", "camel", "bunny00" })
  {
    const Shape shape = shapes::RealMesh(name);
    const std::string path = std::string(CARTAN_TEST_OUTPUT) + "/Forms-" + name + ".vtt";
    {
      vtkNew<vtkDiscreteForms> forms;
      forms->SetInputData(MakePolyData(shape));
      vtkNew<vtkXMLTableWriter> writer; // all bits of a double, NaN too
      writer->SetInputConnection(forms->GetOutputPort(1));
      writer->SetDataModeToBinary();
      writer->SetFileName(path.c_str());
      ASSERT_EQ(writer->Write(), 1);
    }
    vtkNew<vtkXMLTableReader> reader;
    reader->SetFileName(path.c_str());
    vtkNew<vtkFrameReconstruction> filter;
    const auto log = vtktest::Observe(filter);
    filter->SetInputData(Scrambled(shape));
    filter->SetFormsConnection(reader->GetOutputPort());
    filter->Update();
    vtktest::ExpectQuiet(*log);
    ASSERT_EQ(filter->GetOutput()->GetNumberOfPoints(), shape.NumberOfVertices());
    const double error =
      DistanceUpToRigidMotion(vtktest::PointsOf(filter->GetOutput()), shape.Positions);
    shapes::ShowFigure(name + ", from the table on disk, relative to the diagonal", error);
    EXPECT_LT(error, 1e-9);
    std::remove(path.c_str());
  }
}

TEST(FrameReconstructionFilter, DoesNotLookAtCoordinates)
{
  const Shape shape = shapes::RealMesh("elephant");
  const auto table = FormsTable(MakePolyData(shape));
  const auto random = Reconstruct(Scrambled(shape), table);
  random->Update();
  const auto notANumber = Reconstruct(Scrambled(shape, true), table);
  const auto log = vtktest::Observe(notANumber);
  notANumber->Update();
  vtktest::ExpectQuiet(*log);
  EXPECT_EQ(vtktest::PointsOf(notANumber->GetOutput()), vtktest::PointsOf(random->GetOutput()));
  EXPECT_LT(
    DistanceUpToRigidMotion(vtktest::PointsOf(random->GetOutput()), shape.Positions), 1e-10);
}

TEST(FrameReconstructionFilter, DoesNotDependOnTheOrderOfRowsOrTriangles)
{
  const Shape shape = shapes::Noisy(shapes::OpenCylinder(9, 6), 0.05);
  const auto table = FormsTable(MakePolyData(shape));
  Shape other = shape;
  for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
  {
    for (int c = 0; c < 3; ++c)
    {
      other.Faces(shape.Faces.rows() - 1 - t, c) = shape.Faces(t, (c + static_cast<int>(t)) % 3);
    }
  }
  for (const auto& connectivity : { Scrambled(shape), Scrambled(other) })
  {
    const auto filter = Reconstruct(connectivity, Shuffled(table));
    const auto log = vtktest::Observe(filter);
    filter->Update();
    vtktest::ExpectQuiet(*log);
    EXPECT_LT(
      DistanceUpToRigidMotion(vtktest::PointsOf(filter->GetOutput()), shape.Positions), 1e-12);
  }
}

TEST(FrameReconstructionFilter, PutsTheSeedWhereItIsAsked)
{
  const Shape shape = shapes::Noisy(shapes::Icosphere(2), 0.05);
  const auto withFrames = WithFrames(shape);
  const auto table = FormsTable(withFrames);
  const shapes::RigidMotion motion = shapes::RandomRigidMotion(6, 10.0);
  constexpr vtkIdType Seed = 77;
  double frame[9];
  for (int k = 0; k < 3; ++k)
  {
    const char* const names[3] = { "FrameTangent1", "FrameTangent2", "FrameNormal" };
    Eigen::Vector3d vector;
    withFrames->GetPointData()->GetArray(names[k])->GetTuple(Seed, vector.data());
    Eigen::Map<Eigen::Vector3d>(frame + 3 * k) = motion.Rotation * vector;
  }
  const cartan::Points expected = motion(shape.Positions);
  const auto filter = Reconstruct(Scrambled(shape), table);
  filter->SetSeedPoint(Seed);
  filter->SetSeedPosition(expected(Seed, 0), expected(Seed, 1), expected(Seed, 2));
  filter->SetSeedFrame(frame);
  for (const int method :
    { vtkFrameReconstruction::PROCRUSTES, vtkFrameReconstruction::ORIENTATION_BITS })
  {
    for (const bool project : { true, false })
    {
      filter->SetTransitionMethod(method);
      filter->SetProjectFrames(project);
      filter->Update();
      const cartan::Points points = vtktest::PointsOf(filter->GetOutput());
      EXPECT_EQ(points.row(Seed), expected.row(Seed));
      EXPECT_LT((points - expected).norm(), 1e-10);
      // The frames of the output turn along.
      for (const char* name : { "FrameTangent1", "FrameTangent2", "FrameNormal" })
      {
        for (vtkIdType v = 0; v < shape.NumberOfVertices(); ++v)
        {
          Eigen::Vector3d before;
          Eigen::Vector3d after;
          withFrames->GetPointData()->GetArray(name)->GetTuple(v, before.data());
          filter->GetOutput()->GetPointData()->GetArray(name)->GetTuple(v, after.data());
          ASSERT_LT((after - motion.Rotation * before).norm(), 1e-11);
        }
      }
    }
  }
}

TEST(FrameReconstructionFilter, HoldsWhatTheConstraintArraySelects)
{
  // Two components, each held in one place by the input's points and frames.
  const Shape first = shapes::Noisy(shapes::Icosphere(1), 0.05);
  Shape second = shapes::Noisy(shapes::OpenCylinder(6, 4), 0.05);
  second.Positions.rowwise() += Eigen::RowVector3d(5, 0, 0);
  const Shape shape = shapes::Union(first, second);
  const auto input = WithFrames(shape);
  const auto table = FormsTable(input);
  const int held = first.NumberOfVertices() + 3;
  for (vtkIdType v = 0; v < input->GetNumberOfPoints(); ++v)
  {
    if (v != 7 && v != held)
    {
      input->GetPoints()->SetPoint(v, NaN, 0, 0);
    }
  }
  vtktest::AddArray(input, "Held", 1,
    [held](vtkIdType v, double* value) { *value = v == 7 || v == held ? 1.0 : 0.0; });
  const auto filter = Reconstruct(input, table);
  const auto log = vtktest::Observe(filter);
  filter->SetConstraintArrayName("Held");
  filter->Update();
  vtktest::ExpectQuiet(*log);
  EXPECT_LT((vtktest::PointsOf(filter->GetOutput()) - shape.Positions).norm(), 1e-11);
}

TEST(FrameReconstructionFilter, SeedsEachComponentAndWarnsThatTheyArePiledUp)
{
  const Shape part = shapes::Noisy(shapes::Icosphere(1), 0.05);
  Shape moved = part;
  moved.Positions.rowwise() += Eigen::RowVector3d(5, 0, 0);
  const Shape shape = shapes::Union(part, moved);
  const auto filter = Reconstruct(Scrambled(shape), FormsTable(MakePolyData(shape)));
  const auto log = vtktest::Observe(filter);
  filter->SetSeedPosition(1, 2, 3);
  filter->Update();
  EXPECT_TRUE(log->Errors.empty());
  vtktest::ExpectMessage(log->Warnings,
    { "1 further component (id 1)", "without a seed of their own", "constraint array" });
  const cartan::Points points = vtktest::PointsOf(filter->GetOutput());
  const int half = part.NumberOfVertices();
  EXPECT_EQ(points.row(0), Eigen::RowVector3d(1, 2, 3));
  EXPECT_LT((points.topRows(half) - points.bottomRows(half)).norm(), 1e-12);
  EXPECT_LT(DistanceUpToRigidMotion(points.topRows(half), part.Positions), 1e-12);
}

TEST(FrameReconstructionFilter, KeepsDigitsForSeedsFarAwayAndSurfacesOfAnySize)
{
  for (const double unit : { 1e-9, 1.0, 1e6 })
  {
    Shape shape = shapes::Noisy(shapes::Icosphere(2), 0.02);
    shape.Positions *= unit;
    const auto filter = Reconstruct(Scrambled(shape), FormsTable(MakePolyData(shape)));
    filter->Update();
    EXPECT_LT(
      DistanceUpToRigidMotion(vtktest::PointsOf(filter->GetOutput()), shape.Positions), 1e-12);
    filter->SetSeedPosition(1e6 * unit, -1e6 * unit, 0);
    filter->Update();
    EXPECT_LT(
      DistanceUpToRigidMotion(vtktest::PointsOf(filter->GetOutput()), shape.Positions), 1e-9);
  }
}

TEST(FrameReconstructionFilter, KeepsCellsAttributesAndUnusedPoints)
{
  Shape shape = shapes::Icosphere(1);
  const auto table = FormsTable(MakePolyData(shape));
  shape.Positions.conservativeResize(44, 3);
  shape.Positions.bottomRows(2).setConstant(7.5);
  const auto input = MakePolyData(shape, VTK_FLOAT);
  vtktest::AddArray(input, "Values", 1, [](vtkIdType v, double* value) { *value = v; });
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell({ 0, 43 });
  input->SetLines(lines);
  const auto copy = vtktest::CopyOf(input);
  const auto filter = Reconstruct(input, table);
  filter->Update();
  vtktest::ExpectSameSurface(input, copy);
  vtkPolyData* output = filter->GetOutput();
  vtktest::ExpectSameCells(output, input);
  vtktest::ExpectArrays(output->GetPointData(), input->GetPointData(), false);
  EXPECT_EQ(output->GetPoints()->GetDataType(), VTK_DOUBLE);
  EXPECT_EQ(vtktest::PointsOf(output).bottomRows(2), shape.Positions.bottomRows(2));
  for (const char* name : { "FrameTangent1", "FrameTangent2", "FrameNormal" })
  {
    EXPECT_NE(output->GetPointData()->GetArray(name), nullptr);
  }
}

TEST(FrameReconstructionFilter, FitsFormsThatWereChanged)
{
  // Lengths and heights of a sphere scaled by 2: a sphere of twice the radius.
  const Shape shape = shapes::Icosphere(2);
  const auto table = FormsTable(MakePolyData(shape));
  for (vtkIdType r = 0; r < table->GetNumberOfRows(); ++r)
  {
    for (const char* column : { "Length", "Height" })
    {
      table->SetValueByName(r, column, 2.0 * table->GetValueByName(r, column).ToDouble());
    }
  }
  const auto filter = Reconstruct(Scrambled(shape), table);
  filter->Update();
  EXPECT_LT(
    DistanceUpToRigidMotion(vtktest::PointsOf(filter->GetOutput()), 2.0 * shape.Positions), 1e-12);

  // Forms that fit together nowhere still give numbers, near the surface.
  shapes::Random random(3);
  for (vtkIdType r = 0; r < table->GetNumberOfRows(); ++r)
  {
    table->SetValueByName(
      r, "Angle", table->GetValueByName(r, "Angle").ToDouble() + 0.01 * random());
  }
  filter->SetFormsData(table);
  table->Modified();
  filter->Modified();
  filter->Update();
  const cartan::Points points = vtktest::PointsOf(filter->GetOutput());
  EXPECT_TRUE(points.allFinite());
  EXPECT_LT(DistanceUpToRigidMotion(points, 2.0 * shape.Positions), 0.1);
}

//------------------------------------------------------------------------------
TEST(FrameReconstructionFilter, RefusesBadConnectivity)
{
  const Shape shape = shapes::Icosphere(1);
  const auto good = Scrambled(shape);
  const auto filter = Reconstruct(good, FormsTable(MakePolyData(shape)));
  const auto log = vtktest::Observe(filter);
  for (const vtktest::BadSurface& bad : vtktest::BadSurfaces())
  {
    if (bad.Name != "NaN") // coordinates are not looked at
    {
      SCOPED_TRACE(bad.Name);
      vtktest::ExpectRefused(filter, log, bad.Surface, bad.Parts, good);
    }
  }
  auto quads = Scrambled(shape);
  quads->GetPolys()->InsertNextCell({ 0, 1, 2, 3 });
  vtktest::ExpectRefused(
    filter, log, quads, { "1 cell (id 80)", "not triangles", "triangulate" }, good);
  vtktest::ExpectRefused(filter, log, Scrambled(shapes::Icosphere(2)),
    { "240 rows", "960 directed edges", "different surfaces" }, good);
}

TEST(FrameReconstructionFilter, RefusesBadTables)
{
  const Shape shape = shapes::Icosphere(1);
  const auto good = FormsTable(MakePolyData(shape));
  const auto filter = Reconstruct(Scrambled(shape), good);
  const auto log = vtktest::Observe(filter);
  const auto copyOfGood = [&good]()
  {
    auto table = vtkSmartPointer<vtkTable>::New();
    table->DeepCopy(good);
    return table;
  };
  const auto expectRefused = [&](vtkTable* bad, const std::vector<std::string>& parts)
  {
    log->Clear();
    filter->SetFormsData(bad);
    filter->Update();
    vtktest::ExpectMessage(log->Errors, parts);
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
    log->Clear();
    filter->SetFormsData(good);
    filter->Update();
    vtktest::ExpectQuiet(*log);
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 42);
  };

  expectRefused(vtkSmartPointer<vtkTable>::New(), { "\"Vertex\"", "Discrete Forms" });
  for (const char* name : { "Vertex", "Neighbor", "Length", "Angle", "Height", "Orientation" })
  {
    const auto missing = copyOfGood();
    missing->RemoveColumnByName(name);
    expectRefused(missing, { std::string("no numeric column \"") + name + "\"" });
    const auto text = copyOfGood();
    text->RemoveColumnByName(name);
    vtkNew<vtkStringArray> words;
    words->SetName(name);
    words->SetNumberOfValues(good->GetNumberOfRows());
    text->AddColumn(words);
    expectRefused(text, { std::string("no numeric column \"") + name + "\"" });
  }
  const auto doubled = copyOfGood();
  for (const char* name : { "Vertex", "Neighbor" })
  {
    doubled->SetValueByName(5, name, doubled->GetValueByName(4, name));
  }
  expectRefused(doubled, { "1 row (id 5)", "not an edge of the connectivity" });
  for (const double value : { -1.0, 42.0, NaN, 1e300, 0.5 })
  {
    const auto foreign = copyOfGood();
    foreign->RemoveColumnByName("Neighbor");
    vtkNew<vtkDoubleArray> neighbors;
    neighbors->SetName("Neighbor");
    for (vtkIdType r = 0; r < good->GetNumberOfRows(); ++r)
    {
      neighbors->InsertNextValue(good->GetValueByName(r, "Neighbor").ToDouble());
    }
    neighbors->SetValue(9, value);
    foreign->AddColumn(neighbors);
    SCOPED_TRACE(value);
    expectRefused(foreign, { "row", "not an edge of the connectivity" });
  }
  for (const auto& [name, value] :
    std::vector<std::pair<const char*, double>>{ { "Length", -1.0 }, { "Length", NaN },
      { "Height", std::numeric_limits<double>::infinity() }, { "Angle", NaN } })
  {
    const auto bad = copyOfGood();
    bad->SetValueByName(11, name, value);
    bad->SetValueByName(3, name, value);
    expectRefused(bad, { "2 rows", "negative length", "not finite" });
  }
}

TEST(FrameReconstructionFilter, RefusesBadSeedsAndConstraints)
{
  Shape shape = shapes::Icosphere(1);
  const auto table = FormsTable(MakePolyData(shape));
  shape.Positions.conservativeResize(43, 3);
  shape.Positions.row(42).setZero();
  const auto filter = Reconstruct(Scrambled(shape), table);
  const auto log = vtktest::Observe(filter);
  const auto expectRefused = [&](const std::vector<std::string>& parts)
  {
    log->Clear();
    filter->Update();
    vtktest::ExpectMessage(log->Errors, parts);
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  };
  for (const vtkIdType seed : { 42, 43, 1000000 })
  {
    filter->SetSeedPoint(seed);
    expectRefused({ "seed point " + std::to_string(seed), "in no triangle", "-1" });
  }
  filter->SetSeedPoint(41);
  filter->SetSeedPosition(NaN, 0, 0);
  expectRefused({ "seed's position is not finite" });
  filter->SetSeedPosition(0, 0, 0);
  filter->SetSeedFrame(1, 0, 0, 0, 1, 0, 0, 0, -1); // left-handed
  expectRefused({ "not orthonormal and right-handed" });
  filter->SetSeedFrame(1, 0, 0, 0, 1, 0, 0, 0, 1.001);
  expectRefused({ "not orthonormal" });
  filter->SetSeedFrame(0, 1, 0, 0, 0, 1, 1, 0, 0);
  filter->SetConstraintArrayName("Held");
  expectRefused({ "no numeric point array \"Held\"" });

  auto held = Scrambled(shape);
  vtktest::AddArray(held, "Held", 1, [](vtkIdType v, double* value) { *value = v == 3; });
  filter->SetInputData(held);
  expectRefused({ "no numeric point array \"FrameTangent1\"" });
  for (const char* name : { "FrameTangent1", "FrameTangent2", "FrameNormal" })
  {
    vtktest::AddArray(
      held, name, 3, [](vtkIdType, double* value) { value[0] = value[1] = value[2] = 0.5; });
  }
  filter->Modified();
  expectRefused({ "1 point (id 3)", "not orthonormal and right-handed" });

  filter->SetConstraintArrayName("");
  log->Clear();
  filter->Update();
  vtktest::ExpectQuiet(*log);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 43);
}

TEST(FrameReconstructionFilter, TakesBlocksOfSurfacesButNotOfTables)
{
  const Shape shape = shapes::Icosphere(1);
  vtkNew<vtkMultiBlockDataSet> surfaces;
  surfaces->SetBlock(0, Scrambled(shape));
  vtkNew<vtkFrameReconstruction> filter;
  const auto log = vtktest::Observe(filter);
  vtkNew<vtktest::Log> executiveLog;
  filter->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, executiveLog);
  filter->SetInputDataObject(0, surfaces);
  filter->SetFormsData(FormsTable(MakePolyData(shape)));
  filter->Update();
  vtktest::ExpectQuiet(*log);
  auto* output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_NE(output, nullptr);
  EXPECT_EQ(vtkPolyData::SafeDownCast(output->GetBlock(0))->GetNumberOfPoints(), 42);

  // The executive takes one composite input apart, not two.
  vtkNew<vtkMultiBlockDataSet> tables;
  tables->SetBlock(0, FormsTable(MakePolyData(shape)));
  filter->SetInputDataObject(1, tables);
  filter->Update();
  EXPECT_FALSE(log->Errors.empty() && executiveLog->Errors.empty());
}

TEST(FrameReconstructionFilter, RunsAgainOnlyWhenSomethingChangesAndStopsWhenAborted)
{
  const Shape shape = shapes::Icosphere(2);
  const auto filter = Reconstruct(Scrambled(shape), FormsTable(MakePolyData(shape)));
  const auto log = vtktest::Observe(filter);
  vtkNew<vtktest::ProgressLog> progress;
  filter->AddObserver(vtkCommand::ProgressEvent, progress);
  filter->Update();
  const std::size_t reports = progress->Fractions.size();
  EXPECT_GT(reports, 6u);
  EXPECT_TRUE(std::is_sorted(progress->Fractions.begin(), progress->Fractions.end()));
  filter->Update();
  filter->SetSeedPoint(-1);
  filter->SetSeedPosition(0, 0, 0);
  filter->SetConstraintArrayName("");
  filter->Update();
  EXPECT_EQ(progress->Fractions.size(), reports);
  const std::vector<std::function<void()>> changes = { [&]() { filter->SetSeedPoint(3); },
    [&]() { filter->SetSeedPosition(1, 2, 3); },
    [&]() { filter->SetSeedFrame(0, 1, 0, 0, 0, 1, 1, 0, 0); },
    [&]() { filter->SetTransitionMethodToOrientationBits(); },
    [&]() { filter->ProjectFramesOff(); } };
  for (const auto& change : changes)
  {
    progress->Fractions.clear();
    change();
    filter->Update();
    EXPECT_FALSE(progress->Fractions.empty());
  }
  for (std::size_t stop = 2; stop < reports; ++stop)
  {
    progress->Fractions.clear();
    progress->AbortAt = static_cast<int>(stop);
    filter->SetAbortExecute(0); // VTK does not take an abort back by itself
    filter->Modified();
    filter->Update();
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0) << stop;
  }
  progress->AbortAt = 0;
  filter->SetAbortExecute(0);
  filter->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 162);
  vtktest::ExpectQuiet(*log);
}
