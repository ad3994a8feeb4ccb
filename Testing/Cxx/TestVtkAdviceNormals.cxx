// SPDX-License-Identifier: BSD-3-Clause
// What the filters advise about normals, those of the surface and those that it carries.
#include "Advice.h"

#include "vtkDiscreteForms.h"
#include "vtkRotationInvariantDeformation.h"

#include "vtkFloatArray.h"
#include "vtkPolyDataNormals.h"
#include "vtkTable.h"

#include <cmath>
#include <utility>

using vtktest::Advice;
using vtktest::Advised;
using vtktest::MakePolyData;

namespace
{
/// Refused for points without a normal; each cure for it, by name.
struct WithoutNormal
{
  shapes::Shape Surface;
  std::string Points;
  std::vector<std::pair<std::string, vtkSmartPointer<vtkPolyData>>> Cures;
};

vtkSmartPointer<vtkPolyData> WithoutCellsOf(const shapes::Shape& shape, int point)
{
  shapes::Shape left = shape;
  std::vector<Eigen::Vector3i> faces;
  for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
  {
    if ((shape.Faces.row(t).array() != point).all())
    {
      faces.emplace_back(shape.Faces.row(t));
    }
  }
  left.Faces = shapes::ToTriangles(faces);
  return MakePolyData(left);
}

vtkSmartPointer<vtkPolyData> WithPointAt(
  shapes::Shape shape, int point, const Eigen::RowVector3d& position)
{
  shape.Positions.row(point) = position;
  return MakePolyData(shape);
}
}

TEST(AdviceOnNormals, PointsWithoutANormalMoveOrLoseTheirTrianglesOrAreMerged)
{
  // On a side of the square; in a corner of it; and the middle of a sheet that is
  // folded flat.
  shapes::Shape ear = shapes::Plane(3);
  ear.Positions.conservativeResize(17, 3);
  ear.Positions.row(16) = 0.5 * (ear.Positions.row(0) + ear.Positions.row(1));
  ear.Faces.conservativeResize(19, 3);
  ear.Faces.row(18) << 1, 0, 16;
  shapes::Shape corner = ear;
  corner.Positions.row(16) = corner.Positions.row(0);
  shapes::Shape folded = shapes::Plane(2);
  folded.Positions.col(0) = folded.Positions.col(0).cwiseAbs();
  const WithoutNormal cases[] = {
    { ear, "1 point (id 16)",
      { { "removed", WithoutCellsOf(ear, 16) },
        { "moved", WithPointAt(ear, 16, { -0.3, -0.6, 0.0 }) } } },
    { corner, "1 point (id 16)", { { "merged", vtktest::Prepared(MakePolyData(corner)) } } },
    { folded, "1 point (id 4)",
      { { "neighbor moved", WithPointAt(folded, 3, { 0.5, 0.0, 0.2 }) } } },
  };
  for (const WithoutNormal& one : cases)
  {
    vtkNew<vtkDiscreteForms> filter; // it warns of other things, too
    const auto log = vtktest::Observe(filter);
    filter->SetInputData(MakePolyData(one.Surface));
    filter->Update();
    vtktest::ExpectMessage(log->Errors,
      { one.Points, "without a normal",
        Advice("move these points or their neighbors, remove their triangles, or, where points "
               "coincide, merge them with vtkPrepareSurface (Prepare Surface).") });
    for (const auto& [cure, surface] : one.Cures)
    {
      SCOPED_TRACE(cure);
      log->Clear();
      filter->SetInputData(surface);
      filter->Update();
      EXPECT_TRUE(log->Errors.empty()) << log->Errors[0];
      EXPECT_GT(filter->GetFormsTable()->GetNumberOfRows(), 0);
    }
  }
}

TEST(AdviceOnNormals, NormalsComputedAnewWithoutSplittingLeaveTheSurfaceWhole)
{
  const auto bar = vtktest::MarkedBar();
  vtkNew<vtkFloatArray> normals;
  normals->SetName("N");
  normals->SetNumberOfComponents(3);
  normals->InsertNextTuple3(1, 0, 0);
  bar->GetPointData()->SetNormals(normals);
  Advised<vtkRotationInvariantDeformation> deform;
  deform->SetInputData(bar);
  deform->SetHandleMotion(2, vtktest::Turn(40.0));
  deform.Warns({ "\"N\" have 1 tuples for " + std::to_string(bar->GetNumberOfPoints()) + " points",
    Advice("compute them anew (Surface Normals, Splitting off).") });
  vtkNew<vtkPolyDataNormals> compute;
  compute->SetInputData(bar);
  compute->SplittingOff();
  compute->Update();
  deform->SetInputData(compute->GetOutput());
  const auto bent = deform.Works();
  ASSERT_NE(bent->GetPointData()->GetNormals(), nullptr);
  EXPECT_EQ(bent->GetPointData()->GetNormals()->GetNumberOfTuples(), bar->GetNumberOfPoints());
  // The flat end turns with its handle.
  const Eigen::Vector3d top(0.0, 0.0, 4.0);
  for (vtkIdType v = 0; v < bar->GetNumberOfPoints(); ++v)
  {
    if (Eigen::Vector3d(bar->GetPoint(v)) == top)
    {
      const double angle = 40.0 * shapes::Pi / 180.0;
      const Eigen::Vector3d normal(bent->GetPointData()->GetNormals()->GetTuple3(v));
      EXPECT_LT((normal - Eigen::Vector3d(0.0, -std::sin(angle), std::cos(angle))).norm(), 1e-6);
    }
  }
}
