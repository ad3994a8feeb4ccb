// SPDX-License-Identifier: BSD-3-Clause
#include "Advice.h"
#include "Backwards.h"
#include "CurveLines.h"

#include "vtkCurveDeformation.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace
{
using vtktest::Advice;
using vtktest::Advised;
using vtktest::Line;
using vtktest::PlacesOf;
using vtktest::SetPointIds;

/// A bar between pinned ends, and the ring around its middle.
struct Belt
{
  Belt()
    : Surface(vtktest::MakePolyData(shapes::Bar(3, 3, 12, { 1.0, 1.0, 4.0 })))
  {
    vtktest::MarkEnds(this->Surface, 0.5, 3.5);
    for (vtkIdType v = 0; v < this->Surface->GetNumberOfPoints(); ++v)
    {
      if (std::abs(this->Surface->GetPoint(v)[2] - 2.0) < 1e-9)
      {
        this->Ids.push_back(v);
      }
    }
    // In their order around the middle.
    std::sort(this->Ids.begin(), this->Ids.end(),
      [this](vtkIdType a, vtkIdType b) { return this->AngleOf(a) < this->AngleOf(b); });
    this->Filter->SetInputData(this->Surface);
    this->Filter->SetSourceToSelectedPoints();
    this->Filter->ClosedCurveOn();
    SetPointIds(this->Filter.Get(), this->Ids);
  }

  double AngleOf(vtkIdType id) const
  {
    const double* p = this->Surface->GetPoint(id);
    return std::atan2(p[1], p[0]);
  }

  cartan::Points Rest() const { return PlacesOf(this->Surface, this->Ids); }

  void SetRing(const cartan::Points& ring)
  {
    const auto line = Line(ring);
    line->GetLines()->Initialize();
    const auto count = static_cast<vtkIdType>(ring.rows());
    line->GetLines()->InsertNextCell(static_cast<int>(count) + 1);
    for (vtkIdType i = 0; i <= count; ++i)
    {
      line->GetLines()->InsertCellPoint(i % count);
    }
    this->Filter->SetTargetData(line);
  }

  vtkSmartPointer<vtkPolyData> Surface;
  std::vector<vtkIdType> Ids;
  Advised<vtkCurveDeformation> Filter;
};

TEST(CurveDeformation, ClosedCurvesGoToRings)
{
  for (int method = 0; method <= vtkCurveDeformation::MULTIRESOLUTION; ++method)
  {
    Belt belt;
    ASSERT_EQ(belt.Ids.size(), 12u);
    belt.Filter->SetMethod(method);
    belt.SetRing(belt.Rest());
    const auto still = belt.Filter.Works();
    EXPECT_LT((vtktest::PointsOf(still) - vtktest::PointsOf(belt.Surface)).norm(), 1e-12) << method;
    EXPECT_EQ(belt.Filter->GetNumberOfCurvePoints(), 12);
    // Wider, higher, and whichever way it runs.
    const Eigen::RowVector3d center(0.0, 0.0, 2.0);
    cartan::Points wide = 1.4 * (belt.Rest().rowwise() - center);
    wide.rowwise() += center + Eigen::RowVector3d(0.1, 0.0, 0.3);
    for (const bool isBackward : { false, true })
    {
      belt.SetRing(isBackward ? cartan::Points(wide.colwise().reverse()) : wide);
      const auto result = belt.Filter.Works();
      EXPECT_LT((PlacesOf(result, belt.Ids) - wide).norm(), 1e-9) << method;
      vtktest::ExpectHandle(result, belt.Surface, 1);
    }
    // A line's ends are joined.
    belt.Filter->SetTargetData(Line(wide));
    EXPECT_LT((PlacesOf(belt.Filter.Works(), belt.Ids) - wide).norm(), 1e-9);
  }
}

TEST(CurveDeformation, ContoursArePickedByAPoint)
{
  Belt belt;
  Advised<vtkCurveDeformation>& filter = belt.Filter;
  filter->SetRidgeHeight(0.01);
  filter->SetSourceToFeatureEdges();
  SetPointIds(filter.Get(), { belt.Surface->FindPoint(0.5, -0.5, 0.0) });
  filter.Works();
  EXPECT_EQ(filter->GetNumberOfCurvePoints(), 12); // the square at an end
  filter->SetSourceToSilhouette();
  filter->SetViewDirection(1.0, 1.0, 0.1);
  filter.Works();
  EXPECT_EQ(filter->GetNumberOfCurvePoints(), 2 * 12 + 4 * 3);
  filter->SetSourceToFeatureEdges();
  filter->SetFeatureAngle(100.0);
  filter.Refuses({ Advice("choose another point, FeatureAngle or ViewDirection, or three PointIds "
                          "or more around the ring.") });
  filter->SetFeatureAngle(30.0);
  filter.Works();
  filter->SetSourceToShortestPath();
  filter.Refuses({ "there are 1", Advice("add points around it, three or more.") });
  SetPointIds(filter.Get(), { belt.Ids[0], belt.Ids[4] });
  filter.Refuses({ Advice("choose PointIds in the order of a curve that does not cross itself, "
                          "three or more around it.") });
  SetPointIds(filter.Get(), { belt.Ids[0], belt.Ids[4], belt.Ids[8] });
  filter.Works();
  EXPECT_EQ(filter->GetNumberOfCurvePoints(), 12);
  filter->SetSourceToSelectedPoints();
  filter.Refuses({ "3 selected points",
    Advice("Select the points of one ring, turn ClosedCurve off, or set Source to the shortest "
           "path between three points of it or more in their order.") });
  SetPointIds(filter.Get(), belt.Ids);
  filter.Works();
}

TEST(CurveDeformation, TargetsOfClosedCurvesAreRings)
{
  Belt belt;
  Advised<vtkCurveDeformation>& filter = belt.Filter;
  belt.SetRing(belt.Rest());
  filter.Works();
  filter->ClosedCurveOff();
  SetPointIds(filter.Get(), { belt.Ids.begin(), belt.Ids.begin() + 5 });
  filter.Refuses({ "its 1 lines", Advice("turn ClosedCurve on for a ring.") });
  filter->ClosedCurveOn();
  SetPointIds(filter.Get(), belt.Ids);
  filter.Works();
  filter->SetTargetData(Line(belt.Rest().topRows(2)));
  filter.Refuses(
    { "2 different points", Advice("give it three or more, or turn ClosedCurve off.") });
  filter->SetTargetData(Line(belt.Rest().topRows(3)));
  filter.Works();
  const auto two = Line(belt.Rest());
  two->GetPoints()->InsertNextPoint(0.0, 0.0, 1.0);
  two->GetPoints()->InsertNextPoint(1.0, 0.0, 1.0);
  two->GetLines()->InsertNextCell({ 12, 13 });
  filter->SetTargetData(two);
  filter.Refuses({ "its 2 lines",
    Advice("Connect one line or ring, such as a part of it from Extract Cells.") });
  belt.SetRing(belt.Rest());
  filter.Works();
}

/// Which way a ridge leans follows from the order in which points are named, not from their ids.
TEST(CurveDeformation, RidgesTurnByTheOrderInWhichPointsAreNamed)
{
  const shapes::Shape ball = shapes::UvSphere(24, 11);
  const auto count = static_cast<vtkIdType>(ball.NumberOfVertices());
  for (const bool isClosed : { false, true })
  {
    // Along the equator.
    std::vector<vtkIdType> ids;
    for (vtkIdType v = 0; v < count; ++v)
    {
      const Eigen::RowVector3d p = ball.Positions.row(v);
      if (std::abs(p.z()) < 1e-9 && (isClosed || p.y() > 0.1))
      {
        ids.push_back(v);
      }
    }
    std::sort(ids.begin(), ids.end(),
      [&](vtkIdType a, vtkIdType b)
      {
        const auto angle = [&](vtkIdType v)
        { return std::atan2(ball.Positions(v, 1), ball.Positions(v, 0)); };
        return angle(a) < angle(b);
      });
    const auto leaning = [&](const shapes::Shape& shape, const std::vector<vtkIdType>& named)
    {
      Advised<vtkCurveDeformation> filter;
      filter->SetInputData(vtktest::MakePolyData(shape));
      filter->SetSourceToSelectedPoints();
      filter->SetClosedCurve(isClosed);
      SetPointIds(filter.Get(), named);
      filter->SetRidgeWidth(0.5);
      filter->SetRidgeTurn(40.0);
      return vtktest::PointsOf(filter.Works());
    };
    ASSERT_GT(ids.size(), 5u);
    const cartan::Points expected = leaning(ball, ids);
    std::vector<vtkIdType> others;
    for (const vtkIdType id : ids)
    {
      others.push_back(count - 1 - id);
    }
    const cartan::Points there = leaning(shapes::Backwards(ball), others);
    EXPECT_LT((there.colwise().reverse() - expected).cwiseAbs().maxCoeff(), 1e-9);
    // Named the other way round, it leans to the other side: mirrored.
    const cartan::Points opposite = leaning(ball, { ids.rbegin(), ids.rend() });
    EXPECT_GT((opposite - expected).cwiseAbs().maxCoeff(), 0.01);
  }
}

TEST(CurveDeformation, RidgesScaleAndTurnDeltas)
{
  const auto ball = vtktest::MakePolyData(shapes::UvSphere(48, 24));
  Advised<vtkCurveDeformation> filter;
  filter->SetInputData(ball);
  SetPointIds(filter.Get(), { ball->FindPoint(1.0, 0.0, 0.0), ball->FindPoint(0.0, 1.0, 0.0) });
  filter->SetRidgeWidth(0.3);
  filter->SetRidgeScale(2.0);
  const auto largest = [&](vtkPolyData* result)
  { return vtktest::PointsOf(result).rowwise().norm().maxCoeff(); };
  EXPECT_GT(largest(filter.Works()), 1.01);
  filter->SharpRidgeOn();
  const double sharp = largest(filter.Works());
  EXPECT_GT(sharp, 1.001);
  filter->SetRidgeScale(1.0);
  filter->SetRidgeTurn(40.0);
  filter->SharpRidgeOff();
  const auto leaning = filter.Works();
  EXPECT_GT((vtktest::PointsOf(leaning) - vtktest::PointsOf(ball)).cwiseAbs().maxCoeff(), 0.01);
  filter->SetRidgeWidth(10.0);
  filter.Refuses({ Advice("lower RidgeWidth.") });
  filter->SetRidgeWidth(0.3);
  filter.Works();
  filter->SetRidgeTurn(0.0);
  filter.Refuses({ "no target curve and no ridge" });
}
}
