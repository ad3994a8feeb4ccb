// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshMerge.h"

#include "Advice.h"
#include "MergeShapes.h"

#include "vtkBoundaryLoops.h"
#include "vtkPrepareSurface.h"

namespace
{
using vtktest::ExpectMessage;
using vtktest::ExpectQuiet;
using vtktest::MakePolyData;

class MeshMergeInputs : public testing::Test
{
protected:
  void SetUp() override { this->Log = vtktest::Observe(this->Filter); }

  vtkPolyData* Merge(vtkPolyData* target, vtkPolyData* source)
  {
    this->Filter->SetInputData(target);
    this->Filter->SetSourceData(source);
    this->Log->Clear();
    this->Filter->Update();
    return this->Filter->GetOutput();
  }

  static int NumberOfLoops(vtkPolyData* surface)
  {
    vtkNew<vtkBoundaryLoops> loops;
    loops->SetInputData(surface);
    loops->Update();
    return loops->GetNumberOfLoops();
  }

  vtkNew<vtkMeshMerge> Filter;
  vtkSmartPointer<vtktest::Log> Log;
};

void SetKey(vtkPolyData* surface, vtkIdType point)
{
  vtktest::AddHandles(
    surface, [](const Eigen::Vector3d&) { return 0; }, "BoundaryKey");
  surface->GetPointData()->GetArray("BoundaryKey")->SetTuple1(point, 1.0);
}

vtkIdType PointAt(vtkPolyData* surface, const Eigen::Vector3d& place)
{
  return surface->FindPoint(place[0], place[1], place[2]);
}

/// A square of quads in the plane without those at some places.
shapes::Shape PlaneWithout(const std::vector<Eigen::Vector2d>& holes)
{
  shapes::Shape plane = shapes::Plane(8, 8.0);
  std::vector<Eigen::Vector3i> faces;
  for (Eigen::Index t = 0; t < plane.Faces.rows(); ++t)
  {
    Eigen::Vector2d center = Eigen::Vector2d::Zero();
    for (int k = 0; k < 3; ++k)
    {
      center += plane.Positions.row(plane.Faces(t, k)).head<2>().transpose() / 3.0;
    }
    const bool isHole = std::any_of(holes.begin(), holes.end(),
      [&](const Eigen::Vector2d& hole) { return (center - hole).cwiseAbs().maxCoeff() < 0.5; });
    if (!isHole)
    {
      faces.emplace_back(plane.Faces.row(t));
    }
  }
  plane.Faces = shapes::ToTriangles(faces);
  return plane;
}
}

TEST_F(MeshMergeInputs, SewsBoundariesOfThreePoints)
{
  const shapes::Shape prism = shapes::OpenCylinder(3, 5, 1.0, 2.0);
  shapes::Shape tube = shapes::OpenCylinder(14, 5, 1.0, 2.0);
  for (const shapes::Shape& other : { prism, tube })
  {
    auto target = MakePolyData(prism);
    auto source = MakePolyData(other);
    SetKey(target, target->GetNumberOfPoints() - 3);
    SetKey(source, 0);
    vtkPolyData* output = this->Merge(target, source);
    ExpectQuiet(*this->Log);
    ASSERT_GT(output->GetNumberOfCells(), prism.Faces.rows());
    EXPECT_EQ(NumberOfLoops(output), 2);
    SetKey(target, 0);
    SetKey(source, source->GetNumberOfPoints() - 1);
    EXPECT_GT(this->Merge(source, target)->GetNumberOfCells(), 0);
    ExpectQuiet(*this->Log);
  }
}

TEST_F(MeshMergeInputs, NamesBoundariesThatTouch)
{
  // Two holes with a corner in common.
  auto plane = MakePolyData(PlaneWithout({ { 0.5, 0.5 }, { 1.5, 1.5 } }));
  auto tube = MakePolyData(shapes::OpenCylinder(9, 5, 0.4, 2.0));
  const std::string advice =
    vtktest::Advice("give each fan a point of its own with Prepare Surface.");
  for (const bool isTarget : { false, true })
  {
    vtkPolyData* output = this->Merge(isTarget ? plane : tube, isTarget ? tube : plane);
    EXPECT_EQ(output->GetNumberOfPoints(), 0);
    EXPECT_EQ(this->Filter->GetCorrespondences()->GetNumberOfPoints(), 0);
    ExpectMessage(this->Log->Errors,
      { isTarget ? "The target has 1 point (id" : "The source has 1 point (id", advice });
  }
  vtkNew<vtkPrepareSurface> prepare;
  prepare->SetInputData(plane);
  prepare->Update();
  vtkPolyData* prepared = prepare->GetOutput();
  SetKey(prepared, PointAt(prepared, { 1.0, 0.0, 0.0 }));
  SetKey(tube, 0);
  EXPECT_GT(this->Merge(prepared, tube)->GetNumberOfCells(), 0);
  ExpectQuiet(*this->Log);
}

TEST_F(MeshMergeInputs, SewsOnlyOneOfTwoBoundariesSideBySide)
{
  // Two holes with a row of quads between them.
  auto target = MakePolyData(PlaneWithout({ { 0.5, 0.5 }, { 2.5, 0.5 } }));
  auto source = MakePolyData(shapes::OpenCylinder(9, 5, 0.4, 2.0));
  SetKey(target, PointAt(target, { 1.0, 1.0, 0.0 }));
  SetKey(source, 0);
  vtkPolyData* output = this->Merge(target, source);
  ExpectQuiet(*this->Log);
  ASSERT_GT(output->GetNumberOfCells(), 0);
  EXPECT_EQ(NumberOfLoops(output), 3);
}

TEST_F(MeshMergeInputs, TakesTheTargetAsItsOwnSource)
{
  // Sewn at all loops, both are one closed surface that folds back at the seam.
  for (const shapes::Shape& shape : { shapes::Plane(6), shapes::OpenCylinder(12, 5, 1.0, 2.0) })
  {
    auto surface = MakePolyData(shape);
    vtkPolyData* output = this->Merge(surface, surface);
    EXPECT_TRUE(this->Log->Errors.empty());
    EXPECT_EQ(output->GetNumberOfCells(), 2 * shape.Faces.rows());
    EXPECT_EQ(NumberOfLoops(output), 0);
    EXPECT_GT(this->Filter->GetSeamAngleMean(), 90.0);
  }
}
