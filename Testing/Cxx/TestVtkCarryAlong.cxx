// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCarryAlong.h"

#include "Advice.h"
#include "TimeSource.h"

#include "vtkDelaunay3D.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>

namespace
{
using cartan::Points;
using vtktest::Advice;
using vtktest::ExpectMessage;
using vtktest::ExpectQuiet;
using vtktest::MakePolyData;
using vtktest::PointsOf;

constexpr double Radius = 3.0;

/// A place of the bar along z, bent about the x axis with its middle line on a circle.
Eigen::RowVector3d Bent(const Eigen::RowVector3d& place, double radius = Radius)
{
  const double angle = place[2] / radius;
  const double arm = radius - place[1];
  return { place[0], radius - arm * std::cos(angle), arm * std::sin(angle) };
}

vtkSmartPointer<vtkPolyData> Moved(
  vtkPolyData* surface, const std::function<Eigen::RowVector3d(const Eigen::RowVector3d&)>& move)
{
  auto moved = vtktest::CopyOf(surface);
  for (vtkIdType v = 0; v < moved->GetNumberOfPoints(); ++v)
  {
    const Eigen::RowVector3d place = move(Eigen::RowVector3d(
      surface->GetPoint(v)[0], surface->GetPoint(v)[1], surface->GetPoint(v)[2]));
    moved->GetPoints()->SetPoint(v, place.data());
  }
  return moved;
}

/// A bar, the same bar bent, and points around it.
class VtkCarryAlong : public testing::Test
{
protected:
  void SetUp() override
  {
    this->Log = vtktest::Observe(this->Filter);
    this->Rest = MakePolyData(shapes::Bar(4, 4, 16, { 1.0, 1.0, 4.0 }));
    this->Deformed = Moved(this->Rest, [](const Eigen::RowVector3d& p) { return Bent(p); });
    this->Filter->SetRestData(this->Rest);
    this->Filter->SetDeformedData(this->Deformed);
  }

  void Update()
  {
    this->Log->Clear();
    this->Filter->Update();
  }

  vtkNew<vtkCarryAlong> Filter;
  vtkSmartPointer<vtktest::Log> Log;
  vtkSmartPointer<vtkPolyData> Rest;
  vtkSmartPointer<vtkPolyData> Deformed;
};
}

TEST_F(VtkCarryAlong, TakesThePointsOfTheSurfaceExactlyToItsPoints)
{
  // Far from the origin too, where origins round.
  const auto far = [](const Eigen::RowVector3d& p) -> Eigen::RowVector3d
  { return p + Eigen::RowVector3d(1e4 / 3.0, 0.1, -7.0); };
  const auto rest = Moved(this->Rest, far);
  this->Filter->SetRestData(rest);
  this->Filter->SetInputData(rest);
  this->Update();
  ExpectQuiet(*this->Log);
  auto* carried = vtkPolyData::SafeDownCast(this->Filter->GetCarried());
  EXPECT_EQ((PointsOf(carried) - PointsOf(this->Deformed)).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(this->Filter->GetLargestDistance(), 0.0);
}

TEST_F(VtkCarryAlong, TurnsNormalsAndVectorsOnRequest)
{
  const shapes::RigidMotion motion = shapes::RandomRigidMotion(3, 4.0);
  const auto rest = MakePolyData(shapes::Bar(4, 4, 16, { 1.0, 1.0, 4.0 }));
  const Points moved = motion(PointsOf(rest));
  for (vtkIdType v = 0; v < rest->GetNumberOfPoints(); ++v)
  {
    this->Deformed->GetPoints()->SetPoint(v, moved.row(v).data());
  }
  const auto curve = MakePolyData(shapes::Icosphere(1));
  const auto normals = vtktest::AddArray(
    curve, "Normals", 3, [&](vtkIdType v, double* normal) { curve->GetPoint(v, normal); });
  curve->GetPointData()->SetNormals(normals);
  vtktest::AddArray(curve, "Fiber", 3,
    [](vtkIdType v, double* fiber)
    {
      fiber[0] = 1.0;
      fiber[1] = 0.1 * static_cast<double>(v);
      fiber[2] = 0.0;
    });
  const auto before = vtktest::CopyOf(curve);
  this->Filter->SetInputData(curve);
  const Points origin = motion(Points::Zero(1, 3));
  for (const bool turns : { false, true })
  {
    this->Filter->SetTurnVectors(turns);
    this->Update();
    ExpectQuiet(*this->Log);
    vtktest::ExpectSameSurface(curve, before);
    vtkPointSet* carried = this->Filter->GetCarried();
    for (const char* name : { "Normals", "Fiber" })
    {
      const bool isTurned = turns || std::string(name) == "Normals";
      for (vtkIdType v = 0; v < curve->GetNumberOfPoints(); ++v)
      {
        Points vector(1, 3);
        curve->GetPointData()->GetArray(name)->GetTuple(v, vector.data());
        const Points expected = isTurned ? Points(motion(vector) - origin) : vector;
        Points actual(1, 3);
        carried->GetPointData()->GetArray(name)->GetTuple(v, actual.data());
        EXPECT_LT((actual - expected).norm(), 1e-12 * (1.0 + expected.norm())) << name;
      }
    }
  }
}

TEST_F(VtkCarryAlong, MovesAVolumeMeshWithItsSkin)
{
  vtkNew<vtkDelaunay3D> mesher;
  mesher->SetInputData(this->Rest);
  mesher->Update();
  vtkUnstructuredGrid* volume = mesher->GetOutput();
  this->Filter->SetInputData(volume);
  this->Update();
  ExpectQuiet(*this->Log);
  auto* carried = vtkUnstructuredGrid::SafeDownCast(this->Filter->GetCarried());
  ASSERT_NE(carried, nullptr);
  EXPECT_EQ(carried->GetNumberOfCells(), volume->GetNumberOfCells());
  for (vtkIdType v = 0; v < volume->GetNumberOfPoints(); ++v)
  {
    const Eigen::RowVector3d place(
      volume->GetPoint(v)[0], volume->GetPoint(v)[1], volume->GetPoint(v)[2]);
    const Eigen::RowVector3d actual(
      carried->GetPoint(v)[0], carried->GetPoint(v)[1], carried->GetPoint(v)[2]);
    EXPECT_LT((actual - Bent(place)).norm(), 1e-6) << v; // Delaunay's points are float
  }
  EXPECT_EQ(this->Filter->GetNumberOfInvertedCells(), 0);

  // A mirror image inverts all.
  this->Filter->SetDeformedData(Moved(
    this->Rest, [](const Eigen::RowVector3d& p) { return Eigen::RowVector3d(-p[0], p[1], p[2]); }));
  this->Update();
  ExpectMessage(this->Log->Warnings, { "bends more sharply", "tetrahedra are inverted (ids 0, 1" });
  EXPECT_GT(this->Filter->GetNumberOfInvertedCells(), volume->GetNumberOfCells() / 2);
}

TEST_F(VtkCarryAlong, KeepsThePrecisionAndFollowsTime)
{
  const auto points = MakePolyData(shapes::Icosphere(1), VTK_FLOAT);
  this->Filter->SetInputData(points);
  this->Update();
  EXPECT_EQ(this->Filter->GetCarried()->GetPoints()->GetDataType(), VTK_FLOAT);
  const auto direct = vtktest::CopyOf(vtkPolyData::SafeDownCast(this->Filter->GetCarried()));

  vtkNew<vtktest::TimeSource> source;
  source->SetSteps({ 0.0, 2.5 }, { this->Rest, this->Deformed });
  this->Filter->SetDeformedConnection(source->GetOutputPort());
  this->Log->Clear();
  this->Filter->UpdateTimeStep(2.5);
  ExpectQuiet(*this->Log);
  vtktest::ExpectSameSurface(vtkPolyData::SafeDownCast(this->Filter->GetCarried()), direct);
  vtkInformation* info = this->Filter->GetOutputInformation(0);
  EXPECT_EQ(info->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS()), 2);
}

/// A bar, and beside it one of 1e-6 of its size that points follow.
TEST_F(VtkCarryAlong, SaysWhereDigitsDoNotTellATurn)
{
  const shapes::RigidMotion motion = shapes::RandomRigidMotion(3);
  shapes::Shape small = shapes::Bar(2, 2, 2, { 3e-6, 3e-6, 3e-6 });
  small.Positions.rowwise() += Eigen::RowVector3d(3.0, 0.0, 2.0);
  const shapes::Shape both = shapes::Union(shapes::Bar(4, 4, 16, { 1.0, 1.0, 4.0 }), small);
  shapes::Shape around = shapes::Icosphere(1);
  around.Positions = 0.2 * around.Positions.rowwise().normalized();
  around.Positions.rowwise() += Eigen::RowVector3d(3.0, 0.0, 2.0);
  this->Filter->SetInputData(MakePolyData(around));
  const auto move = [&](vtkPolyData* rest)
  {
    this->Filter->SetRestData(rest);
    this->Filter->SetDeformedData(Moved(rest,
      [&](const Eigen::RowVector3d& p) -> Eigen::RowVector3d
      { return (motion.Rotation * p.transpose() + motion.Translation).transpose(); }));
    this->Update();
    return PointsOf(vtkPolyData::SafeDownCast(this->Filter->GetCarried()));
  };
  const std::string advice =
    Advice("Deform the surface in double precision, or without its small parts (Prepare Surface, "
           "Minimum Component Area).");
  move(MakePolyData(both, VTK_FLOAT));
  ExpectMessage(
    this->Log->Warnings, { "do not tell how they turn", "42 carried points (ids 0, 1", advice });

  EXPECT_LT((move(MakePolyData(both)) - motion(around.Positions)).cwiseAbs().maxCoeff(), 1e-6);
  ExpectQuiet(*this->Log);
  const auto without = vtktest::Prepared(MakePolyData(both, VTK_FLOAT),
    [](vtkPrepareSurface* prepare) { prepare->SetMinimumComponentArea(1e-6); });
  EXPECT_LT((move(without) - motion(around.Positions)).cwiseAbs().maxCoeff(), 1e-4);
  ExpectQuiet(*this->Log);
}

TEST_F(VtkCarryAlong, SaysWhatIsWrong)
{
  const auto points = MakePolyData(shapes::Icosphere(1));
  this->Filter->SetInputData(points);
  this->Filter->SetDeformedConnection(nullptr);
  const std::string connect = Advice("connect the surface before and after it was deformed.");
  this->Update();
  ExpectMessage(this->Log->Errors, { "no surface as it is now", connect });
  this->Filter->SetDeformedData(this->Deformed);
  this->Filter->SetRestConnection(nullptr);
  this->Update();
  ExpectMessage(this->Log->Errors, { "no surface at rest", connect });
  this->Filter->SetRestData(points);
  this->Update();
  ExpectMessage(this->Log->Errors,
    { "deformed surface", "surface at rest",
      Advice("Give both the same points and cells in the same order, such as a surface before and "
             "after it was deformed.") });
  this->Filter->SetRestData(this->Rest);
  points->GetPoints()->SetPoint(5, 0.0, std::nan(""), 0.0);
  points->GetPoints()->Modified();
  points->Modified();
  this->Update();
  ExpectMessage(this->Log->Errors,
    { "What follows has 1 point (id 5)", Advice("repair or remove these points.") });
  EXPECT_EQ(this->Filter->GetCarried()->GetNumberOfPoints(), 0);
  points->GetPoints()->SetPoint(5, 0.0, 0.0, 0.0);
  points->GetPoints()->Modified();
  points->Modified();
  this->Update();
  ExpectQuiet(*this->Log);
  EXPECT_EQ(this->Filter->GetCarried()->GetNumberOfPoints(), points->GetNumberOfPoints());
}
