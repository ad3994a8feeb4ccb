// SPDX-License-Identifier: BSD-3-Clause
#include "AdviceWords.h"
#include "TestShapes.h"
#include "VtkTestHelpers.h"

#include "vtkAsRigidAsPossibleDeformation.h"
#include "vtkHandleMotion.h"
#include "vtkLaplacianDeformation.h"
#include "vtkPrepareSurface.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkShapePreservingDeformation.h"
#include "vtkSimilarityDeformation.h"

/// Where rounding decides about a deformation, it says so, and what helps.
namespace
{
/// Triangles around a point; two points of the rim are handles.
vtkSmartPointer<vtkPolyData> Fan()
{
  shapes::Shape fan;
  fan.Positions = cartan::Points::Zero(8, 3);
  fan.Faces.resize(6, 3);
  for (int i = 0; i < 7; ++i)
  {
    fan.Positions.row(i + 1) << std::cos(0.9 * i), std::sin(0.9 * i), 0.05 * (i % 2);
  }
  for (int i = 0; i < 6; ++i)
  {
    fan.Faces.row(i) << 0, i + 1, i + 2;
  }
  auto surface = vtktest::MakePolyData(fan);
  vtktest::AddHandles(surface,
    [&fan](const Eigen::Vector3d& p)
    {
      const auto is = [&](int v) { return (p - fan.Positions.row(v).transpose()).norm() < 1e-9; };
      return is(3) ? 1 : is(6) ? 2 : 0;
    });
  return surface;
}

std::string Joined(const std::vector<std::string>& texts)
{
  std::string joined;
  for (const std::string& text : texts)
  {
    joined += text;
  }
  return joined;
}

/// The messages of a filter that turns handle 1.
template <typename Filter>
std::string WarningsOf(Filter* filter, vtkPolyData* surface, double angle)
{
  vtkNew<vtkHandleMotion> motion;
  motion->SetAxis(0.3, 1.0, 0.2);
  motion->SetAngle(angle);
  filter->SetInputData(surface);
  filter->SetHandleMotion(1, motion);
  auto log = vtktest::Observe(filter);
  filter->Update();
  EXPECT_EQ(log->Errors.size(), 0u);
  return Joined(log->Warnings);
}

TEST(RoundingCheck, SaysWhereHandlesLeaveThePlaceOpen)
{
  // Two points say nothing of how the triangles turn about the line through them.
  auto fan = Fan();
  vtkNew<vtkLaplacianDeformation> implicit;
  implicit->SetRotations(vtkLaplacianDeformation::IMPLICIT);
  implicit->SetLaplacianWeightsToUniform();
  const std::string warning = WarningsOf(implicit.Get(), fan, 40.0);
  for (const std::string& part : { std::string("Rounding decides"),
         shapes::Advice("hold more points, use smaller motions, or Rotation Invariant Deformation "
                        "with uniform LaplacianWeights and FrameProjection off.") })
  {
    EXPECT_NE(warning.find(part), std::string::npos) << warning;
  }

  vtkNew<vtkLaplacianDeformation> unchecked;
  unchecked->SetRotations(vtkLaplacianDeformation::IMPLICIT);
  unchecked->SetLaplacianWeightsToUniform();
  unchecked->SetRoundingCheckLimit(0);
  EXPECT_EQ(WarningsOf(unchecked.Get(), fan, 40.0), "");

  // What it advises.
  vtkNew<vtkRotationInvariantDeformation> linear;
  linear->SetLaplacianWeightsToUniform();
  linear->SetFrameProjection(vtkRotationInvariantDeformation::NONE);
  EXPECT_EQ(WarningsOf(linear.Get(), fan, 40.0), "");
}

TEST(RoundingCheck, IsQuietWhereThePlaceIsDetermined)
{
  auto bar = vtktest::MakePolyData(shapes::Bar(3, 3, 12, { 0.6, 0.6, 2.0 }));
  vtktest::AddHandles(
    bar, [](const Eigen::Vector3d& p) { return p[2] < 0.4 ? 2 : (p[2] > 1.6 ? 1 : 0); });
  const auto expectQuiet = [&bar](auto filter)
  {
    filter->GenerateRotationVectorOn();
    EXPECT_EQ(WarningsOf(filter.Get(), bar, 100.0), "");
    EXPECT_EQ(filter->GetNumberOfFactorizations(), 1) << "those of the check do not count";
  };
  expectQuiet(vtkSmartPointer<vtkRotationInvariantDeformation>::New());
  expectQuiet(vtkSmartPointer<vtkShapePreservingDeformation>::New());
}

/// Two triangles on an edge whose ends are handles 1 and 2. A tip takes the mean of their maps:
/// with half a turn of one of them that is a projection on its axis, which leaves the turn about
/// it open, for motions alone and not for where the points are.
vtkSmartPointer<vtkPolyData> TwoTriangles(bool isTipHeld)
{
  shapes::Shape pair;
  pair.Positions.resize(4, 3);
  pair.Positions << 0.0, 0.0, 0.0, 1.0, 0.1, 0.2, 0.4, 0.9, 0.1, 0.5, -0.8, 0.3;
  pair.Faces.resize(2, 3);
  pair.Faces << 0, 1, 2, 1, 0, 3;
  auto surface = vtktest::MakePolyData(pair);
  vtktest::AddArray(surface, "Handle", 1,
    [isTipHeld](vtkIdType v, double* id) {
      *id = v < 2 ? static_cast<double>(v + 1) : isTipHeld ? 2.0 : 0.0;
    });
  return surface;
}

TEST(RoundingCheck, SaysWhereMotionsLeaveATurnOpen)
{
  const auto free = TwoTriangles(false);
  vtkNew<vtkSimilarityDeformation> half;
  const std::string warning = WarningsOf(half.Get(), free, 180.0);
  for (const std::string& part : { std::string("Rounding decides about 2 points"),
         shapes::Advice("hold more points, use smaller motions, or Rotation Invariant Deformation "
                        "with uniform LaplacianWeights and FrameProjection off.") })
  {
    EXPECT_NE(warning.find(part), std::string::npos) << warning;
  }

  // What it advises.
  vtkNew<vtkSimilarityDeformation> held;
  EXPECT_EQ(WarningsOf(held.Get(), TwoTriangles(true), 180.0), "");
  vtkNew<vtkSimilarityDeformation> smaller;
  EXPECT_EQ(WarningsOf(smaller.Get(), free, 170.0), "");
  vtkNew<vtkRotationInvariantDeformation> linear;
  linear->SetLaplacianWeightsToUniform();
  linear->SetFrameProjection(vtkRotationInvariantDeformation::NONE);
  EXPECT_EQ(WarningsOf(linear.Get(), free, 180.0), "");
}

/// The warnings of a bar of which handle 1 goes through a motion.
std::string WarningsOfBar(vtkSurfaceDeformation* filter, vtkHandleMotion* motion)
{
  auto bar = vtktest::MakePolyData(shapes::Bar(3, 3, 12, { 0.6, 0.6, 2.0 }));
  vtktest::AddHandles(
    bar, [](const Eigen::Vector3d& p) { return p[2] < 0.4 ? 2 : (p[2] > 1.6 ? 1 : 0); });
  filter->SetInputData(bar);
  filter->SetHandleMotion(1, motion);
  auto log = vtktest::Observe(filter);
  filter->Update();
  EXPECT_EQ(log->Errors.size(), 0u);
  return Joined(log->Warnings);
}

TEST(RoundingCheck, SaysWhereNoRotationIsTheNearest)
{
  vtkNew<vtkHandleMotion> inversion;
  inversion->SetScale(-1.0, -1.0, -1.0);
  vtkNew<vtkRotationInvariantDeformation> filter;
  filter->GenerateRotationVectorOn();
  const std::string warning = WarningsOfBar(filter, inversion);
  EXPECT_NE(warning.find("RotationVector means nothing at"), std::string::npos) << warning;
  EXPECT_NE(warning.find(shapes::Advice("Scale handles by positive numbers, or switch "
                                        "GenerateRotationVector off and GenerateFrameChange on.")),
    std::string::npos)
    << warning;

  vtkNew<vtkHandleMotion> growth;
  growth->SetScale(1.5, 1.5, 1.5);
  vtkNew<vtkRotationInvariantDeformation> positive;
  positive->GenerateRotationVectorOn();
  EXPECT_EQ(WarningsOfBar(positive, growth), "");

  vtkNew<vtkRotationInvariantDeformation> change;
  change->GenerateFrameChangeOn();
  EXPECT_EQ(WarningsOfBar(change, inversion), "");
}

TEST(RoundingCheck, SaysWhereCoordinatesHaveNoDigits)
{
  vtkNew<vtkHandleMotion> far;
  far->SetTranslation(1e13, 0.0, 0.0);
  vtkNew<vtkRotationInvariantDeformation> filter;
  const std::string warning = WarningsOfBar(filter, far);
  EXPECT_NE(warning.find("have no digits for its shape"), std::string::npos) << warning;
  EXPECT_NE(warning.find(shapes::Advice("Use smaller motions.")), std::string::npos) << warning;

  far->SetTranslation(1e3, 0.0, 0.0);
  vtkNew<vtkRotationInvariantDeformation> nearer;
  EXPECT_EQ(WarningsOfBar(nearer, far), "");
}

TEST(RoundingCheck, SaysWhereRoundingDecidesAboutThinTriangles)
{
  // Points as high over an edge, in parts of it, as a cap that is taken out is low.
  shapes::Shape bar = shapes::Bar(3, 3, 12, { 0.6, 0.6, 2.0 });
  const auto count = static_cast<int>(bar.Faces.rows());
  std::vector<Eigen::Vector3i> faces;
  std::vector<Eigen::Vector3d> points;
  for (int v = 0; v < bar.NumberOfVertices(); ++v)
  {
    points.push_back(bar.Positions.row(v).transpose());
  }
  for (int t = 0; t < count; ++t)
  {
    // Near the diagonal of a square, which is flat.
    Eigen::Vector3i face = bar.Faces.row(t).transpose();
    const auto lengthOf = [&](int i, int j) { return (points[face[i]] - points[face[j]]).norm(); };
    while (lengthOf(0, 1) < std::max(lengthOf(1, 2), lengthOf(2, 0)))
    {
      face = Eigen::Vector3i(face[1], face[2], face[0]);
    }
    const Eigen::Vector3d a = points[face[0]];
    const Eigen::Vector3d b = points[face[1]];
    const Eigen::Vector3d normal = (b - a).cross(points[face[2]] - a);
    const Eigen::Vector3d up = normal.cross(b - a).normalized() * (b - a).norm();
    const auto added = static_cast<int>(points.size());
    points.push_back(0.5 * (a + b) + 0.05 * up);
    faces.emplace_back(face[0], face[1], added);
    faces.emplace_back(face[1], face[2], added);
    faces.emplace_back(face[2], face[0], added);
  }
  const shapes::Shape spoiled{ shapes::ToPoints(points), shapes::ToTriangles(faces) };
  auto surface = vtktest::MakePolyData(spoiled);
  vtktest::AddHandles(
    surface, [](const Eigen::Vector3d& p) { return p[2] < 0.4 ? 2 : (p[2] > 1.6 ? 1 : 0); });
  vtkNew<vtkRotationInvariantDeformation> filter;
  const std::string warning = WarningsOf(filter.Get(), surface, 60.0);
  EXPECT_NE(warning.find("It decides which thin triangles the surface is solved without"),
    std::string::npos)
    << warning;
  EXPECT_NE(warning.find(shapes::Advice("flip edges first (Prepare Surface, Flip Edges).")),
    std::string::npos)
    << warning;

  vtkNew<vtkPrepareSurface> flip;
  flip->SetInputData(surface);
  flip->FlipEdgesOn();
  flip->Update();
  vtkNew<vtkRotationInvariantDeformation> after;
  EXPECT_EQ(WarningsOf(after.Get(), flip->GetOutput(), 60.0), "");
}

TEST(RoundingCheck, EnergiesBeyondDoublePrecisionAreErrors)
{
  auto bar = vtktest::MakePolyData(shapes::Bar(3, 3, 12, { 0.6, 0.6, 2.0 }));
  vtktest::AddHandles(
    bar, [](const Eigen::Vector3d& p) { return p[2] < 0.4 ? 2 : (p[2] > 1.6 ? 1 : 0); });
  vtkNew<vtkHandleMotion> motion;
  motion->SetTranslation(1e199, 0.0, 0.0);
  vtkNew<vtkAsRigidAsPossibleDeformation> filter;
  filter->SetInputData(bar);
  filter->SetHandleMotion(1, motion);
  auto log = vtktest::Observe(filter.Get());
  filter->Update();
  EXPECT_EQ(log->Errors.size(), 1u);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
}
}
