// SPDX-License-Identifier: BSD-3-Clause
#include "Advice.h"
#include "PrepareShapes.h"
#include "TimeSource.h"

#include "vtkAsRigidAsPossibleDeformation.h"
#include "vtkExampleBasedDeformation.h"
#include "vtkLaplacianDeformation.h"
#include "vtkMultiresolutionDeformation.h"
#include "vtkPoissonDeformation.h"
#include "vtkPyramidDeformation.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkShapePreservingDeformation.h"
#include "vtkSimilarityDeformation.h"

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace
{
using vtktest::Advice;
using vtktest::Advised;
using vtktest::MarkedBar;

/// The surface bent about an axis along x, more with z, by up to `angle` radians.
vtkSmartPointer<vtkPolyData> Bent(vtkPolyData* surface, double angle)
{
  auto bent = vtktest::CopyOf(surface);
  for (vtkIdType v = 0; v < bent->GetNumberOfPoints(); ++v)
  {
    const Eigen::Vector3d p(surface->GetPoint(v));
    const double part = std::clamp((p[2] - 0.6) / 2.8, 0.0, 1.0) * angle;
    const double radius = 2.8 / angle;
    const double beyond = p[2] - 0.6 - radius * part;
    bent->GetPoints()->SetPoint(v, p[0],
      radius - (radius - p[1]) * std::cos(part) + beyond * std::sin(part),
      0.6 + (radius - p[1]) * std::sin(part) + beyond * std::cos(part));
  }
  bent->Modified();
  return bent;
}

/// The surface with the array "Target": where its points are in a pose.
vtkSmartPointer<vtkPolyData> WithTargets(vtkPolyData* surface, vtkPolyData* pose)
{
  auto copy = vtktest::CopyOf(surface);
  vtktest::AddArray(
    copy, "Target", 3, [pose](vtkIdType v, double* target) { pose->GetPoint(v, target); });
  return copy;
}

TEST(ExampleBasedDeformation, ReachesExamplesAndTellsTheirWeights)
{
  for (const int precision : { VTK_DOUBLE, VTK_FLOAT })
  {
    const auto bar = vtktest::MakePolyData(shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 }), precision);
    vtktest::MarkEnds(bar, 0.6, 3.4);
    const auto bent = Bent(bar, 1.2);
    Advised<vtkExampleBasedDeformation> filter;
    filter->AddExampleData(bent);
    filter->AddExampleData(Bent(bar, -0.5));
    filter->SetTargetPositionArrayName("Target");
    filter->SetInputData(WithTargets(bar, bent));
    const auto result = filter.Works();
    EXPECT_LT((vtktest::PointsOf(result) - vtktest::PointsOf(bent)).cwiseAbs().maxCoeff(), 2e-6);
    auto* weights =
      vtkDoubleArray::SafeDownCast(result->GetFieldData()->GetArray("ExampleWeights"));
    ASSERT_TRUE(weights);
    ASSERT_EQ(weights->GetNumberOfTuples(), 2);
    EXPECT_EQ(filter->GetExampleWeights()->GetNumberOfTuples(), 2);
    EXPECT_EQ(filter->GetExampleWeights()->GetValue(0), weights->GetValue(0));
    EXPECT_LT(filter->GetSpanDistance(), 1e-6);
    EXPECT_TRUE(filter->GetConverged());
    EXPECT_EQ(filter->GetNumberOfFactorizations(), 1);
    // Another pose needs no factorization, with a warm start neither.
    for (const bool isWarm : { false, true })
    {
      filter->SetWarmStart(isWarm);
      filter->SetTargetPositionArrayName("");
      filter->SetHandleMotion(2, vtktest::Turn(isWarm ? 10.0 : 20.0));
      const auto turned = filter.Works();
      vtktest::ExpectEnds(
        turned, bar, vtktest::Turn(isWarm ? 10.0 : 20.0), precision == VTK_FLOAT ? 1e-6 : 1e-9);
      EXPECT_GT(filter->GetNumberOfIterations(), 0);
    }
    EXPECT_LE(filter->GetNumberOfFactorizations(), 2);
    filter->SetRigidness(0.5);
    vtktest::ExpectEnds(
      filter.Works(), bar, vtktest::Turn(10.0), precision == VTK_FLOAT ? 1e-6 : 1e-9);
  }
  std::ostringstream text;
  vtkNew<vtkExampleBasedDeformation> filter;
  filter->Print(text);
  EXPECT_NE(text.str().find("SpanDistance: 0"), std::string::npos);
}

TEST(ExampleBasedDeformation, PutsWeightsIntoChartsOverTime)
{
  const auto bar = vtktest::MakePolyData(shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 }));
  vtktest::MarkEnds(bar, 0.6, 3.4);
  const std::vector<vtkSmartPointer<vtkPolyData>> poses{ Bent(bar, 1.2), Bent(bar, -0.5) };
  vtkNew<vtktest::TimeSource> source;
  source->SetSteps({ 0.0, 1.0, 2.0 },
    { WithTargets(bar, bar), WithTargets(bar, poses[0]), WithTargets(bar, poses[1]) });
  vtkNew<vtkExampleBasedDeformation> filter;
  filter->SetInputConnection(source->GetOutputPort());
  filter->AddExampleData(poses[0]);
  filter->AddExampleData(poses[1]);
  filter->SetTargetPositionArrayName("Target");
  for (int step = 0; step < 3; ++step)
  {
    filter->UpdateTimeStep(step);
    for (int k = 0; k < 2; ++k)
    {
      // Charts draw arrays of one tuple and leave out others.
      auto* weight = filter->GetOutput()->GetFieldData()->GetArray(
        ("Weight of example " + std::to_string(k)).c_str());
      ASSERT_TRUE(weight);
      ASSERT_EQ(weight->GetNumberOfValues(), 1);
      EXPECT_NEAR(weight->GetTuple1(0), step == k + 1 ? 1.0 : 0.0, 1e-6) << k << ' ' << step;
    }
  }
}

/// What the filters of RigidMethodType give for the same handles.
std::vector<vtkSmartPointer<vtkSurfaceDeformation>> RigidFilters()
{
  vtkNew<vtkSimilarityDeformation> similarity;
  similarity->ConstrainHandleTransformsOn();
  vtkNew<vtkShapePreservingDeformation> shape;
  shape->SetVolumeCorrectionToNone();
  return { vtkNew<vtkRotationInvariantDeformation>(), shape, similarity,
    vtkNew<vtkLaplacianDeformation>(), vtkNew<vtkMultiresolutionDeformation>(),
    vtkNew<vtkPoissonDeformation>(), vtkNew<vtkAsRigidAsPossibleDeformation>(),
    vtkNew<vtkPyramidDeformation>() };
}

TEST(ExampleBasedDeformation, BlendsWithEachRigidMethod)
{
  const auto bar = vtktest::MakePolyData(shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 }));
  vtktest::MarkEnds(bar, 0.6, 3.4);
  Advised<vtkExampleBasedDeformation> filter;
  filter->SetInputData(bar);
  filter->AddExampleData(Bent(bar, 1.2));
  filter->SetHandleMotion(2, vtktest::Turn(30.0));
  EXPECT_EQ(filter->GetRigidMethod(), vtkExampleBasedDeformation::SHAPE_PRESERVING);
  const auto span = vtktest::PointsOf(filter.Works());
  const auto others = RigidFilters();
  for (int method = 0; method < static_cast<int>(others.size()); ++method)
  {
    vtkSurfaceDeformation* other = others[static_cast<std::size_t>(method)];
    other->SetInputData(bar);
    other->SetHandleMotion(2, vtktest::Turn(30.0));
    other->Update();
    const auto rigid = vtktest::PointsOf(other->GetOutput());
    filter->SetRigidMethod(method);
    for (const double part : { 1.0, 0.3 })
    {
      filter->SetRigidness(part);
      const auto blended = vtktest::PointsOf(filter.Works());
      EXPECT_LT((blended - (1.0 - part) * span - part * rigid).cwiseAbs().maxCoeff(), 1e-9)
        << method << ' ' << part;
    }
    EXPECT_GT((rigid - span).cwiseAbs().maxCoeff(), 1e-3) << method;
  }
}

TEST(ExampleBasedDeformation, TakesTimeStepsAsExamples)
{
  const auto bar = vtktest::MakePolyData(shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 }));
  vtktest::MarkEnds(bar, 0.6, 3.4);
  const std::vector<vtkSmartPointer<vtkPolyData>> poses{ Bent(bar, 1.2), Bent(bar, -0.5),
    Bent(bar, 0.7) };
  vtkNew<vtktest::TimeSource> source;
  source->SetSteps({ 0.5, 2.0, 3.0 }, poses);
  Advised<vtkExampleBasedDeformation> filter;
  filter->SetInputData(bar);
  filter->AddExampleConnection(source->GetOutputPort());
  filter->ExamplesOverTimeOn();
  filter->SetHandleMotion(2, vtktest::Turn(20.0));
  const auto overTime = vtktest::PointsOf(filter.Works());
  ASSERT_EQ(filter->GetExampleWeights()->GetNumberOfTuples(), 3);
  EXPECT_EQ(source->Requests, (std::vector<double>{ 0.5, 2.0, 3.0 }));
  Advised<vtkExampleBasedDeformation> several;
  several->SetInputData(bar);
  for (const auto& pose : poses)
  {
    several->AddExampleData(pose);
  }
  several->SetHandleMotion(2, vtktest::Turn(20.0));
  EXPECT_EQ(vtktest::PointsOf(several.Works()), overTime);
  // A drag reads no step again, and a new input all of them.
  filter->SetHandleMotion(2, vtktest::Turn(25.0));
  filter.Works();
  EXPECT_EQ(source->Requests.size(), 3u);
  source->SetSteps({ 0.0, 1.0 }, { poses[1], poses[0] });
  filter.Works();
  EXPECT_EQ(source->Requests.size(), 5u);
  EXPECT_EQ(filter->GetExampleWeights()->GetNumberOfTuples(), 2);
  // Bad input, and what to do.
  filter->AddExampleData(poses[0]);
  filter.Refuses({ "there are 2 surfaces",
    Advice("connect one with time steps, or turn "
           "ExamplesOverTime off.") });
  filter->ExamplesOverTimeOff();
  filter->RemoveAllExamples();
  filter->AddExampleData(poses[0]);
  filter.Works();
  filter->ExamplesOverTimeOn();
  filter.Works();
  EXPECT_EQ(filter->GetExampleWeights()->GetNumberOfTuples(), 1);
  source->SetSteps({ 0.0, 2.0, 1.0 }, poses);
  filter->RemoveAllExamples();
  filter->AddExampleConnection(source->GetOutputPort());
  filter.Refuses({ "time step 2 is at 1", Advice("Give each time once, in increasing order.") });
  source->SetSteps({ 0.0, 1.0, 2.0 }, poses);
  filter.Works();
}

TEST(ExampleBasedDeformation, PreparesExamplesOverTimeAlike)
{
  // Triangles with points of their own, which preparation joins; in one pose opposite sides
  // touch, whose points it would join, too.
  const auto soup = vtktest::MakePolyData(shapes::Soup(shapes::Bar(2, 2, 8, { 1.0, 1.0, 4.0 })));
  vtktest::MarkEnds(soup, 0.6, 3.4);
  const auto pinched = Bent(soup, -0.5);
  for (vtkIdType v = 0; v < soup->GetNumberOfPoints(); ++v)
  {
    const Eigen::Vector3d rest(soup->GetPoint(v));
    if (rest[2] == 2.0 && rest[1] == 0.5)
    {
      pinched->GetPoints()->SetPoint(v, 0.5, pinched->GetPoint(v)[1], pinched->GetPoint(v)[2]);
    }
  }
  const std::vector<vtkSmartPointer<vtkPolyData>> poses{ Bent(soup, 1.2), pinched };
  vtkNew<vtktest::TimeSource> source;
  source->SetSteps({ 0.0, 1.0 }, poses);
  Advised<vtkExampleBasedDeformation> filter;
  filter->SetInputData(soup);
  filter->SetHandleMotion(2, vtktest::Turn(20.0));
  filter->ExamplesOverTimeOn();
  filter->PrepareInputOn();
  filter->AddExampleConnection(source->GetOutputPort());
  const auto overTime = vtktest::PointsOf(filter.Works());
  ASSERT_EQ(filter->GetExampleWeights()->GetNumberOfTuples(), 2);
  // As several surfaces, and the other way round.
  filter->ExamplesOverTimeOff();
  filter->RemoveAllExamples();
  filter->AddExampleData(poses[0]);
  filter->AddExampleData(poses[1]);
  EXPECT_EQ(vtktest::PointsOf(filter.Works()), overTime);
  source->SetSteps({ 0.0, 1.0 }, { poses[1], poses[0] });
  filter->ExamplesOverTimeOn();
  filter->RemoveAllExamples();
  filter->AddExampleConnection(source->GetOutputPort());
  EXPECT_LT((vtktest::PointsOf(filter.Works()) - overTime).norm(), 1e-6);
  // Other cells are prepared otherwise.
  const auto other = vtktest::MakePolyData(shapes::Soup(shapes::Bar(2, 2, 9, { 1.0, 1.0, 4.0 })));
  source->SetSteps({ 0.0, 1.0 }, { poses[0], other });
  filter.Refuses(
    { "example 1 (time 1", Advice("give the same points and cells in the same order.") });
  source->SetSteps({ 0.0, 1.0 }, poses);
  filter.Works();
}

TEST(ExampleBasedDeformation, NeedsExamplesOfTheSameCells)
{
  const auto bar = MarkedBar();
  Advised<vtkExampleBasedDeformation> filter;
  filter->SetInputData(bar);
  filter->SetHandleMotion(2, vtktest::Turn(20.0));
  filter.Refuses(
    { "There are no examples", Advice("connect other poses of the surface (Examples).") });
  filter->AddExampleData(Bent(bar, 1.0));
  filter.Works();
  const auto other = vtktest::MakePolyData(shapes::Bar(2, 2, 9, { 1.0, 1.0, 4.0 }));
  filter->AddExampleData(other);
  filter.Refuses({ "example 1", Advice("give the same points and cells in the same order.") });
  EXPECT_EQ(filter->GetExampleWeights()->GetNumberOfTuples(), 0);
  filter->RemoveAllExamples();
  filter->AddExampleData(Bent(bar, 1.0));
  filter.Works();
  filter->ConstrainHandlePositionsOff();
  filter.Refuses({ "turn ConstrainHandlePositions on" });
  filter->ConstrainHandlePositionsOn();
  filter.Works();
}
}
