// SPDX-License-Identifier: BSD-3-Clause
#include "SliverShapes.h"
#include "TestShapes.h"
#include "VtkTestHelpers.h"

#include "vtkHandleMotion.h"
#include "vtkSimilarityDeformation.h"

#include "vtkMatrix4x4.h"

#include <cmath>
#include <sstream>

namespace
{
using Filter = vtkSimilarityDeformation;

/// A bar with flat sides and its ends as handles 1 and 2.
vtkSmartPointer<vtkPolyData> MarkedBar()
{
  auto surface = vtktest::MakePolyData(shapes::Bar(4, 4, 16, { 1.0, 1.0, 4.0 }));
  vtktest::AddHandles(
    surface, [](const Eigen::Vector3d& p) { return p[2] < 0.6 ? 1 : (p[2] > 3.4 ? 2 : 0); });
  return surface;
}

vtkDataArray* OutputArray(Filter* filter, const char* name)
{
  return filter->GetOutput()->GetPointData()->GetArray(name);
}
}

TEST(vtkSimilarityDeformation, FactorizesTwoMatricesPerSetOfHandles)
{
  auto surface = MarkedBar();
  const cartan::Points before = vtktest::PointsOf(surface);
  vtkNew<vtkHandleMotion> motion;
  motion->SetAxis(1.0, 0.0, 0.0);
  vtkNew<Filter> filter;
  auto log = vtktest::Observe(filter);
  filter->SetInputData(surface);
  filter->SetHandleMotion(2, motion);
  for (const double angle : { 20.0, 40.0, 60.0 })
  {
    motion->SetAngle(angle);
    filter->Update();
    EXPECT_EQ(filter->GetNumberOfFactorizations(), 2);
  }
  filter->ScaleFeaturesOn();
  filter->SetRefits(2);
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfFactorizations(), 2);
  filter->SetReconstructionToLeastSquares();
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfFactorizations(), 3);
  filter->SetCoherenceRings(1);
  filter->Update();
  // Re-fits put the surface together from edges, so there are three now.
  EXPECT_EQ(filter->GetNumberOfFactorizations(), 6);
  vtktest::ExpectQuiet(*log);
  EXPECT_TRUE(vtktest::PointsOf(surface) == before);
  EXPECT_GT(filter->GetNumberOfFlatPoints(), 0);
  EXPECT_LT(filter->GetNumberOfFlatPoints(), filter->GetNumberOfFreePoints());
}

TEST(vtkSimilarityDeformation, ScalesTheWholeSurfaceAlong)
{
  auto surface = MarkedBar();
  vtkNew<vtkHandleMotion> motion;
  motion->SetScale(2.0, 2.0, 2.0);
  motion->SetAxis(1.0, 2.0, -1.0);
  motion->SetAngle(130.0);
  motion->SetTranslation(1.0, 2.0, 3.0);
  vtkNew<Filter> filter;
  auto log = vtktest::Observe(filter);
  filter->SetInputData(surface);
  filter->SetHandleMotion(1, motion);
  filter->SetHandleMotion(2, motion);
  filter->ScaleFeaturesOn();
  filter->GenerateScaleFactorOn();
  filter->GenerateRotationVectorOn();
  for (int reconstruction = Filter::AFFINE; reconstruction <= Filter::EDGE_FORM; ++reconstruction)
  {
    filter->SetReconstruction(reconstruction);
    filter->Update();
    vtktest::ExpectQuiet(*log);
    vtkNew<vtkMatrix4x4> matrix;
    motion->GetTransform(matrix);
    double vector[3];
    motion->GetRotationVector(vector);
    ASSERT_NE(OutputArray(filter, "ScaleFactor"), nullptr);
    ASSERT_NE(OutputArray(filter, "RotationVector"), nullptr);
    for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
    {
      double point[4] = { 0.0, 0.0, 0.0, 1.0 };
      surface->GetPoint(i, point);
      matrix->MultiplyPoint(point, point);
      double moved[3];
      filter->GetOutput()->GetPoint(i, moved);
      double rotation[3];
      OutputArray(filter, "RotationVector")->GetTuple(i, rotation);
      for (int k = 0; k < 3; ++k)
      {
        EXPECT_NEAR(moved[k], point[k], 1e-9);
        EXPECT_NEAR(rotation[k], vector[k], 1e-6);
      }
      EXPECT_NEAR(OutputArray(filter, "ScaleFactor")->GetTuple1(i), 2.0, 1e-9);
    }
  }
}

// Points that are solved for as part of others have their scale too.
TEST(vtkSimilarityDeformation, ScalesPointsInThinTrianglesAndJoinedOnes)
{
  shapes::Shape bar = shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 });
  const int added = slivers::SplitTriangle(bar, 70, { 0.5, 0.4999999, 1e-7 });
  // A copy of the last triangle's first corner, joined with it.
  const int corner = bar.Faces(40, 0);
  bar.Positions.conservativeResize(added + 2, 3);
  bar.Positions.row(added + 1) = bar.Positions.row(corner);
  bar.Faces(40, 0) = added + 1;
  auto surface = vtktest::MakePolyData(bar);
  vtktest::AddHandles(
    surface, [](const Eigen::Vector3d& p) { return p[2] < 0.4 ? 1
                                              : p[2] > 3.6    ? 2
                                                              : 0; });
  vtktest::AddArray(surface, "JoinedPoints", 1,
    [&](vtkIdType v, double* id) { *id = v == added + 1 || v == corner ? corner : -1; });
  vtkNew<vtkHandleMotion> motion;
  motion->SetScale(2.0, 2.0, 2.0);
  vtkNew<Filter> filter;
  auto log = vtktest::Observe(filter);
  filter->SetInputData(surface);
  filter->SetHandleMotion(1, motion);
  filter->SetHandleMotion(2, motion);
  filter->GenerateScaleFactorOn();
  filter->Update();
  EXPECT_TRUE(log->Errors.empty());
  ASSERT_NE(OutputArray(filter, "ScaleFactor"), nullptr);
  for (vtkIdType v = 0; v < surface->GetNumberOfPoints(); ++v)
  {
    EXPECT_NEAR(OutputArray(filter, "ScaleFactor")->GetTuple1(v), 2.0, 1e-9) << v;
  }
}

// Squares of such lengths are no numbers any more.
TEST(vtkSimilarityDeformation, ScalesOfFarMotionsAreFinite)
{
  vtkNew<vtkHandleMotion> motion;
  motion->SetTranslation(1e200, -2e200, 3e200);
  vtkNew<Filter> filter;
  auto log = vtktest::Observe(filter);
  auto surface = MarkedBar();
  filter->SetInputData(surface);
  filter->SetHandleMotion(2, motion);
  filter->GenerateScaleFactorOn();
  for (const int refits : { 0, 2 })
  {
    filter->SetRefits(refits);
    filter->Update();
    EXPECT_TRUE(log->Errors.empty());
    vtkDataArray* scales = OutputArray(filter, "ScaleFactor");
    ASSERT_NE(scales, nullptr);
    for (vtkIdType i = 0; i < scales->GetNumberOfTuples(); ++i)
    {
      EXPECT_TRUE(std::isfinite(scales->GetTuple1(i))) << i;
    }
  }
}

TEST(vtkSimilarityDeformation, HoldsPositionsOrTransformsAlone)
{
  auto surface = MarkedBar();
  vtkNew<vtkHandleMotion> motion;
  motion->SetAxis(1.0, 0.0, 0.0);
  motion->SetAngle(40.0);
  vtkNew<Filter> filter;
  auto log = vtktest::Observe(filter);
  filter->SetInputData(surface);
  filter->SetHandleMotion(2, motion);
  filter->Update();
  const cartan::Points full = vtktest::PointsOf(filter->GetOutput());
  filter->ConstrainHandleTransformsOff();
  filter->Update();
  const cartan::Points positions = vtktest::PointsOf(filter->GetOutput());
  filter->ConstrainHandleTransformsOn();
  filter->ConstrainHandlePositionsOff();
  filter->Update();
  const cartan::Points transforms = vtktest::PointsOf(filter->GetOutput());
  vtktest::ExpectQuiet(*log);
  EXPECT_TRUE(positions.allFinite());
  EXPECT_TRUE(transforms.allFinite());
  EXPECT_GT((positions - full).norm(), 1e-6);
  EXPECT_GT((transforms - full).norm(), 1e-3);
  filter->ConstrainHandleTransformsOff();
  filter->Update();
  vtktest::ExpectMessage(log->Errors, { "neither positions nor transforms" });
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(vtkSimilarityDeformation, WarnsOfMirrors)
{
  vtkNew<vtkHandleMotion> motion;
  motion->SetScale(-1.0, 1.0, 1.0);
  vtkNew<Filter> filter;
  auto log = vtktest::Observe(filter);
  filter->SetInputData(MarkedBar());
  filter->SetHandleMotion(2, motion);
  filter->Update();
  // Rotations equally close to a reflection are another reason to warn.
  ASSERT_FALSE(log->Warnings.empty());
  log->Warnings.resize(1);
  vtktest::ExpectMessage(log->Warnings, { "mirrors", "handle", "2" });
  EXPECT_TRUE(vtktest::PointsOf(filter->GetOutput()).allFinite());
}

TEST(vtkSimilarityDeformation, ClampsAndPrintsItsParameters)
{
  vtkNew<Filter> filter;
  EXPECT_EQ(filter->GetCoherenceRings(), 2);
  EXPECT_EQ(filter->GetReconstruction(), Filter::EDGE_FORM);
  filter->SetCoherenceRings(7);
  EXPECT_EQ(filter->GetCoherenceRings(), 2);
  filter->SetCoherenceRings(-1);
  EXPECT_EQ(filter->GetCoherenceRings(), 1);
  filter->SetRefits(-3);
  EXPECT_EQ(filter->GetRefits(), 0);
  filter->SetReconstruction(9);
  EXPECT_EQ(filter->GetReconstruction(), Filter::EDGE_FORM);
  std::ostringstream text;
  filter->Print(text);
  EXPECT_NE(text.str().find("ScaleFeatures"), std::string::npos);
  EXPECT_NE(text.str().find("ConstrainHandleTransforms"), std::string::npos);
}
