// SPDX-License-Identifier: BSD-3-Clause
#include "TestShapes.h"
#include "VtkTestHelpers.h"

#include "vtkCurvatureError.h"
#include "vtkDiscreteForms.h"
#include "vtkHandleMotion.h"
#include "vtkMarkHandle.h"
#include "vtkPrepareSurface.h"
#include "vtkRestoreSurface.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkSurfaceMorph.h"
#include "vtkVolumeChange.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkErrorCode.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSphere.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

/// Filters that prepare their input give what Prepare Surface, the filter, and
/// Restore Surface give one after the other.
namespace
{
/// A closed bar of triangles that have their points to themselves, as in STL
/// files; some look the other way.
vtkSmartPointer<vtkPolyData> Soup()
{
  shapes::Shape bar = shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 });
  bar.Positions.rowwise() -= bar.Positions.colwise().mean().eval();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> triangles;
  for (Eigen::Index t = 0; t < bar.Faces.rows(); ++t)
  {
    vtkIdType ids[3];
    for (int i = 0; i < 3; ++i)
    {
      ids[i] = points->InsertNextPoint(bar.Positions.row(bar.Faces(t, i)).data());
    }
    if (t % 5 == 0)
    {
      std::swap(ids[1], ids[2]);
    }
    triangles->InsertNextCell(3, ids);
  }
  auto soup = vtkSmartPointer<vtkPolyData>::New();
  soup->SetPoints(points);
  soup->SetPolys(triangles);
  vtktest::AddHandles(
    soup, [](const Eigen::Vector3d& x) { return x[2] < -1.4 ? 1
                                           : x[2] > 1.4     ? 2
                                                            : 0; });
  return soup;
}

vtkSmartPointer<vtkHandleMotion> Bend()
{
  auto motion = vtkSmartPointer<vtkHandleMotion>::New();
  motion->SetAxis(1, 0, 0);
  motion->SetAngle(50);
  return motion;
}

vtkSmartPointer<vtkRotationInvariantDeformation> Deformation()
{
  auto filter = vtkSmartPointer<vtkRotationInvariantDeformation>::New();
  filter->SetHandleMotion(2, Bend());
  return filter;
}

TEST(PrepareInput, DeformsASoupAsThreeFiltersDo)
{
  const auto soup = Soup();
  vtkNew<vtkPrepareSurface> prepare;
  prepare->SetInputData(soup);
  const auto between = Deformation();
  between->SetInputConnection(prepare->GetOutputPort());
  vtkNew<vtkRestoreSurface> restore;
  restore->SetInputConnection(between->GetOutputPort());
  restore->SetOriginalData(soup);
  restore->Update();

  const auto filter = Deformation();
  const auto log = vtktest::Observe(filter);
  filter->SetInputData(soup);
  filter->PrepareInputOn();
  filter->Update();
  EXPECT_TRUE(log->Errors.empty());
  EXPECT_TRUE(log->Warnings.empty());
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), soup->GetNumberOfCells());
  EXPECT_EQ(vtktest::PointsOf(filter->GetOutput()), vtktest::PointsOf(restore->GetOutput()));
  EXPECT_GT((vtktest::PointsOf(filter->GetOutput()) - vtktest::PointsOf(soup)).norm(), 1.0);
  EXPECT_FALSE(filter->GetOutput()->GetPointData()->HasArray("OriginalPointIds"));

  // A motion prepares nothing again.
  const int factorizations = filter->GetNumberOfFactorizations();
  filter->GetHandleMotion(2)->SetAngle(20);
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfFactorizations(), factorizations);
}

TEST(PrepareInput, IsOffByDefault)
{
  const auto filter = Deformation();
  const auto log = vtktest::Observe(filter);
  filter->SetInputData(Soup());
  filter->Update();
  vtktest::ExpectMessage(log->Warnings, { "Prepare Surface" });
}

TEST(PrepareInput, MarksMergedPointsTogether)
{
  const auto soup = Soup();
  soup->GetPointData()->RemoveArray("Handle");
  vtkNew<vtkMarkHandle> mark;
  const auto log = vtktest::Observe(mark);
  mark->SetInputData(soup);
  vtkNew<vtkSphere> sphere;
  sphere->SetCenter(0.5, 0.5, 2.0);
  sphere->SetRadius(0.01);
  mark->SetRegion(sphere);
  mark->SetGrowRings(100);
  mark->PrepareInputOn();
  mark->Update();
  EXPECT_TRUE(log->Errors.empty());
  EXPECT_EQ(mark->GetNumberOfMarkedPoints(), soup->GetNumberOfPoints());
}

TEST(PrepareInput, MorphsAndMeasures)
{
  const auto soup = Soup();
  const auto bent = Deformation();
  bent->SetInputData(soup);
  bent->PrepareInputOn();
  bent->Update();

  vtkNew<vtkSurfaceMorph> morph;
  const auto morphLog = vtktest::Observe(morph);
  morph->AddInputData(soup);
  morph->AddInputConnection(bent->GetOutputPort());
  morph->SetParameter(1.0);
  morph->PrepareInputOn();
  morph->Update();
  EXPECT_TRUE(morphLog->Errors.empty());
  EXPECT_LT(
    (vtktest::PointsOf(morph->GetOutput()) - vtktest::PointsOf(bent->GetOutput())).norm(), 1e-12);
  morph->SetParameter(0.5);
  morph->Update();
  EXPECT_EQ(morph->GetOutput()->GetNumberOfPoints(), soup->GetNumberOfPoints());
  EXPECT_TRUE(vtktest::PointsOf(morph->GetOutput()).allFinite());

  vtkNew<vtkVolumeChange> volume;
  const auto volumeLog = vtktest::Observe(volume);
  volume->SetInputConnection(bent->GetOutputPort());
  volume->SetReferenceData(soup);
  volume->PrepareInputOn();
  volume->Update();
  EXPECT_TRUE(volumeLog->Errors.empty());
  EXPECT_LT(std::abs(volume->GetRelativeVolumeChange()), 0.3); // NaN where a surface is open

  vtkNew<vtkCurvatureError> curvature;
  const auto curvatureLog = vtktest::Observe(curvature);
  curvature->SetInputConnection(bent->GetOutputPort());
  curvature->SetReferenceData(soup);
  curvature->PrepareInputOn();
  curvature->Update();
  EXPECT_TRUE(curvatureLog->Errors.empty());
  EXPECT_EQ(curvature->GetOutput()->GetNumberOfPoints(), soup->GetNumberOfPoints());
}

TEST(PrepareInput, IsRefusedWhereItMeansNothing)
{
  vtkNew<vtkDiscreteForms> forms;
  const auto log = vtktest::Observe(forms);
  forms->SetInputData(Soup());
  forms->PrepareInputOn();
  forms->Update();
  vtktest::ExpectMessage(log->Errors, { "PrepareInput is not possible", "Prepare Surface" });
  EXPECT_EQ(forms->GetErrorCode(), vtkErrorCode::UserError);
}
}
