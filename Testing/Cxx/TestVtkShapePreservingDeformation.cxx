// SPDX-License-Identifier: BSD-3-Clause
#include "vtkShapePreservingDeformation.h"

#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Differential/Curvature.h"
#include "Kernel/Measure/Areas.h"
#include "Kernel/Measure/ComponentVolumes.h"
#include "Kernel/Measure/EdgeLengths.h"
#include "Kernel/Measure/ShapeDistance.h"
#include "VtkTestHelpers.h"
#include "vtkHandleMotion.h"
#include "vtkRotationInvariantDeformation.h"

#include "vtkSMPTools.h"

#include <algorithm>
#include <cmath>
#include <sstream>

using cartan::Points;
using shapes::Shape;
using vtktest::MakePolyData;

namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();

/// The bar of the paper's Table I, 1 x 1 x 5 with 4400 triangles; handle 1 below
/// and handle 2 above the given parts of its length.
Shape TableBar()
{
  return shapes::Bar(10, 10, 50, { 1.0, 1.0, 5.0 });
}

Shape SmallBar()
{
  return shapes::Bar(4, 4, 20, { 1.0, 1.0, 5.0 });
}

vtkSmartPointer<vtkPolyData> Marked(
  const Shape& bar, double pinned = 0.16, double moving = 0.84, int precision = VTK_DOUBLE)
{
  auto surface = MakePolyData(bar, precision);
  const double length = bar.Positions.col(2).maxCoeff();
  vtktest::AddHandles(surface,
    [=](const Eigen::Vector3d& p)
    {
      const double part = p[2] / length;
      return part <= pinned + 1e-6 ? 1 : (part >= moving - 1e-6 ? 2 : 0);
    });
  return surface;
}

/// Makes the point at the bottom center, amid handle 1, a pinned handle 3: seen
/// from one of two handles, the other turns about one axis.
vtkSmartPointer<vtkPolyData> PinnedAtTheBottom(vtkSmartPointer<vtkPolyData> surface)
{
  surface->GetPointData()->GetArray("Handle")->SetTuple1(surface->FindPoint(0.0, 0.0, 0.0), 3.0);
  return surface;
}

vtkSmartPointer<vtkHandleMotion> Turn(
  double degrees, const Eigen::Vector3d& axis = Eigen::Vector3d::UnitY())
{
  auto motion = vtkSmartPointer<vtkHandleMotion>::New();
  motion->SetAxis(axis.data());
  motion->SetAngle(degrees);
  return motion;
}

Points Update(vtkSurfaceDeformation* filter)
{
  const auto log = vtktest::Observe(filter);
  filter->Update();
  vtktest::ExpectQuiet(*log);
  return vtktest::PointsOf(filter->GetOutput());
}

double VolumeOf(const Shape& shape, const Points& points)
{
  return cartan::MeasureComponents(shapes::MakeMesh(shape), points)[0].Volume;
}

double RootMeanSquare(const Eigen::VectorXd& values)
{
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

vtkDoubleArray* PointArray(vtkPolyData* surface, const char* name)
{
  return vtkDoubleArray::SafeDownCast(surface->GetPointData()->GetArray(name));
}

double FieldValue(vtkPolyData* surface, const char* name)
{
  vtkDataArray* array = surface->GetFieldData()->GetArray(name);
  EXPECT_NE(array, nullptr) << name;
  return array ? array->GetComponent(0, 0) : std::nan("");
}

/// The rotation that each point's frame goes through, from the array.
Eigen::Matrix3d RotationAt(vtkPolyData* surface, vtkIdType v)
{
  Eigen::Vector3d vector;
  PointArray(surface, "RotationVector")->GetTuple(v, vector.data());
  return cartan::RotationFromVector(vector);
}

/// The middle of a bar of length 5 bent to a circular arc of angle `angle` about
/// y, rigid below z = from and above z = to.
Points ExactlyBent(const Points& bar, double from, double to, double angle)
{
  Points bent = bar;
  const double radius = (to - from) / angle;
  for (Eigen::Index v = 0; v < bar.rows(); ++v)
  {
    const double along = std::min(std::max(bar(v, 2) - from, 0.0), to - from);
    const double beyond = bar(v, 2) - from - along;
    const double turn = along / radius;
    const Eigen::Vector3d outwards(std::cos(turn), 0.0, -std::sin(turn));
    const Eigen::Vector3d onwards(std::sin(turn), 0.0, std::cos(turn));
    bent.row(v) = (Eigen::Vector3d(radius, bar(v, 1), from) + (bar(v, 0) - radius) * outwards +
      beyond * onwards)
                    .transpose();
  }
  return bent;
}

/// The points of a 1 x 1 x 5 bar that are at least `distance` away from its
/// edges, where it has no curvature.
std::vector<int> AwayFromEdges(const Shape& bar, double distance)
{
  std::vector<int> away;
  for (int v = 0; v < bar.NumberOfVertices(); ++v)
  {
    const Eigen::Vector3d p = bar.Positions.row(v);
    const Eigen::Vector3d toSide(
      0.5 - std::abs(p[0]), 0.5 - std::abs(p[1]), std::min(p[2], 5.0 - p[2]));
    if ((toSide.array() > distance - 1e-9).count() == 2)
    {
      away.push_back(v);
    }
  }
  return away;
}
}

TEST(ShapePreservingDeformation, ReproducesThePublishedVolumesOfTheBar)
{
  struct Row
  {
    double Degrees;
    double Paper;      // without correction
    double WithOffset; // at most 1.15 times what a reference implementation left over
  };
  const Shape bar = TableBar();
  vtkNew<vtkShapePreservingDeformation> filter;
  filter->SetInputData(Marked(bar));
  filter->ConstrainHandlePositionsOff();
  const auto change = [&]() { return VolumeOf(bar, Update(filter)) / 5.0 - 1.0; };
  for (const Row& row : { Row{ 90.0, 0.0473, 0.006 }, Row{ 180.0, 0.143, 0.022 },
         Row{ 360.0, 0.37, 0.058 }, Row{ 540.0, 0.53, 0.083 } })
  {
    filter->SetHandleMotion(2, Turn(row.Degrees));
    filter->CloseVolumeOff();
    filter->SetVolumeCorrectionToNone();
    EXPECT_NEAR(-change(), row.Paper, 0.15 * row.Paper);
    filter->SetVolumeCorrectionToNeutralOffset();
    EXPECT_LT(std::abs(change()), 1.15 * row.WithOffset);
    filter->CloseVolumeOn();
    EXPECT_LT(std::abs(change()), 1e-6);
  }
  EXPECT_EQ(filter->GetNumberOfFactorizations(), 2);
}

TEST(ShapePreservingDeformation, BendsABarAllButExactly)
{
  // By three half turns, to a circular arc and a half.
  const Shape bar = TableBar();
  const Points exact = ExactlyBent(bar.Positions, 0.8, 4.2, 3.0 * shapes::Pi);
  // But for the chords of its triangles, of which 34 go around one and a half turns.
  EXPECT_NEAR(VolumeOf(bar, exact), 5.0, 0.05);
  vtkNew<vtkShapePreservingDeformation> filter;
  filter->SetInputData(Marked(bar));
  filter->SetHandleMotion(2, Turn(540.0));
  filter->ConstrainHandlePositionsOff();
  const auto distance = [&]()
  { return std::sqrt((Update(filter) - exact).squaredNorm() / bar.NumberOfVertices()); };
  filter->SetVolumeCorrectionToNone();
  const double none = distance();
  filter->SetVolumeCorrectionToFrameScaling();
  const double scaling = distance();
  filter->SetVolumeCorrectionToNeutralOffset();
  const double offset = distance();
  filter->CloseVolumeOn();
  const double closed = distance();
  shapes::ShowFigure("rms distance from the exact bend, no correction", none);
  shapes::ShowFigure("frame scaling", scaling);
  shapes::ShowFigure("neutral offset", offset);
  shapes::ShowFigure("neutral offset, closed", closed);
  EXPECT_LE(offset, 0.045);
  EXPECT_LE(closed, 0.045);
  EXPECT_LT(closed, 0.25 * scaling);
  EXPECT_LT(scaling, none);
}

TEST(ShapePreservingDeformation, KeepsCurvatureBetterThanRotationInvariantEditing)
{
  // The points away from the bar's edges by two rings, which is what the fit of
  // curvatures looks at: nearer ones see the edge and tell nothing of the bend.
  const Shape bar = TableBar();
  const auto mesh = shapes::MakeMesh(bar);
  const auto surface = Marked(bar, 0.15, 0.85);
  const std::vector<int> chosen = AwayFromEdges(bar, 0.2);
  ASSERT_GT(chosen.size(), 1000u);
  const Eigen::VectorXd rest = cartan::FitCurvatures(mesh, bar.Positions).Mean;
  struct Figures
  {
    double Edges;
    double Curvature;
    double CurvatureEverywhere;
  };
  const auto measure = [&](vtkFrameDeformation* filter)
  {
    filter->SetInputData(surface);
    filter->SetHandleMotion(2, Turn(170.0));
    filter->ConstrainHandlePositionsOff();
    filter->SetVolumeCorrectionToNone();
    const Points points = Update(filter);
    const Eigen::VectorXd error = cartan::FitCurvatures(mesh, points).Mean - rest;
    Eigen::VectorXd errors(static_cast<Eigen::Index>(chosen.size()));
    for (std::size_t i = 0; i < chosen.size(); ++i)
    {
      errors[static_cast<Eigen::Index>(i)] = error[chosen[i]];
    }
    return Figures{ cartan::CompareEdgeLengths(mesh, bar.Positions, points).RootMeanSquare,
      RootMeanSquare(errors), RootMeanSquare(error) };
  };
  vtkNew<vtkShapePreservingDeformation> shape;
  vtkNew<vtkRotationInvariantDeformation> blend;
  blend->SetFrameProjectionToRotation();
  const Figures ours = measure(shape);
  const Figures theirs = measure(blend);
  shapes::ShowFigure("edge length rms", ours.Edges);
  shapes::ShowFigure("edge length rms of rotation-invariant editing", theirs.Edges);
  shapes::ShowFigure("mean curvature error rms", ours.Curvature);
  shapes::ShowFigure("mean curvature error rms of rotation-invariant editing", theirs.Curvature);
  EXPECT_NEAR(ours.Edges, theirs.Edges, 0.02 * theirs.Edges);
  EXPECT_LT(ours.Curvature, theirs.Curvature / 2.5);
  EXPECT_LT(ours.CurvatureEverywhere, theirs.CurvatureEverywhere / 2.5);
}

TEST(FrameDeformation, CorrectsTheVolumeOfRotationInvariantEditingToo)
{
  const Shape bar = TableBar();
  vtkNew<vtkRotationInvariantDeformation> filter;
  filter->SetInputData(Marked(bar, 0.15, 0.85));
  filter->SetHandleMotion(2, Turn(170.0));
  filter->ConstrainHandlePositionsOff();
  filter->SetPositionWeightsToUniform();
  EXPECT_EQ(filter->GetVolumeCorrection(), vtkFrameDeformation::NO_CORRECTION);
  const double without = VolumeOf(bar, Update(filter)) / 5.0;
  filter->SetVolumeCorrectionToNeutralOffset();
  const double with = VolumeOf(bar, Update(filter)) / 5.0;
  shapes::ShowFigure("volume of a bend by 170 degrees, uncorrected", without);
  shapes::ShowFigure("with the offset", with);
  EXPECT_LT(without, 0.85);
  EXPECT_GT(with, 0.965);
  EXPECT_LT(with, 1.0);
  filter->CloseVolumeOn();
  EXPECT_NEAR(VolumeOf(bar, Update(filter)) / 5.0, 1.0, 1e-9);
}

TEST(FrameDeformation, NeutralOffsetKeepsTheVolumeOfATwist)
{
  const Shape bar = TableBar();
  vtkNew<vtkShapePreservingDeformation> filter;
  filter->SetInputData(Marked(bar));
  filter->SetHandleMotion(2, Turn(180.0, Eigen::Vector3d::UnitZ()));
  filter->SetVolumeCorrectionToNone();
  const double without = VolumeOf(bar, Update(filter)) / 5.0 - 1.0;
  filter->SetVolumeCorrectionToNeutralOffset();
  const double with = VolumeOf(bar, Update(filter)) / 5.0 - 1.0;
  shapes::ShowFigure("volume of a twist by half a turn, uncorrected", without);
  shapes::ShowFigure("with the offset", with);
  EXPECT_LT(without, -0.1);
  EXPECT_LT(std::abs(with), 0.25 * std::abs(without));
}

TEST(ShapePreservingDeformation, TurnsFourTimesAsFarByFourTimesTheAngle)
{
  const Shape bar = SmallBar();
  const Eigen::Vector3d axis(0.3, 1.0, -0.2);
  vtkNew<vtkShapePreservingDeformation> once;
  once->SetInputData(Marked(bar));
  once->SetHandleMotion(2, Turn(120.0, axis));
  once->GenerateRotationVectorOn();
  Update(once);
  vtkNew<vtkShapePreservingDeformation> fourTimes;
  fourTimes->SetInputData(Marked(bar));
  fourTimes->SetHandleMotion(2, Turn(480.0, axis));
  fourTimes->GenerateRotationVectorOn();
  Update(fourTimes);
  for (int v = 0; v < bar.NumberOfVertices(); ++v)
  {
    Eigen::Vector3d vector;
    PointArray(once->GetOutput(), "RotationVector")->GetTuple(v, vector.data());
    EXPECT_LT(
      (cartan::RotationFromVector(4.0 * vector) - RotationAt(fourTimes->GetOutput(), v)).norm(),
      1e-10);
  }
}

TEST(ShapePreservingDeformation, BendsAMaterialLineByTheWholeAngle)
{
  // The direction of a line along the bar's axis, followed from end to end. The
  // line lies in the side that the axis of the bend is perpendicular to, so it
  // is neither on the outside nor on the inside.
  const Shape bar = TableBar();
  std::vector<int> line;
  for (int v = 0; v < bar.NumberOfVertices(); ++v)
  {
    if (std::abs(bar.Positions(v, 0)) < 1e-9 && std::abs(bar.Positions(v, 1) - 0.5) < 1e-9)
    {
      line.push_back(v);
    }
  }
  ASSERT_EQ(line.size(), 51u);
  std::sort(line.begin(), line.end(),
    [&](int a, int b) { return bar.Positions(a, 2) < bar.Positions(b, 2); });
  vtkNew<vtkShapePreservingDeformation> filter;
  filter->SetInputData(Marked(bar));
  filter->ConstrainHandlePositionsOff();
  for (const double degrees : { 120.0, 480.0, -480.0 })
  {
    filter->SetHandleMotion(2, Turn(degrees));
    const Points points = Update(filter);
    double turned = 0.0;
    for (std::size_t i = 2; i < line.size(); ++i)
    {
      const Eigen::RowVector3d before = points.row(line[i - 1]) - points.row(line[i - 2]);
      const Eigen::RowVector3d after = points.row(line[i]) - points.row(line[i - 1]);
      // Positive from z to x, which is how y turns.
      turned += std::atan2(
        before[2] * after[0] - before[0] * after[2], before[0] * after[0] + before[2] * after[2]);
    }
    // The handles do not turn exactly: their positions are free.
    EXPECT_NEAR(turned * 180.0 / shapes::Pi, degrees, 1e-3);
  }
}

TEST(ShapePreservingDeformation, WindsAMaterialLineByTheLapsOfTheHandle)
{
  // The polar angle about the bar's axis, followed along an edge from end to end.
  const Shape bar = TableBar();
  std::vector<int> line;
  for (int v = 0; v < bar.NumberOfVertices(); ++v)
  {
    if (bar.Positions(v, 0) > 0.49 && bar.Positions(v, 1) > 0.49)
    {
      line.push_back(v);
    }
  }
  ASSERT_EQ(line.size(), 51u);
  std::sort(line.begin(), line.end(),
    [&](int a, int b) { return bar.Positions(a, 2) < bar.Positions(b, 2); });
  vtkNew<vtkShapePreservingDeformation> filter;
  filter->SetInputData(Marked(bar));
  for (const double degrees : { 480.0, -480.0, 1200.0 })
  {
    filter->SetHandleMotion(2, Turn(degrees, Eigen::Vector3d::UnitZ()));
    const Points points = Update(filter);
    double wound = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i)
    {
      const Eigen::RowVector2d a = points.row(line[i - 1]).head<2>();
      const Eigen::RowVector2d b = points.row(line[i]).head<2>();
      wound += std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
    }
    EXPECT_NEAR(wound * 180.0 / shapes::Pi, degrees, 1e-9);
  }
}

TEST(ShapePreservingDeformation, MovesRigidlyWhenAllHandlesDo)
{
  const Shape bar = SmallBar();
  const shapes::RigidMotion rigid = shapes::RandomRigidMotion(3, 7.0);
  const Eigen::Vector3d vector = cartan::VectorFromRotation(rigid.Rotation);
  for (const double laps : { 0.0, 2.0 })
  {
    auto motion = Turn(vector.norm() * 180.0 / shapes::Pi + 360.0 * laps, vector.normalized());
    motion->SetTranslation(Eigen::Vector3d(rigid.Translation).data());
    vtkNew<vtkShapePreservingDeformation> filter;
    filter->SetInputData(Marked(bar));
    filter->SetHandleMotion(1, motion);
    filter->SetHandleMotion(2, motion);
    filter->GenerateShapeDistanceOn();
    for (int correction = vtkFrameDeformation::NO_CORRECTION;
         correction <= vtkFrameDeformation::NEUTRAL_OFFSET; ++correction)
    {
      for (const bool close : { false, true })
      {
        filter->SetVolumeCorrection(correction);
        filter->SetCloseVolume(close);
        const Points points = Update(filter);
        EXPECT_LT((points - rigid(bar.Positions)).cwiseAbs().maxCoeff(), 1e-10)
          << correction << close;
        EXPECT_LT(FieldValue(filter->GetOutput(), "ShapeDistance"), 1e-10);
      }
    }
  }
}

TEST(ShapePreservingDeformation, HasTheSameDistanceWhereverTheSurfaceIs)
{
  const Shape bar = SmallBar();
  vtkNew<vtkShapePreservingDeformation> filter;
  filter->SetInputData(Marked(bar));
  filter->SetHandleMotion(2, Turn(200.0));
  filter->GenerateShapeDistanceOn();
  Update(filter);
  const double expected = FieldValue(filter->GetOutput(), "ShapeDistance");
  EXPECT_GT(expected, 1.0);

  // A rigid motion of the surface at rest and another of the deformed one.
  const shapes::RigidMotion before = shapes::RandomRigidMotion(4, 3.0);
  const shapes::RigidMotion after = shapes::RandomRigidMotion(5, 3.0);
  auto moved = Marked(bar);
  const Points points = before(bar.Positions);
  for (int v = 0; v < bar.NumberOfVertices(); ++v)
  {
    moved->GetPoints()->SetPoint(v, points.row(v).data());
  }
  vtkNew<vtkShapePreservingDeformation> other;
  other->SetInputData(moved);
  other->SetHandleMotion(2, Turn(200.0, before.Rotation * Eigen::Vector3d::UnitY()));
  other->GenerateShapeDistanceOn();
  const Points elsewhere = Update(other);
  EXPECT_NEAR(FieldValue(other->GetOutput(), "ShapeDistance"), expected, 1e-10 * expected);
  const auto mesh = shapes::MakeMesh(bar);
  const double measured = cartan::MeasureShapeDistance(mesh, points, elsewhere).Total;
  EXPECT_NEAR(cartan::MeasureShapeDistance(mesh, bar.Positions, after(elsewhere)).Total, measured,
    1e-10 * measured);
}

TEST(ShapePreservingDeformation, FactorizesOnceForTenMotions)
{
  vtkNew<vtkShapePreservingDeformation> filter;
  filter->SetInputData(Marked(SmallBar()));
  auto motion = Turn(0.0);
  filter->SetHandleMotion(2, motion);
  filter->CloseVolumeOn();
  filter->GenerateVolumeArraysOn();
  const auto tenMotions = [&]()
  {
    for (int i = 1; i <= 10; ++i)
    {
      motion->SetAngle(motion->GetAngle() + 20.0);
      motion->SetAxis(0.0, 1.0, 0.1 * i);
      filter->SetVolumeCorrection(i % 3);
      Update(filter);
    }
    return filter->GetNumberOfFactorizations();
  };
  EXPECT_EQ(tenMotions(), 1);
  filter->ConstrainHandlePositionsOff();
  EXPECT_EQ(tenMotions(), 3);
  // What was prepared before is kept.
  filter->ConstrainHandlePositionsOn();
  EXPECT_EQ(tenMotions(), 3);
  filter->SetPositionWeightsToUniform();
  EXPECT_EQ(tenMotions(), 5);
  filter->SetPositionWeightsToLikeFrames();
  EXPECT_EQ(tenMotions(), 5);
  // Named explicitly, the same weights serve both as well.
  filter->SetPositionWeightsToCotangent();
  EXPECT_EQ(tenMotions(), 6);
}

TEST(ShapePreservingDeformation, TellsHowItFoundTheField)
{
  vtkNew<vtkShapePreservingDeformation> filter;
  filter->SetInputData(PinnedAtTheBottom(Marked(SmallBar())));
  filter->SetHandleMotion(2, Turn(480.0));
  Update(filter);
  EXPECT_TRUE(filter->GetSharedAxis());
  EXPECT_EQ(filter->GetNumberOfIterations(), 0);
  EXPECT_EQ(filter->GetResidual(), 0.0);
  EXPECT_TRUE(filter->GetConverged());

  filter->SetHandleMotion(1, Turn(30.0, Eigen::Vector3d::UnitX()));
  filter->SetHandleMotion(2, Turn(120.0));
  Update(filter);
  EXPECT_FALSE(filter->GetSharedAxis());
  EXPECT_EQ(filter->GetNumberOfIterations(), 1);
  const int factorizations = filter->GetNumberOfFactorizations();

  filter->SetMaximumIterations(50);
  filter->SetTolerance(1e-8);
  Update(filter);
  EXPECT_FALSE(filter->GetSharedAxis());
  EXPECT_GT(filter->GetNumberOfIterations(), 2);
  EXPECT_LT(filter->GetNumberOfIterations(), 20);
  EXPECT_GT(filter->GetResidual(), 0.0);
  EXPECT_LE(filter->GetResidual(), 1e-8);
  EXPECT_TRUE(filter->GetConverged());
  EXPECT_EQ(
    filter->GetNumberOfFactorizations(), factorizations + filter->GetNumberOfIterations() - 1);

  const auto log = vtktest::Observe(filter);
  filter->SetMaximumIterations(2);
  filter->Update();
  EXPECT_FALSE(filter->GetConverged());
  EXPECT_GT(filter->GetResidual(), 1e-8);
  vtktest::ExpectMessage(log->Warnings, { "has not converged", "Allow more iterations" });
  EXPECT_TRUE(log->Errors.empty());
}

TEST(FrameDeformation, WritesItsArraysOnRequest)
{
  const Shape bar = SmallBar();
  const auto mesh = shapes::MakeMesh(bar);
  const auto surface = Marked(bar);
  vtkNew<vtkDoubleArray> field;
  field->SetName("Field");
  field->InsertNextValue(3.0);
  surface->GetFieldData()->AddArray(field);
  const auto copy = vtktest::CopyOf(surface);
  vtkNew<vtkShapePreservingDeformation> filter;
  filter->SetInputData(surface);
  filter->SetHandleMotion(2, Turn(150.0));
  Update(filter);
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetNumberOfArrays(), 1);
  EXPECT_EQ(filter->GetOutput()->GetFieldData()->GetNumberOfArrays(), 1);

  filter->GenerateVolumeArraysOn();
  filter->GenerateShapeDistanceOn();
  for (int correction = 0; correction <= 2; ++correction)
  {
    filter->SetVolumeCorrection((correction + 1) % 3);
    const Points points = Update(filter);
    vtkPolyData* output = filter->GetOutput();
    for (const char* name : { "LocalDepth", "LocalVolume", "VolumeScale", "ShapeDistanceDensity" })
    {
      ASSERT_NE(PointArray(output, name), nullptr) << name;
      EXPECT_EQ(PointArray(output, name)->GetNumberOfTuples(), bar.NumberOfVertices());
      EXPECT_EQ(PointArray(output, name)->GetNumberOfComponents(), 1);
    }
    double volume = 0.0;
    double distance = 0.0;
    double furthest = 0.0;
    const Eigen::VectorXd areas =
      cartan::BarycentricAreas(mesh, cartan::TriangleAreas(mesh, bar.Positions));
    for (int v = 0; v < bar.NumberOfVertices(); ++v)
    {
      volume += PointArray(output, "LocalVolume")->GetValue(v);
      distance += PointArray(output, "ShapeDistanceDensity")->GetValue(v) * areas[v];
      furthest = std::max(furthest, std::abs(PointArray(output, "VolumeScale")->GetValue(v) - 1.0));
    }
    EXPECT_NEAR(volume, VolumeOf(bar, points), 1e-9);
    EXPECT_NEAR(distance, FieldValue(output, "ShapeDistance"), 1e-12 * std::max(1.0, distance));
    EXPECT_EQ(output->GetFieldData()->GetArray("ShapeDistance")->GetNumberOfTuples(), 1);
    // Only frame scaling scales; what it did before leaves no trace.
    EXPECT_EQ(furthest > 0.0, filter->GetVolumeCorrection() == vtkFrameDeformation::FRAME_SCALING)
      << filter->GetVolumeCorrection();
  }
  EXPECT_EQ(FieldValue(filter->GetOutput(), "Field"), 3.0);
  vtktest::ExpectSameSurface(surface, copy);

  filter->GenerateVolumeArraysOff();
  filter->GenerateShapeDistanceOff();
  Update(filter);
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetNumberOfArrays(), 1);
  EXPECT_EQ(filter->GetOutput()->GetFieldData()->GetNumberOfArrays(), 1);
}

TEST(FrameDeformation, MeasuresTheDepthInAnyUnitAndPlace)
{
  const double halfAngle = 15.0 / 180.0 * shapes::Pi;
  const double expected = (1.0 + 6.0 / std::cos(halfAngle)) / 7.0;
  for (const double size : { 1e-9, 1.0, 1e6 })
  {
    for (const double place : { 0.0, 1e5 })
    {
      Shape bar = shapes::Bar(6, 6, 24, { 1.0, 1.0, 4.0 });
      const auto chosen = [&bar](int v)
      {
        const Eigen::Vector3d p = bar.Positions.row(v);
        return std::abs(p[0] - 0.5) < 1e-9 && std::abs(p[1]) < 0.2 && std::abs(p[2] - 2.0) < 1.0;
      };
      auto surface = MakePolyData(bar);
      vtktest::AddHandles(
        surface, [](const Eigen::Vector3d& p) { return p[2] < 0.7 ? 1 : (p[2] > 3.3 ? 2 : 0); });
      for (int v = 0; v < bar.NumberOfVertices(); ++v)
      {
        const Eigen::RowVector3d p = size * (bar.Positions.row(v).array() + place);
        surface->GetPoints()->SetPoint(v, p.data());
      }
      vtkNew<vtkShapePreservingDeformation> filter;
      filter->SetInputData(surface);
      filter->SetHandleMotion(2, Turn(10.0));
      filter->GenerateVolumeArraysOn();
      Update(filter);
      int count = 0;
      for (int v = 0; v < bar.NumberOfVertices(); ++v)
      {
        const double depth = PointArray(filter->GetOutput(), "LocalDepth")->GetValue(v);
        EXPECT_GT(depth, 0.0);
        if (chosen(v))
        {
          EXPECT_NEAR(depth / size, expected, 1e-6);
          ++count;
        }
      }
      EXPECT_GT(count, 20);
    }
  }
}

TEST(FrameDeformation, DoesNotDependOnThreads)
{
  const std::string before = vtkSMPTools::GetBackend();
  std::vector<vtkSmartPointer<vtkPolyData>> results;
  for (const auto& [backend, threads] : std::vector<std::pair<const char*, int>>{
         { "Sequential", 1 }, { "STDThread", 2 }, { "STDThread", 5 } })
  {
    if (!vtkSMPTools::SetBackend(backend))
    {
      continue; // not in this VTK
    }
    vtkSMPTools::Initialize(threads);
    vtkNew<vtkShapePreservingDeformation> filter;
    filter->SetInputData(Marked(TableBar()));
    filter->SetHandleMotion(1, Turn(20.0, Eigen::Vector3d::UnitX()));
    filter->SetHandleMotion(2, Turn(150.0));
    filter->SetMaximumIterations(5);
    filter->SetTolerance(0.1);
    filter->SetVolumeCorrectionToFrameScaling();
    filter->CloseVolumeOn();
    filter->GenerateVolumeArraysOn();
    filter->GenerateShapeDistanceOn();
    Update(filter);
    results.push_back(vtktest::CopyOf(filter->GetOutput()));
  }
  vtkSMPTools::SetBackend(before.c_str());
  vtkSMPTools::Initialize();
  ASSERT_GE(results.size(), 2u);
  for (const auto& result : results)
  {
    vtktest::ExpectSameSurface(result, results[0]);
  }
}

TEST(FrameDeformation, ClosesTheVolumeOfEachComponent)
{
  Shape second = SmallBar();
  second.Positions.col(0).array() += 3.0;
  second.Positions *= 0.5;
  const Shape both = shapes::Union(SmallBar(), second);
  const auto mesh = shapes::MakeMesh(both);
  auto surface = MakePolyData(both);
  vtktest::AddHandles(surface,
    [](const Eigen::Vector3d& p)
    {
      const double part = p[0] > 1.0 ? p[2] / 2.5 : p[2] / 5.0;
      return part < 0.17 ? 1 : (part > 0.83 ? 2 : 0);
    });
  const auto rest = cartan::MeasureComponents(mesh, both.Positions);
  vtkNew<vtkRotationInvariantDeformation> filter;
  filter->SetInputData(surface);
  auto motion = Turn(100.0);
  motion->SetTranslation(1.0, 2.0, 3.0);
  filter->SetHandleMotion(2, motion);
  const auto changes = [&]()
  {
    const auto now = cartan::MeasureComponents(mesh, Update(filter));
    return Eigen::Vector2d(
      now[0].Volume / rest[0].Volume - 1.0, now[1].Volume / rest[1].Volume - 1.0);
  };
  EXPECT_GT(changes().cwiseAbs().minCoeff(), 0.01);
  filter->CloseVolumeOn();
  EXPECT_LT(changes().cwiseAbs().maxCoeff(), 1e-10);
}

TEST(FrameDeformation, WarnsOfOpenSurfacesAndLeavesThemUncorrected)
{
  const Shape cylinder = shapes::OpenCylinder(16, 20, 0.5, 5.0);
  const auto surface = Marked(cylinder);
  vtkNew<vtkShapePreservingDeformation> filter;
  filter->SetInputData(surface);
  filter->SetHandleMotion(2, Turn(120.0));
  filter->SetVolumeCorrectionToNone();
  const Points expected = Update(filter);
  for (const int correction :
    { vtkFrameDeformation::FRAME_SCALING, vtkFrameDeformation::NEUTRAL_OFFSET })
  {
    vtkNew<vtkShapePreservingDeformation> corrected;
    const auto log = vtktest::Observe(corrected);
    corrected->SetInputData(surface);
    corrected->SetHandleMotion(2, Turn(120.0));
    corrected->SetVolumeCorrection(correction);
    corrected->CloseVolumeOn();
    corrected->GenerateVolumeArraysOn();
    corrected->Update();
    EXPECT_TRUE(log->Errors.empty());
    vtktest::ExpectMessage(log->Warnings, { "1 open component", "close the surface" });
    EXPECT_EQ(vtktest::PointsOf(corrected->GetOutput()), expected);
    EXPECT_EQ(PointArray(corrected->GetOutput(), "LocalDepth")->GetValue(100), 0.0);
    EXPECT_EQ(PointArray(corrected->GetOutput(), "VolumeScale")->GetValue(100), 1.0);
    EXPECT_TRUE(std::isnan(PointArray(corrected->GetOutput(), "LocalVolume")->GetValue(100)));
    // With every motion that it concerns.
    corrected->SetHandleMotion(2, Turn(130.0));
    corrected->Update();
    EXPECT_EQ(log->Warnings.size(), 2u);
  }
}

TEST(FrameDeformation, WarnsOfSurfacesThatAreInsideOutAndLeavesThemUncorrected)
{
  const Shape bar = SmallBar();
  Shape inverted = shapes::Inverted(bar);
  inverted.Positions.col(0).array() += 4.0;
  const auto handles = [](const Eigen::Vector3d& p)
  { return p[2] < 0.9 ? 1 : (p[2] > 4.1 ? 2 : 0); };
  auto both = MakePolyData(shapes::Union(bar, inverted));
  vtktest::AddHandles(both, handles);
  vtkNew<vtkShapePreservingDeformation> filter;
  const auto log = vtktest::Observe(filter);
  filter->SetInputData(both);
  filter->SetHandleMotion(2, Turn(120.0));
  filter->GenerateVolumeArraysOn();
  filter->Update();
  vtktest::ExpectMessage(log->Warnings, { "1 component (id 1)", "inside out", "flip" });
  const Points corrected = vtktest::PointsOf(filter->GetOutput());
  const int count = bar.NumberOfVertices();
  EXPECT_GT(PointArray(filter->GetOutput(), "LocalVolume")->GetValue(count / 2), 0.0);
  EXPECT_TRUE(
    std::isnan(PointArray(filter->GetOutput(), "LocalVolume")->GetValue(count + count / 2)));
  filter->SetVolumeCorrectionToNone();
  filter->Update();
  const Points uncorrected = vtktest::PointsOf(filter->GetOutput());
  EXPECT_GT((corrected - uncorrected).topRows(count).cwiseAbs().maxCoeff(), 0.01);
  EXPECT_EQ(corrected.bottomRows(count), uncorrected.bottomRows(count));

  auto alone = MakePolyData(shapes::Inverted(bar));
  vtktest::AddHandles(alone, handles);
  log->Clear();
  filter->SetVolumeCorrectionToNeutralOffset();
  filter->SetInputData(alone);
  filter->Update();
  vtktest::ExpectMessage(log->Warnings, { "1 component (id 0)", "inside out" });
  EXPECT_TRUE(log->Errors.empty());
}

TEST(ShapePreservingDeformation, RefusesWholeTurnsAboutDifferentAxes)
{
  const auto surface = PinnedAtTheBottom(Marked(SmallBar()));
  const auto copy = vtktest::CopyOf(surface);
  vtkNew<vtkShapePreservingDeformation> filter;
  const auto log = vtktest::Observe(filter);
  filter->SetInputData(surface);
  filter->SetHandleMotion(1, Turn(10.0, Eigen::Vector3d::UnitX()));
  filter->SetHandleMotion(2, Turn(480.0));
  filter->Update();
  vtktest::ExpectMessage(
    log->Errors, { "different axes", "360 degrees or more", "the same axis", "in several steps" });
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 0);
  vtktest::ExpectSameSurface(surface, copy);

  // What the message proposes helps.
  log->Clear();
  filter->SetHandleMotion(1, Turn(10.0));
  Update(filter);
  EXPECT_TRUE(log->Errors.empty());
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), surface->GetNumberOfPoints());
}

TEST(ShapePreservingDeformation, RefusesAnAxisWithoutLength)
{
  const auto surface = Marked(SmallBar());
  const auto copy = vtktest::CopyOf(surface);
  vtkNew<vtkShapePreservingDeformation> filter;
  const auto log = vtktest::Observe(filter);
  filter->SetInputData(surface);
  filter->SetHandleMotion(2, Turn(90.0, Eigen::Vector3d::Zero()));
  filter->Update();
  vtktest::ExpectMessage(log->Errors, { "handle 2", "Axis has length zero", "give it a length" });
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  vtktest::ExpectSameSurface(surface, copy);
}

TEST(ShapePreservingDeformation, RefusesFreePositionsThatNothingPins)
{
  vtkNew<vtkShapePreservingDeformation> filter;
  const auto log = vtktest::Observe(filter);
  filter->SetInputData(Marked(SmallBar()));
  filter->SetHandleMotion(1, Turn(10.0));
  filter->SetHandleMotion(2, Turn(90.0));
  filter->ConstrainHandlePositionsOff();
  filter->Update();
  vtktest::ExpectMessage(log->Errors, { "singular", "no constraint", "at least one point" });
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(ShapePreservingDeformation, HoldsTheBoundaryOfAPlaneByAWeight)
{
  // Fig. 7: a square of handle points that turn about its sides, the boundary
  // held to its frames by a factor of .01, by 1, and exactly.
  const int count = 24;
  const Shape plane = shapes::Plane(count, 2.0);
  auto surface = MakePolyData(plane);
  const auto toCenter = [](const Eigen::Vector3d& p) { return p.cwiseAbs().head<2>().maxCoeff(); };
  vtktest::AddHandles(surface,
    [&](const Eigen::Vector3d& p)
    { return toCenter(p) > 1.0 - 1e-9 ? 1 : (std::abs(toCenter(p) - 0.5) < 1e-9 ? 2 : 0); });
  vtktest::AddArray(surface, "Turn", 3,
    [&](vtkIdType v, double* vector)
    {
      const Eigen::Vector3d p(surface->GetPoint(v));
      const bool isHandle = std::abs(toCenter(p) - 0.5) < 1e-9;
      Eigen::Vector3d outwards = Eigen::Vector3d::Zero();
      if (isHandle)
      {
        outwards[std::abs(p[0]) > std::abs(p[1]) ? 0 : 1] = 1.0;
        outwards = outwards.cwiseProduct(p.cwiseSign());
      }
      Eigen::Map<Eigen::Vector3d>(vector, 3) =
        2.0 * shapes::Pi / 3.0 * Eigen::Vector3d::UnitZ().cross(outwards);
    });
  const auto boundaryTurn = [&](double weight)
  {
    vtktest::AddArray(surface, "Weight", 1,
      [&](vtkIdType v, double* value) {
        *value = toCenter(Eigen::Vector3d(surface->GetPoint(v))) > 1.0 - 1e-9 ? weight : Infinity;
      });
    vtkNew<vtkShapePreservingDeformation> filter;
    filter->SetInputData(surface);
    filter->SetRotationVectorArrayName("Turn");
    filter->SetConstraintWeightArrayName("Weight");
    filter->SetVolumeCorrectionToNone();
    filter->SetMaximumIterations(30);
    filter->GenerateRotationVectorOn();
    const Points points = Update(filter);
    EXPECT_TRUE(points.allFinite());
    EXPECT_FALSE(filter->GetSharedAxis());
    EXPECT_TRUE(filter->GetConverged());
    double sum = 0.0;
    int number = 0;
    for (int v = 0; v < plane.NumberOfVertices(); ++v)
    {
      if (toCenter(plane.Positions.row(v)) > 1.0 - 1e-9)
      {
        sum += Eigen::Vector3d(PointArray(filter->GetOutput(), "RotationVector")->GetPointer(3 * v))
                 .norm();
        ++number;
      }
    }
    return sum / number;
  };
  const double loose = boundaryTurn(0.01);
  const double firm = boundaryTurn(1.0);
  shapes::ShowFigure("mean turn of the boundary with weight .01", loose);
  shapes::ShowFigure("with weight 1", firm);
  EXPECT_GT(loose, 0.8);
  EXPECT_LT(firm, 0.25 * loose);
  EXPECT_LT(boundaryTurn(100.0), 1e-3);
  EXPECT_EQ(boundaryTurn(Infinity), 0.0);
}

TEST(ShapePreservingDeformation, KeepsThePrecisionOfItsInput)
{
  const Shape bar = SmallBar();
  vtkNew<vtkShapePreservingDeformation> filter;
  filter->SetHandleMotion(2, Turn(480.0));
  filter->SetInputData(Marked(bar));
  const Points exact = Update(filter);
  filter->SetInputData(Marked(bar, 0.16, 0.84, VTK_FLOAT));
  EXPECT_LT((Update(filter) - exact).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_EQ(filter->GetOutput()->GetPoints()->GetDataType(), VTK_FLOAT);
}

TEST(ShapePreservingDeformation, HasTheDefaultsOfItsDocumentation)
{
  vtkNew<vtkShapePreservingDeformation> filter;
  EXPECT_EQ(filter->GetVolumeCorrection(), vtkFrameDeformation::NEUTRAL_OFFSET);
  EXPECT_FALSE(filter->GetCloseVolume());
  EXPECT_EQ(filter->GetPositionWeights(), vtkFrameDeformation::LIKE_FRAMES);
  EXPECT_EQ(filter->GetMaximumIterations(), 1);
  EXPECT_EQ(filter->GetTolerance(), 1e-6);
  filter->SetMaximumIterations(-3);
  EXPECT_EQ(filter->GetMaximumIterations(), 1);
  filter->SetTolerance(-1.0);
  EXPECT_EQ(filter->GetTolerance(), 0.0);
  filter->SetVolumeCorrection(17);
  EXPECT_EQ(filter->GetVolumeCorrection(), vtkFrameDeformation::NEUTRAL_OFFSET);
  filter->SetPositionWeights(17);
  EXPECT_EQ(filter->GetPositionWeights(), vtkFrameDeformation::MEAN_VALUE_POSITIONS);
  std::ostringstream text;
  filter->PrintSelf(text, vtkIndent());
  for (const char* name : { "VolumeCorrection", "CloseVolume", "PositionWeights",
         "GenerateVolumeArrays", "GenerateShapeDistance", "MaximumIterations", "Tolerance",
         "SharedAxis", "NumberOfIterations", "Residual", "Converged" })
  {
    EXPECT_NE(text.str().find(name), std::string::npos) << name;
  }
}
