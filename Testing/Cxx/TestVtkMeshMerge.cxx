// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshMerge.h"

#include "Advice.h"
#include "MergeShapes.h"

#include "vtkBoundaryLoops.h"

#include "vtkClipPolyData.h"
#include "vtkIdTypeArray.h"
#include "vtkLinearSubdivisionFilter.h"
#include "vtkPlane.h"
#include "vtkPolyDataConnectivityFilter.h"

namespace
{
using vtktest::Advice;
using vtktest::ExpectMessage;
using vtktest::ExpectQuiet;
using vtktest::MakePolyData;
using vtktest::PointsOf;

/// The array BoundaryKey, `keys` as points and numbers.
void SetKeys(vtkPolyData* surface, const std::vector<std::pair<vtkIdType, int>>& keys)
{
  vtkNew<vtkIntArray> array;
  array->SetName("BoundaryKey");
  array->SetNumberOfValues(surface->GetNumberOfPoints());
  array->Fill(0.0);
  for (const auto& [point, key] : keys)
  {
    array->SetValue(point, key);
  }
  surface->GetPointData()->AddArray(array);
}

shapes::Shape Shifted(shapes::Shape shape, double z)
{
  shape.Positions.col(2).array() += z;
  return shape;
}

/// A target whose upper loop has 16 points, and a source whose lower loop has 12.
class MeshMergeFilter : public testing::Test
{
protected:
  static constexpr int Around = 16;

  void SetUp() override
  {
    this->Target = MakePolyData(shapes::OpenCylinder(Around, 6, 1.0, 2.0));
    this->Source = MakePolyData(Shifted(shapes::OpenCylinder(12, 5, 0.8, 2.0), 2.5));
    this->LastRing = this->Target->GetNumberOfPoints() - Around;
    SetKeys(this->Target, { { this->LastRing, 1 }, { this->LastRing + 8, 2 } });
    SetKeys(this->Source, { { 0, 1 }, { 6, 2 } });
    this->Log = vtktest::Observe(this->Filter);
    this->Connect();
  }

  void Connect()
  {
    this->Filter->SetInputData(this->Target);
    this->Filter->SetSourceData(this->Source);
  }

  vtkPolyData* Output()
  {
    this->Log->Clear();
    this->Filter->Update();
    return this->Filter->GetOutput();
  }

  void ExpectError(const std::vector<std::string>& parts)
  {
    EXPECT_EQ(this->Output()->GetNumberOfPoints(), 0);
    EXPECT_EQ(this->Filter->GetCorrespondences()->GetNumberOfPoints(), 0);
    ExpectMessage(this->Log->Errors, parts);
  }

  /// Sewn, without a word, with so many boundary loops left.
  void ExpectSewn(int loops)
  {
    vtkPolyData* output = this->Output();
    ExpectQuiet(*this->Log);
    ASSERT_GT(output->GetNumberOfCells(), 0);
    vtkNew<vtkBoundaryLoops> boundary;
    boundary->SetInputData(output);
    boundary->Update();
    EXPECT_EQ(boundary->GetNumberOfLoops(), loops);
  }

  vtkSmartPointer<vtkPolyData> Target;
  vtkSmartPointer<vtkPolyData> Source;
  vtkIdType LastRing = 0;
  vtkNew<vtkMeshMerge> Filter;
  vtkSmartPointer<vtktest::Log> Log;
};
}

TEST(BoundaryLoopsFilter, WritesALinePerLoop)
{
  auto tube = MakePolyData(shapes::OpenCylinder(10, 4, 2.0, 3.0), VTK_FLOAT);
  vtktest::AddArray(
    tube, "Height", 1, [&](vtkIdType v, double* value) { *value = tube->GetPoint(v)[2]; });
  vtkNew<vtkBoundaryLoops> filter;
  const auto log = vtktest::Observe(filter);
  filter->SetInputData(tube);
  filter->Update();
  ExpectQuiet(*log);
  vtkPolyData* output = filter->GetOutput();
  ASSERT_EQ(filter->GetNumberOfLoops(), 2);
  ASSERT_EQ(output->GetNumberOfLines(), 2);
  ASSERT_EQ(output->GetNumberOfPoints(), 20);
  EXPECT_EQ(output->GetPoints()->GetDataType(), VTK_FLOAT);
  vtkCellData* cells = output->GetCellData();
  for (vtkIdType loop = 0; loop < 2; ++loop)
  {
    vtkNew<vtkIdList> line;
    output->GetCellPoints(loop, line);
    ASSERT_EQ(line->GetNumberOfIds(), 11);
    EXPECT_EQ(line->GetId(0), line->GetId(10));
    EXPECT_EQ(cells->GetArray("Loop")->GetTuple1(loop), loop + 1.0);
    EXPECT_EQ(cells->GetArray("NumberOfPoints")->GetTuple1(loop), 10.0);
    EXPECT_EQ(cells->GetArray("Component")->GetTuple1(loop), 0.0);
    EXPECT_NEAR(cells->GetArray("Length")->GetTuple1(loop), 40 * std::sin(0.1 * shapes::Pi), 1e-5);
    EXPECT_NEAR(cells->GetArray("Area")->GetTuple1(loop), 20 * std::sin(0.2 * shapes::Pi), 1e-5);
    // Out of the tube, as the normal of a lid.
    EXPECT_NEAR(cells->GetArray("Normal")->GetComponent(loop, 2), loop ? 1.0 : -1.0, 1e-6);
    EXPECT_NEAR(cells->GetArray("Center")->GetComponent(loop, 2), loop ? 3.0 : 0.0, 1e-6);
  }
  auto* ids = vtkIdTypeArray::SafeDownCast(output->GetPointData()->GetArray("OriginalPointIds"));
  for (vtkIdType i = 0; i < 20; ++i)
  {
    EXPECT_EQ((PointsOf(output).row(i) - PointsOf(tube).row(ids->GetValue(i))).norm(), 0.0);
    EXPECT_EQ(output->GetPointData()->GetArray("Height")->GetTuple1(i), output->GetPoint(i)[2]);
  }
  filter->SetInputData(MakePolyData(shapes::Icosphere(1)));
  filter->Update();
  ExpectQuiet(*log);
  EXPECT_EQ(filter->GetNumberOfLoops(), 0);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0);
}

TEST_F(MeshMergeFilter, WritesOneSurfaceWithItsOrigins)
{
  for (vtkPolyData* surface : { this->Target.Get(), this->Source.Get() })
  {
    const double value = surface == this->Target ? 1.0 : 2.0;
    vtktest::AddArray(surface, "Both", 1, [=](vtkIdType v, double* x) { *x = value + 10.0 * v; });
    auto normals = vtktest::AddArray(
      surface, "Normals", 3, [](vtkIdType, double* n) { n[0] = 1.0, n[1] = n[2] = 0.0; });
    surface->GetPointData()->SetNormals(normals);
  }
  vtktest::AddArray(this->Target, "OfTarget", 1, [](vtkIdType, double* x) { *x = 1.0; });
  this->ExpectSewn(2);
  vtkPolyData* output = this->Output();
  vtkPointData* data = output->GetPointData();
  EXPECT_EQ(data->GetArray("OfTarget"), nullptr);
  vtkDataArray* origins = data->GetArray("MergeOrigin");
  vtkDataArray* ids = data->GetArray("OriginalPointIds");
  int seam = 0;
  for (vtkIdType v = 0; v < output->GetNumberOfPoints(); ++v)
  {
    const auto origin = static_cast<int>(origins->GetTuple1(v));
    const auto id = static_cast<vtkIdType>(ids->GetTuple1(v));
    const double both = data->GetArray("Both")->GetTuple1(v);
    seam += origin == 2;
    if (v < this->Target->GetNumberOfPoints())
    {
      EXPECT_EQ(id, v);
      EXPECT_EQ(both, 1.0 + 10.0 * v);
      EXPECT_EQ((PointsOf(output).row(v) - PointsOf(this->Target).row(v)).norm(), 0.0);
    }
    else
    {
      EXPECT_NE(origin, 0);
      EXPECT_EQ(both, 2.0 + 10.0 * id);
    }
    const Eigen::Vector3d normal(data->GetNormals()->GetTuple3(v));
    EXPECT_NEAR(normal.norm(), 1.0, 1e-12);
    EXPECT_GT(normal.head<2>().dot(Eigen::Vector3d(output->GetPoint(v)).head<2>()), 0.0);
  }
  EXPECT_GE(seam, Around);
  vtkDataArray* cellOrigins = output->GetCellData()->GetArray("MergeOrigin");
  vtkDataArray* cellIds = output->GetCellData()->GetArray("OriginalCellIds");
  for (vtkIdType c = 0; c < output->GetNumberOfCells(); ++c)
  {
    const bool isSources = cellOrigins->GetTuple1(c) == 1.0;
    EXPECT_LT(cellIds->GetTuple1(c), (isSources ? this->Source : this->Target)->GetNumberOfCells());
  }
  EXPECT_EQ(this->Filter->GetNumberOfPairs(), 1);
  EXPECT_EQ(output->GetFieldData()->GetArray("SeamAngleMean")->GetTuple1(0),
    this->Filter->GetSeamAngleMean());
  EXPECT_GE(this->Filter->GetSeamAngleMaximum(), this->Filter->GetSeamAngleMean());
  EXPECT_LT(this->Filter->GetSeamAngleMaximum(), 30.0);

  // Two loops, a line for each point of the source's, two of them keys.
  vtkPolyData* lines = this->Filter->GetCorrespondences();
  ASSERT_EQ(lines->GetNumberOfLines(), 2 + 12);
  int keys = 0;
  for (vtkIdType line = 2; line < lines->GetNumberOfLines(); ++line)
  {
    keys += lines->GetCellData()->GetArray("Kind")->GetTuple1(line) == 3.0;
    vtkNew<vtkIdList> points;
    lines->GetCellPoints(line, points);
    EXPECT_NEAR(lines->GetPoint(points->GetId(0))[2], 2.5, 1e-12);
    EXPECT_NEAR(lines->GetPoint(points->GetId(1))[2], 2.0, 1e-12);
  }
  EXPECT_EQ(keys, 2);
}

TEST_F(MeshMergeFilter, AMovedKeyFactorizesNothing)
{
  const cartan::Points before = PointsOf(this->Output());
  const int factorizations = this->Filter->GetNumberOfFactorizations();
  EXPECT_GT(factorizations, 0);
  const double kept = this->Filter->GetKeptMemory();
  SetKeys(this->Target, { { this->LastRing + 1, 1 }, { this->LastRing + 9, 2 } });
  const cartan::Points after = PointsOf(this->Output());
  ExpectQuiet(*this->Log);
  EXPECT_GT((after.bottomRows(12) - before.bottomRows(12)).norm(), 0.1);
  EXPECT_EQ(this->Filter->GetKeptMemory(), kept);
  EXPECT_EQ(this->Filter->GetNumberOfFactorizations(), factorizations);
}

TEST_F(MeshMergeFilter, WithoutKeysOneLoopEachNeedsNothing)
{
  this->Target = MakePolyData(shapes::Plane(7));
  this->Source = MakePolyData(shapes::Noisy(shapes::Plane(9, 3.0), 0.01));
  this->Connect();
  this->ExpectSewn(0);
}

TEST_F(MeshMergeFilter, HoldsHandlesAndWhatIsFarFromTheSeam)
{
  vtktest::AddHandles(this->Source, [](const Eigen::Vector3d& p) { return p[2] > 4.2 ? 3 : 0; });
  this->Filter->SetConfigurationToDependent();
  const auto expectHeld = [&](double from)
  {
    const cartan::Points after = PointsOf(this->Output());
    ExpectQuiet(*this->Log);
    const cartan::Points before = PointsOf(this->Source);
    vtkDataArray* ids = this->Filter->GetOutput()->GetPointData()->GetArray("OriginalPointIds");
    int held = 0;
    for (vtkIdType v = this->Target->GetNumberOfPoints(); v < after.rows(); ++v)
    {
      const auto id = static_cast<vtkIdType>(ids->GetTuple1(v));
      if (before(id, 2) > from)
      {
        EXPECT_LT((after.row(v) - before.row(id)).norm(), 1e-14);
        ++held;
      }
      else
      {
        EXPECT_GT((after.row(v) - before.row(id)).norm(), 1e-3);
      }
    }
    EXPECT_GT(held, 0);
  };
  expectHeld(4.2);
  this->Filter->SetBendWidth(1.1); // two of four bands of triangles
  expectHeld(3.6);
}

TEST_F(MeshMergeFilter, FairingSmoothsTheSeam)
{
  this->Target = MakePolyData(shapes::MergeMesh("tubes-target"));
  this->Source = MakePolyData(shapes::MergeMesh("tubes-source"));
  SetKeys(this->Target, { { 25, 1 }, { 233, 2 }, { 415, 3 }, { 623, 4 } });
  SetKeys(this->Source, { { 0, 1 }, { 410, 2 }, { 820, 3 }, { 1230, 4 } });
  this->Connect();
  this->Output();
  const double folded = this->Filter->GetSeamAngleMean();
  this->Filter->SetSeamFairing(2);
  this->ExpectSewn(2);
  EXPECT_LT(this->Filter->GetSeamAngleMean(), 0.8 * folded);
  const cartan::Points smooth = PointsOf(this->Output());
  this->Filter->SetFairingMethodToDeltaBlend();
  this->ExpectSewn(2);
  EXPECT_LT(this->Filter->GetSeamAngleMean(), 0.8 * folded);
  EXPECT_GT((PointsOf(this->Filter->GetOutput()) - smooth).rowwise().norm().maxCoeff(), 1e-3);
}

TEST_F(MeshMergeFilter, SaysWhichLoopsItPairs)
{
  this->Target = MakePolyData(shapes::OpenCylinder(Around, 6, 1.0, 2.0));
  // A band around the target, from its one end to the other.
  shapes::Shape band = shapes::Inverted(shapes::OpenCylinder(12, 7, 1.0, 2.0));
  for (int v = 0; v < band.NumberOfVertices(); ++v)
  {
    const double z = band.Positions(v, 2);
    band.Positions.row(v).head<2>() *= 1.2 + z * (2.0 - z);
  }
  this->Source = MakePolyData(band);
  this->Connect();
  EXPECT_GT(this->Output()->GetNumberOfPoints(), 0);
  ExpectMessage(this->Log->Warnings,
    { "that of point 0 (12 points)", "that of point 96 (16 points)",
      Advice("Give them boundary keys to pair them otherwise.") });
  SetKeys(this->Target, { { 0, 1 }, { this->LastRing, 2 } });
  SetKeys(this->Source, { { 0, 1 }, { this->Source->GetNumberOfPoints() - 12, 2 } });
  this->ExpectSewn(0);
  EXPECT_EQ(this->Filter->GetNumberOfPairs(), 2);
}

TEST_F(MeshMergeFilter, RefusesAClosedSurface)
{
  this->Source = MakePolyData(shapes::Icosphere(2));
  SetKeys(this->Source, {});
  this->Connect();
  this->ExpectError({ "The source has no boundary",
    Advice("Cut it open where it is to be merged, for example with Clip.") });
  vtkNew<vtkPlane> plane;
  plane->SetNormal(0, 0, 1);
  plane->SetOrigin(0, 0, 0.1);
  vtkNew<vtkClipPolyData> clip;
  clip->SetInputData(MakePolyData(shapes::Icosphere(2)));
  clip->SetClipFunction(plane);
  this->Filter->SetSourceConnection(clip->GetOutputPort());
  this->Target = MakePolyData(shapes::Plane(7));
  this->Filter->SetInputData(this->Target);
  this->ExpectSewn(0);
}

TEST_F(MeshMergeFilter, RefusesKeysThatMakeNoPair)
{
  SetKeys(this->Source, { { 0, 1 }, { 12, 2 } });
  this->ExpectError({ "1 point (id 12) of the source",
    Advice("are not on its boundary: move them to boundary points, or set them to 0.") });
  SetKeys(this->Source, { { 0, 1 }, { 6, 1 } });
  this->ExpectError({ "1 point (id 6) of the source",
    Advice("are there already at other points: give each point a number of its own.") });
  SetKeys(this->Source, { { 0, 1 }, { 6, 3 } });
  this->ExpectError({ "2 keys (ids 2, 3)",
    Advice("give the point where it belongs on the other the same number, or set them to 0.") });
  SetKeys(this->Source, { { 0, 1 }, { this->Source->GetNumberOfPoints() - 12, 2 } });
  this->ExpectError({ "The boundary key 2", "keys of one loop go to one loop." });
  SetKeys(this->Source, { { 0, 1 }, { 6, 2 } });
  this->ExpectSewn(2);
}

TEST_F(MeshMergeFilter, AsksWhichLoopsBelongTogether)
{
  SetKeys(this->Source, {});
  SetKeys(this->Target, {});
  this->Source = MakePolyData(shapes::Plane(5));
  this->Connect();
  const std::string advice = Advice("equal numbers from 1 in the boundary key array.");
  this->ExpectError({ "The target has 2 boundary loops and the source 1 boundary loop", advice });
  SetKeys(this->Source, { { 0, 1 } });
  SetKeys(this->Target, { { this->LastRing, 1 } });
  this->ExpectSewn(1);

  shapes::Shape many = shapes::Plane(4);
  for (int i = 1; i < 7; ++i)
  {
    many = shapes::Union(many, Shifted(shapes::Plane(4), i));
  }
  this->Source = MakePolyData(many);
  this->Target = MakePolyData(shapes::Inverted(many));
  this->Connect();
  this->ExpectError({ "Both surfaces have 7 boundary loops",
    Advice("). Give a point of each loop, and the point where it belongs on the other surface") });
  std::vector<std::pair<vtkIdType, int>> keys;
  for (int i = 0; i < 7; ++i)
  {
    keys.emplace_back(i * many.NumberOfVertices() / 7 + 1, i + 1);
  }
  SetKeys(this->Source, keys);
  for (auto& [point, key] : keys)
  {
    ++point; // so that no two corners meet
  }
  SetKeys(this->Target, keys);
  this->Output();
  EXPECT_TRUE(this->Log->Errors.empty() ||
    this->Log->Errors[0].find("cut the same corner") != std::string::npos);
}

TEST_F(MeshMergeFilter, RefusesPartsWithoutAPlace)
{
  const shapes::Shape part = shapes::OpenCylinder(12, 5, 0.8, 2.0);
  this->Source = MakePolyData(shapes::Union(part, Shifted(shapes::Icosphere(1), 9.0)));
  SetKeys(this->Source, { { 0, 1 }, { 6, 2 } });
  this->Connect();
  this->ExpectError({ "1 point (id 72)",
    Advice("Give their boundaries keys, hold them (DEPENDENT), or remove them (Connectivity).") });
  vtkNew<vtkPolyDataConnectivityFilter> largest;
  largest->SetExtractionModeToLargestRegion();
  largest->SetInputData(this->Source);
  this->Filter->SetSourceConnection(largest->GetOutputPort());
  this->ExpectSewn(2);
}

TEST_F(MeshMergeFilter, NeedsSomethingHeldForAPlaceThatCounts)
{
  this->Filter->SetConfigurationToDependent();
  this->ExpectError({ Advice("mark handles on it (Mark Handle), set a BendWidth smaller than the "
                             "source, or choose INDEPENDENT.") });
  this->Filter->SetBendWidth(0.6);
  this->ExpectSewn(2);
  this->Filter->SetBendWidth(0.0);
  this->Filter->SetConfigurationToIndependent();
  this->ExpectSewn(2);
  vtktest::AddHandles(this->Source, [](const Eigen::Vector3d& p) { return p[2] > 4.2 ? 1 : 0; });
  this->Filter->SetConfigurationToDependent();
  this->ExpectSewn(2);
  vtktest::AddHandles(this->Source, [](const Eigen::Vector3d& p) { return p[2] < 3.2 ? 1 : 0; });
  this->ExpectError(
    { "12 points (ids 0, 1, 2, 3, 4, ...)", "cannot be held and sewn on: unmark the boundary." });
}

TEST_F(MeshMergeFilter, RefusesABoundaryWithoutDirection)
{
  this->Source->GetPoints()->SetPoint(3, this->Source->GetPoint(1)); // around 2
  this->Source->GetPoints()->Modified();
  this->ExpectError(
    { "1 point (id 2) of the source", Advice("Move these points apart, or set other keys.") });
  this->Source->GetPoints()->SetPoint(3, 0.0, 0.8, 2.5);
  this->Source->GetPoints()->Modified();
  this->ExpectSewn(2);
}

TEST_F(MeshMergeFilter, RefusesALoopWithoutLength)
{
  for (vtkIdType v = 0; v < 12; ++v)
  {
    this->Source->GetPoints()->SetPoint(v, 0.0, 0.0, 2.5);
  }
  this->Source->GetPoints()->Modified();
  EXPECT_EQ(this->Output()->GetNumberOfPoints(), 0);
  ExpectMessage(this->Log->Errors,
    { Advice("Merge these points (Prepare Surface), which closes it, and sew another loop.") });
  vtkNew<vtkPrepareSurface> prepare;
  SetKeys(this->Source, { { this->Source->GetNumberOfPoints() - 12, 1 } });
  SetKeys(this->Target, { { this->LastRing, 1 } });
  prepare->SetInputData(this->Source);
  this->Filter->SetSourceConnection(prepare->GetOutputPort());
  this->ExpectSewn(1);
}

TEST_F(MeshMergeFilter, RefusesASeamThatIsNoManifold)
{
  // Both have a corner of one triangle between the same three points.
  this->Target = MakePolyData(shapes::Plane(6));
  this->Source = MakePolyData(shapes::Inverted(shapes::Plane(6)));
  SetKeys(this->Target, { { 1, 1 } });
  SetKeys(this->Source, { { 1, 1 } });
  this->Connect();
  this->ExpectError({ "cannot be sewn together",
    Advice("Refine them at the boundary (Subdivide), or move the keys.") });
  vtkNew<vtkLinearSubdivisionFilter> refine;
  this->Source->GetPointData()->RemoveArray("BoundaryKey");
  this->Target->GetPointData()->RemoveArray("BoundaryKey");
  refine->SetInputData(this->Source);
  this->Filter->SetSourceConnection(refine->GetOutputPort());
  this->ExpectSewn(0);
}
