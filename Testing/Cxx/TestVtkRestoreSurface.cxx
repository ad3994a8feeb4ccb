// SPDX-License-Identifier: BSD-3-Clause
#include "PrepareShapes.h"
#include "TestSurfaces.h"
#include "VtkTestHelpers.h"

#include "vtkHandleMotion.h"
#include "vtkPoissonDeformation.h"
#include "vtkPolyDataNormals.h"
#include "vtkPrepareSurface.h"
#include "vtkRestoreSurface.h"

#include <map>

namespace
{
/// A bar whose edges are split, with its own normals on each side, cell normals,
/// and texture coordinates.
vtkSmartPointer<vtkPolyData> SplitBar(int precision = VTK_DOUBLE)
{
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(vtktest::MakePolyData(shapes::Bar(3, 3, 12, { 1, 1, 4 }), precision));
  normals->SplittingOn();
  normals->ComputeCellNormalsOn();
  normals->SetFeatureAngle(30.0);
  normals->Update();
  auto bar = vtkSmartPointer<vtkPolyData>::New();
  bar->DeepCopy(normals->GetOutput());
  const auto uv = vtktest::AddArray(bar, "Texture", 2,
    [](vtkIdType v, double* x)
    {
      x[0] = 0.1 * v;
      x[1] = 1.0 - 0.1 * v;
    });
  bar->GetPointData()->SetTCoords(uv);
  return bar;
}

vtkSmartPointer<vtkPolyData> Prepared(vtkPolyData* original)
{
  vtkNew<vtkPrepareSurface> prepare;
  const auto log = vtktest::Observe(prepare);
  prepare->SetInputData(original);
  prepare->Update();
  vtktest::ExpectQuiet(*log);
  return vtktest::CopyOf(prepare->GetOutput());
}

class RestoreSurface : public ::testing::Test
{
protected:
  RestoreSurface()
    : Log(vtktest::Observe(this->Filter))
  {
  }

  vtkPolyData* Run(vtkPolyData* prepared, vtkPolyData* original)
  {
    this->Filter->SetInputData(prepared);
    this->Filter->SetOriginalData(original);
    this->Filter->Update();
    return this->Filter->GetOutput();
  }

  vtkNew<vtkRestoreSurface> Filter;
  vtkSmartPointer<vtktest::Log> Log;
};
}

TEST_F(RestoreSurface, NothingMovedIsTheOriginalToTheBit)
{
  for (const int precision : { VTK_FLOAT, VTK_DOUBLE })
  {
    const auto bar = SplitBar(precision);
    const auto prepared = Prepared(bar);
    EXPECT_LT(prepared->GetNumberOfPoints(), bar->GetNumberOfPoints());
    vtkPolyData* output = this->Run(prepared, bar);
    vtktest::ExpectQuiet(*this->Log);
    vtktest::ExpectSameSurface(output, bar);
  }
}

TEST_F(RestoreSurface, RigidMotionsTurnSplitNormals)
{
  const auto bar = SplitBar();
  const auto prepared = Prepared(bar);
  const shapes::RigidMotion motion = shapes::RandomRigidMotion(4, 3.0);
  const cartan::Points moved = motion(vtktest::PointsOf(prepared));
  for (Eigen::Index v = 0; v < moved.rows(); ++v)
  {
    prepared->GetPoints()->SetPoint(v, moved.row(v).data());
  }
  vtkPolyData* output = this->Run(prepared, bar);
  vtktest::ExpectQuiet(*this->Log);
  EXPECT_LT(
    (vtktest::PointsOf(output) - motion(vtktest::PointsOf(bar))).cwiseAbs().maxCoeff(), 1e-12);
  const auto expectTurned = [&motion](vtkDataArray* now, vtkDataArray* before)
  {
    ASSERT_EQ(now->GetNumberOfTuples(), before->GetNumberOfTuples());
    for (vtkIdType i = 0; i < now->GetNumberOfTuples(); ++i)
    {
      const Eigen::Vector3d turned = motion.Rotation * Eigen::Vector3d(before->GetTuple3(i));
      // The normals are those of the faces, stored in single precision.
      EXPECT_LT((Eigen::Vector3d(now->GetTuple3(i)) - turned).norm(), 1e-6);
    }
  };
  expectTurned(output->GetPointData()->GetNormals(), bar->GetPointData()->GetNormals());
  expectTurned(output->GetCellData()->GetNormals(), bar->GetCellData()->GetNormals());
}

TEST_F(RestoreSurface, ADeformedSplitBarHasNoCracks)
{
  const auto bar = SplitBar(VTK_FLOAT);
  const auto prepared = Prepared(bar);
  vtktest::AddHandles(
    prepared, [](const Eigen::Vector3d& p) { return p[2] < 0.4 ? 1
                                               : p[2] > 3.6    ? 2
                                                               : 0; });
  vtkNew<vtkPoissonDeformation> deform;
  vtkNew<vtkHandleMotion> motion;
  motion->SetAxis(0.0, 0.0, 1.0);
  motion->SetAngle(80.0);
  deform->SetInputData(prepared);
  deform->SetHandleMotion(2, motion);
  deform->Update();
  vtkPolyData* output = this->Run(deform->GetOutput(), bar);
  vtktest::ExpectQuiet(*this->Log);
  vtktest::ExpectSameCells(output, bar);
  std::map<std::array<double, 3>, std::array<double, 3>> places;
  double farthest = 0.0;
  for (vtkIdType v = 0; v < bar->GetNumberOfPoints(); ++v)
  {
    std::array<double, 3> before;
    std::array<double, 3> after;
    bar->GetPoint(v, before.data());
    output->GetPoint(v, after.data());
    const auto place = places.emplace(before, after).first;
    EXPECT_EQ(place->second, after);
    farthest = std::max(farthest, std::abs(after[0] - before[0]));
  }
  EXPECT_GT(farthest, 0.3);
  EXPECT_LT(places.size(), static_cast<std::size_t>(bar->GetNumberOfPoints()));
  EXPECT_NE(output->GetPointData()->GetArray("Handle"), nullptr);
  EXPECT_TRUE(vtktest::SameArray(
    output->GetPointData()->GetArray("Texture"), bar->GetPointData()->GetArray("Texture")));
}

TEST_F(RestoreSurface, ChangedAndNewArraysAreCarried)
{
  const auto bar = SplitBar();
  vtktest::AddArray(bar, "Kept", 1, [](vtkIdType v, double* x) { *x = static_cast<double>(v); });
  vtktest::AddArray(bar, "Changed", 1, [](vtkIdType, double* x) { *x = 1.0; });
  vtkNew<vtkIntArray> region;
  region->SetName("Region");
  region->SetNumberOfValues(bar->GetNumberOfCells());
  region->FillValue(3);
  bar->GetCellData()->AddArray(region);
  const auto prepared = Prepared(bar);
  for (vtkIdType v = 0; v < prepared->GetNumberOfPoints(); ++v)
  {
    prepared->GetPointData()->GetArray("Changed")->SetTuple1(v, 2.0);
  }
  prepared->GetCellData()->GetArray("Region")->SetTuple1(5, 7);
  vtktest::AddArray(
    prepared, "New", 3, [&prepared](vtkIdType v, double* x) { prepared->GetPoint(v, x); });
  vtkPolyData* output = this->Run(prepared, bar);
  vtktest::ExpectQuiet(*this->Log);
  vtkPointData* data = output->GetPointData();
  EXPECT_TRUE(vtktest::SameArray(data->GetArray("Kept"), bar->GetPointData()->GetArray("Kept")));
  for (vtkIdType v = 0; v < bar->GetNumberOfPoints(); ++v)
  {
    EXPECT_EQ(data->GetArray("Changed")->GetTuple1(v), 2.0);
    EXPECT_EQ(
      Eigen::Vector3d(data->GetArray("New")->GetTuple3(v)), Eigen::Vector3d(bar->GetPoint(v)));
  }
  for (vtkIdType cell = 0; cell < bar->GetNumberOfCells(); ++cell)
  {
    EXPECT_EQ(output->GetCellData()->GetArray("Region")->GetTuple1(cell), cell == 5 ? 7 : 3);
  }
  EXPECT_EQ(data->GetArray("OriginalPointIds"), nullptr);
  EXPECT_EQ(bar->GetPointData()->GetArray("New"), nullptr);
}

TEST_F(RestoreSurface, PointsMergedByToleranceKeepTheirOffset)
{
  const auto soup = vtktest::MakePolyData(shapes::Noisy(shapes::Soup(shapes::Torus(12, 8)), 1e-4));
  vtkNew<vtkPrepareSurface> prepare;
  prepare->SetInputData(soup);
  prepare->ToleranceIsAbsoluteOn();
  prepare->SetTolerance(1e-3);
  prepare->Update();
  const auto prepared = vtktest::CopyOf(prepare->GetOutput());
  EXPECT_EQ(prepared->GetNumberOfPoints(), 96);
  const Eigen::RowVector3d by(0.5, -2.0, 1.0);
  for (vtkIdType v = 0; v < prepared->GetNumberOfPoints(); ++v)
  {
    const Eigen::RowVector3d p = Eigen::RowVector3d(prepared->GetPoint(v)) + by;
    prepared->GetPoints()->SetPoint(v, p.data());
  }
  const cartan::Points restored = vtktest::PointsOf(this->Run(prepared, soup));
  vtktest::ExpectQuiet(*this->Log);
  EXPECT_LT((restored - (vtktest::PointsOf(soup).rowwise() + by)).cwiseAbs().maxCoeff(), 1e-14);
}

TEST_F(RestoreSurface, CopiesThatPartMeetInTheMiddle)
{
  // A bow tie: two triangles that share point 2.
  const auto bow =
    surfaces::FromTriangles({ { -1, -1, 0 }, { -1, 1, 0 }, { 0, 0, 0 }, { 1, 1, 0 }, { 1, -1, 0 } },
      { { 0, 2, 1 }, { 2, 4, 3 } });
  const auto prepared = Prepared(bow);
  ASSERT_EQ(prepared->GetNumberOfPoints(), 6);
  prepared->GetPoints()->SetPoint(2, -0.5, 0.0, 1.0);
  prepared->GetPoints()->SetPoint(5, 0.5, 0.0, 1.0);
  vtkPolyData* output = this->Run(prepared, bow);
  vtktest::ExpectMessage(this->Log->Warnings, { "1 point (id 2)", "parted", "middle" });
  EXPECT_EQ(Eigen::Vector3d(output->GetPoint(2)), Eigen::Vector3d(0.0, 0.0, 1.0));
  this->Log->Clear();
  prepared->GetPoints()->SetPoint(2, 0.25, 0.0, 1.0);
  prepared->GetPoints()->SetPoint(5, 0.25, 0.0, 1.0);
  prepared->Modified();
  output = this->Run(prepared, bow);
  vtktest::ExpectQuiet(*this->Log);
  EXPECT_EQ(Eigen::Vector3d(output->GetPoint(2)), Eigen::Vector3d(0.25, 0.0, 1.0));
}

TEST_F(RestoreSurface, CopiesThatStayLeaveTheOriginalToTheBit)
{
  // Six tetrahedra around an edge of their own: the edge's points have six copies, and
  // the sum of six equal coordinates by six is not always that coordinate.
  shapes::Shape star;
  star.Positions.resize(14, 3);
  std::vector<Eigen::Vector3i> faces;
  for (int i = 0; i < 6; ++i)
  {
    const double angle = shapes::Pi * i / 3.0;
    star.Positions.row(2 + 2 * i) << std::cos(angle), std::sin(angle), 0.1;
    star.Positions.row(3 + 2 * i) << std::cos(angle + 0.5), std::sin(angle + 0.5), 0.1;
    const int a = 2 + 2 * i;
    faces.insert(faces.end(), { { 0, 1, a }, { 1, 0, a + 1 }, { 0, a, a + 1 }, { 1, a + 1, a } });
  }
  star.Faces = shapes::ToTriangles(faces);
  for (unsigned int seed = 1; seed < 20; ++seed)
  {
    shapes::Random random(seed);
    star.Positions.row(0) << 0.1 * random(), 0.1 * random(), 0.7 + 0.1 * random();
    star.Positions.row(1) << 0.1 * random(), 0.1 * random(), -0.7 + 0.1 * random();
    const auto original = vtktest::MakePolyData(star);
    vtkPolyData* output = this->Run(Prepared(original), original);
    EXPECT_TRUE(
      vtktest::SameArray(output->GetPoints()->GetData(), original->GetPoints()->GetData()))
      << seed;
  }
}

TEST_F(RestoreSurface, NormalsWhereNoTriangleIsStayAsTheyAre)
{
  shapes::Shape shape = shapes::Bar(2, 2, 6, { 1, 1, 3 });
  shape.Positions.conservativeResize(shape.Positions.rows() + 1, Eigen::NoChange);
  shape.Positions.bottomRows<1>().setConstant(5.0);
  const auto original = vtktest::MakePolyData(shape);
  const vtkIdType alone = original->GetNumberOfPoints() - 1;
  original->GetPointData()->SetNormals(vtktest::AddArray(original, "Normals", 3,
    [](vtkIdType, double* normal)
    {
      normal[0] = 0.0;
      normal[1] = 0.6;
      normal[2] = 0.8;
    }));
  const auto prepared = Prepared(original);
  const shapes::RigidMotion motion = shapes::RandomRigidMotion(7);
  const cartan::Points moved = motion(vtktest::PointsOf(prepared));
  for (Eigen::Index v = 0; v < moved.rows(); ++v)
  {
    prepared->GetPoints()->SetPoint(v, moved.row(v).data());
  }
  vtkDataArray* normals = this->Run(prepared, original)->GetPointData()->GetNormals();
  EXPECT_EQ(Eigen::Vector3d(normals->GetTuple3(alone)), Eigen::Vector3d(0.0, 0.6, 0.8));
  for (vtkIdType v = 0; v < alone; ++v)
  {
    EXPECT_NEAR(Eigen::Vector3d(normals->GetTuple3(v)).norm(), 1.0, 1e-12);
  }
}

TEST_F(RestoreSurface, RefusesSurfacesThatDoNotBelongTogether)
{
  const auto bar = SplitBar();
  const auto prepared = Prepared(bar);
  const auto expectError =
    [this](vtkPolyData* first, vtkPolyData* second, const std::vector<std::string>& parts)
  {
    this->Log->Clear();
    vtkPolyData* output = this->Run(first, second);
    vtktest::ExpectMessage(this->Log->Errors, parts);
    EXPECT_EQ(output->GetNumberOfPoints(), 0);
    EXPECT_EQ(output->GetNumberOfCells(), 0);
  };
  expectError(bar, bar, { "no array OriginalPointIds", "Prepare Surface" });
  expectError(prepared, vtktest::MakePolyData(shapes::Icosphere(1)),
    { "does not fit the original", "Prepare Surface had as its input" });
  const auto noField = vtktest::CopyOf(prepared);
  noField->GetFieldData()->RemoveArray("PreparedPointIds");
  expectError(noField, bar, { "no array PreparedPointIds" });
}
