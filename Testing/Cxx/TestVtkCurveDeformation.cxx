// SPDX-License-Identifier: BSD-3-Clause
#include "Advice.h"
#include "CurveLines.h"

#include "vtkCurveDeformation.h"
#include "vtkHandleMotion.h"
#include "vtkLaplacianDeformation.h"
#include "vtkMatrix4x4.h"
#include "vtkMultiresolutionDeformation.h"
#include "vtkRotationInvariantDeformation.h"
#include "vtkShapePreservingDeformation.h"
#include "vtkSimilarityDeformation.h"

namespace
{
using vtktest::Advice;
using vtktest::Advised;
using vtktest::Line;
using vtktest::PlacesOf;
using vtktest::SetPointIds;

constexpr int Count = 12;

/// A bumpy sheet of (Count + 1)^2 points, id y * (Count + 1) + x.
vtkSmartPointer<vtkPolyData> Sheet()
{
  return vtktest::MakePolyData(shapes::Graph(
    Count, 4.0, [](double x, double y) { return 0.1 * std::sin(2.0 * x) * std::cos(3.0 * y); },
    0.2));
}

int Id(int x, int y)
{
  return y * (Count + 1) + x;
}

/// The row of points from (x1, y) to (x2, y).
std::vector<vtkIdType> Row(int x1, int x2, int y)
{
  std::vector<vtkIdType> ids;
  for (int x = x1; x <= x2; ++x)
  {
    ids.push_back(Id(x, y));
  }
  return ids;
}

/// The middle row of the sheet, whose border is pinned.
struct Sketch
{
  Sketch()
    : Surface(Sheet())
    , Path(Row(3, 9, 6))
  {
    vtktest::AddHandles(this->Surface,
      [](const Eigen::Vector3d& p)
      { return std::max(std::abs(p.x()), std::abs(p.y())) > 1.9 ? 1 : 0; });
    this->Filter->SetInputData(this->Surface);
    this->Filter->SetSourceToSelectedPoints();
    SetPointIds(this->Filter.Get(), this->Path);
  }

  cartan::Points Rest() const { return PlacesOf(this->Surface, this->Path); }

  void SetTarget(const cartan::Points& points) { this->Filter->SetTargetData(Line(points)); }

  vtkSmartPointer<vtkPolyData> Surface;
  std::vector<vtkIdType> Path;
  Advised<vtkCurveDeformation> Filter;
};

double DistanceToCurve(const Eigen::Vector3d& x, const cartan::Points& curve)
{
  double nearest = 1e300;
  for (Eigen::Index j = 0; j + 1 < curve.rows(); ++j)
  {
    const Eigen::Vector3d edge = curve.row(j + 1) - curve.row(j);
    const Eigen::Vector3d way = x - curve.row(j).transpose();
    const double t = std::min(std::max(way.dot(edge) / edge.squaredNorm(), 0.0), 1.0);
    nearest = std::min(nearest, (way - t * edge).norm());
  }
  return nearest;
}

TEST(CurveDeformation, TheSourceAsTargetMovesNothing)
{
  for (int method = 0; method <= vtkCurveDeformation::MULTIRESOLUTION; ++method)
  {
    for (const double fidelity : { 1.0, 0.5 })
    {
      Sketch sketch;
      sketch.SetTarget(sketch.Rest());
      sketch.Filter->SetMethod(method);
      sketch.Filter->SetFidelity(fidelity);
      const auto result = sketch.Filter.Works();
      EXPECT_LT((vtktest::PointsOf(result) - vtktest::PointsOf(sketch.Surface)).norm(), 1e-12)
        << method;
      EXPECT_EQ(sketch.Filter->GetNumberOfCurvePoints(), 7);
    }
  }
}

TEST(CurveDeformation, AnAffineImageIsMet)
{
  Eigen::Matrix3d map;
  map << 1.2, 0.3, 0.0, -0.2, 0.9, 0.1, 0.4, 0.0, 1.1;
  for (int method = 0; method <= vtkCurveDeformation::MULTIRESOLUTION; ++method)
  {
    Sketch sketch;
    const cartan::Points image =
      (sketch.Rest() * map.transpose()).rowwise() + Eigen::RowVector3d(0.0, 0.1, 0.4);
    sketch.SetTarget(image);
    sketch.Filter->SetMethod(method);
    const auto result = sketch.Filter.Works();
    for (const vtkIdType id : sketch.Path)
    {
      EXPECT_LT(DistanceToCurve(Eigen::Vector3d(result->GetPoint(id)), image), 1e-9);
    }
    EXPECT_LT((PlacesOf(result, { sketch.Path.front() }) - image.topRows(1)).norm(), 1e-9);
    EXPECT_LT(sketch.Filter->GetLargestDistance(), 1e-9);
    vtktest::ExpectHandle(result, sketch.Surface, 1);
  }
}

/// The filters of MethodType.
std::vector<vtkSmartPointer<vtkSurfaceDeformation>> CarryingFilters()
{
  vtkNew<vtkShapePreservingDeformation> shape;
  shape->SetVolumeCorrectionToNone();
  return { vtkNew<vtkRotationInvariantDeformation>(), shape, vtkNew<vtkSimilarityDeformation>(),
    vtkNew<vtkLaplacianDeformation>(), vtkNew<vtkMultiresolutionDeformation>() };
}

TEST(CurveDeformation, CarriesTheRestAsTheMethodsFiltersDo)
{
  // A curve that moves as a whole is a handle with this motion.
  Sketch sketch;
  sketch.Path = Row(3, 9, 6);
  for (int y = 7; y < 10; ++y)
  {
    sketch.Path.push_back(Id(9, y));
  }
  SetPointIds(sketch.Filter.Get(), sketch.Path);
  const cartan::Points rest = sketch.Rest();
  vtkNew<vtkHandleMotion> motion;
  motion->SetAxis(1.0, 0.3, 0.2);
  motion->SetAngle(25.0);
  motion->SetTranslation(0.1, 0.0, 0.4);
  vtkNew<vtkMatrix4x4> transform;
  motion->GetTransform(transform);
  const Eigen::Matrix4d matrix =
    Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(transform->GetData());
  sketch.SetTarget((rest * matrix.topLeftCorner<3, 3>().transpose()).rowwise() +
    matrix.topRightCorner<3, 1>().transpose());
  const auto marked = vtkSmartPointer<vtkPolyData>::New();
  marked->DeepCopy(sketch.Surface);
  vtkDataArray* handles = marked->GetPointData()->GetArray("Handle");
  for (const vtkIdType id : sketch.Path)
  {
    handles->SetTuple1(id, 2.0);
  }
  const auto others = CarryingFilters();
  ASSERT_EQ(static_cast<int>(others.size()), vtkCurveDeformation::MULTIRESOLUTION + 1);
  for (int method = 0; method < static_cast<int>(others.size()); ++method)
  {
    vtkSurfaceDeformation* other = others[static_cast<std::size_t>(method)];
    other->SetInputData(marked);
    other->SetHandleMotion(2, motion);
    other->Update();
    sketch.Filter->SetMethod(method);
    const auto result = sketch.Filter.Works();
    EXPECT_LT((vtktest::PointsOf(result) - vtktest::PointsOf(other->GetOutput())).norm(), 1e-9)
      << method;
    EXPECT_GT((vtktest::PointsOf(result) - vtktest::PointsOf(marked)).norm(), 0.1);
  }
}

TEST(CurveDeformation, GeodesicsKeepWhatIsBesideThem)
{
  // Across the plane's squares, where edges would go along two sides.
  const auto plane = vtktest::MakePolyData(shapes::Plane(20, 4.0));
  const vtkIdType from = plane->FindPoint(-1.2, 1.6, 0.0);
  const vtkIdType to = plane->FindPoint(1.2, -1.4, 0.0);
  Advised<vtkCurveDeformation> filter;
  EXPECT_EQ(filter->GetSource(), vtkCurveDeformation::GEODESIC);
  filter->SetInputData(plane);
  SetPointIds(filter.Get(), { from, to });
  cartan::Points ends = PlacesOf(plane, { from, to });
  filter->SetTargetData(Line(ends));
  const cartan::Points rest = vtktest::PointsOf(plane);
  EXPECT_LT((vtktest::PointsOf(filter.Works()) - rest).norm(), 1e-12);
  EXPECT_GT(filter->GetNumberOfCurvePoints(), 20);
  // Turned as a whole, the surface goes with it; edges would be drawn to the line.
  const Eigen::AngleAxisd turn(0.7, Eigen::Vector3d(0.2, 0.1, 1.0).normalized());
  filter->SetTargetData(Line(ends * turn.toRotationMatrix().transpose()));
  const cartan::Points turned = vtktest::PointsOf(filter.Works());
  const Eigen::RowVector3d along =
    (ends.row(1) - ends.row(0)) * turn.toRotationMatrix().transpose();
  // The turn about the line is open, so only what is on it is known.
  const auto distance = [&](vtkIdType v)
  {
    const Eigen::Vector3d way =
      (turned.row(v) - ends.row(0) * turn.toRotationMatrix().transpose()).transpose();
    return way.cross(along.transpose().normalized()).norm();
  };
  const Eigen::RowVector3d flat = ends.row(1) - ends.row(0);
  for (vtkIdType v = 0; v < plane->GetNumberOfPoints(); ++v)
  {
    const Eigen::Vector3d way = (rest.row(v) - ends.row(0)).transpose();
    EXPECT_NEAR(distance(v), way.cross(flat.transpose().normalized()).norm(), 1e-9);
  }
  filter->SetSourceToShortestPath();
  const cartan::Points drawn = vtktest::PointsOf(filter.Works());
  EXPECT_GT((drawn - turned).rowwise().norm().maxCoeff(), 0.1);
}

TEST(CurveDeformation, FidelityGoesFromAHintToTheCurve)
{
  Sketch sketch;
  sketch.SetTarget(sketch.Rest().rowwise() + Eigen::RowVector3d(0.0, 0.0, 0.5));
  double before = 0.51;
  for (const double fidelity : { 0.0, 0.1, 0.5, 0.9, 0.99, 1.0 })
  {
    sketch.Filter->SetFidelity(fidelity);
    sketch.Filter.Works();
    EXPECT_LT(sketch.Filter->GetLargestDistance(), before);
    before = sketch.Filter->GetLargestDistance();
  }
  EXPECT_LT(before, 1e-12);
}

TEST(CurveDeformation, ReversedTargetsAndKeysAreFollowed)
{
  Sketch sketch;
  const cartan::Points lifted = sketch.Rest().rowwise() + Eigen::RowVector3d(0.0, 0.0, 0.3);
  const cartan::Points backward = lifted.colwise().reverse();
  sketch.Filter->SetSourceToShortestPath();
  SetPointIds(sketch.Filter.Get(), { sketch.Path.front(), sketch.Path.back() });
  sketch.SetTarget(backward);
  sketch.Filter->ReverseTargetOn();
  const auto result = sketch.Filter.Works();
  EXPECT_LT((PlacesOf(result, { sketch.Path.front() }) - lifted.topRows(1)).norm(), 1e-9);
  // The second point goes to the target's middle.
  sketch.Filter->ReverseTargetOff();
  sketch.Filter->SetSourceToSelectedPoints();
  SetPointIds(sketch.Filter.Get(), sketch.Path);
  const auto target = Line(lifted);
  vtktest::AddArray(target, "SourcePoint", 1,
    [&](vtkIdType i, double* key) { *key = i == 3 ? static_cast<double>(sketch.Path[1]) : -1.0; });
  sketch.Filter->SetTargetData(target);
  const auto keyed = sketch.Filter.Works();
  EXPECT_LT((PlacesOf(keyed, { sketch.Path[1] }) - lifted.row(3)).norm(), 1e-9);
}

TEST(CurveDeformation, ReachPinsWhatIsFar)
{
  Sketch sketch;
  sketch.SetTarget(sketch.Rest().rowwise() + Eigen::RowVector3d(0.0, 0.0, 0.3));
  sketch.Filter->SetHandleArrayName("None");
  sketch.Filter->SetReach(0.8);
  const auto result = sketch.Filter.Works();
  int moved = 0;
  for (vtkIdType v = 0; v < result->GetNumberOfPoints(); ++v)
  {
    const Eigen::Vector3d rest(sketch.Surface->GetPoint(v));
    const bool isMoved = Eigen::Vector3d(result->GetPoint(v)) != rest;
    moved += isMoved ? 1 : 0;
    EXPECT_FALSE(isMoved && std::abs(rest.y()) > 1.2);
  }
  EXPECT_GT(moved, 20);
}

TEST(CurveDeformation, RidgesHaveTheirHeightAndWidth)
{
  const auto plane = vtktest::MakePolyData(shapes::Plane(40, 4.0));
  Advised<vtkCurveDeformation> filter;
  filter->SetInputData(plane);
  SetPointIds(filter.Get(), { 20 * 41, 20 * 41 + 40 }); // along y = 0
  filter->SetRidgeWidth(0.5);
  for (const bool isSharp : { false, true })
  {
    filter->SetSharpRidge(isSharp);
    filter->SetRidgeHeight(isSharp ? -0.2 : 0.3);
    const auto result = filter.Works();
    for (vtkIdType v = 0; v < result->GetNumberOfPoints(); ++v)
    {
      const double t = std::min(std::abs(plane->GetPoint(v)[1]) / 0.5, 1.0);
      const double expected = isSharp ? -0.2 * (1.0 - t) : 0.3 * std::pow(1.0 - t * t, 2);
      EXPECT_NEAR(result->GetPoint(v)[2], expected, 1e-9);
    }
  }
}

TEST(CurveDeformation, RidgesFollowGeodesics)
{
  const auto plane = vtktest::MakePolyData(shapes::Plane(40, 4.0));
  Advised<vtkCurveDeformation> filter;
  filter->SetInputData(plane);
  const vtkIdType from = plane->FindPoint(-1.0, 1.6, 0.0);
  const vtkIdType to = plane->FindPoint(1.2, -1.4, 0.0);
  SetPointIds(filter.Get(), { from, to });
  filter->SetRidgeWidth(0.5);
  filter->SetRidgeHeight(0.3);
  const auto result = filter.Works();
  const cartan::Points ends = PlacesOf(plane, { from, to });
  for (vtkIdType v = 0; v < result->GetNumberOfPoints(); ++v)
  {
    const double t =
      std::min(DistanceToCurve(Eigen::Vector3d(plane->GetPoint(v)), ends) / 0.5, 1.0);
    EXPECT_NEAR(result->GetPoint(v)[2], 0.3 * std::pow(1.0 - t * t, 2), 1e-9);
  }
}

TEST(CurveDeformation, PathsFollowFeaturesAndOutlines)
{
  const auto bar = vtktest::MakePolyData(shapes::Bar(4, 4, 16, { 1.0, 1.0, 4.0 }));
  Advised<vtkCurveDeformation> filter;
  filter->SetInputData(bar);
  filter->SetRidgeHeight(0.01);
  // Beside a long edge, on a face.
  SetPointIds(filter.Get(), { bar->FindPoint(0.5, 0.25, 0.5), bar->FindPoint(0.5, 0.25, 3.5) });
  filter.Works();
  EXPECT_EQ(filter->GetNumberOfCurvePoints(), 13);
  filter->SetSourceToFeatureEdges();
  filter.Works();
  EXPECT_EQ(filter->GetNumberOfCurvePoints(), 13);
  filter->SetFeatureAngle(100.0);
  filter.Refuses({ Advice("choose two points of one such line, another FeatureAngle or "
                          "ViewDirection, or set Source to the shortest path.") });
  filter->SetFeatureAngle(30.0);
  filter.Works();
  filter->SetSourceToSilhouette();
  filter->SetViewDirection(1.0, -1.0, 0.0);
  filter.Works();
  filter->SetSourceToShortestPath();
  filter.Works();
}

TEST(CurveDeformation, NeedsAPathAndSomethingToDo)
{
  Sketch sketch;
  Advised<vtkCurveDeformation>& filter = sketch.Filter;
  filter.Refuses({ Advice(
    "There is no target curve and no ridge: connect a line to port 1, or set RidgeHeight.") });
  filter->SetRidgeHeight(0.1);
  filter.Works();
  filter->SetRidgeHeight(0.0);
  sketch.SetTarget(sketch.Rest());
  filter.Works();

  filter->SetSourceToShortestPath();
  SetPointIds(filter.Get(), { Id(3, 6) });
  filter.Refuses({ "there are 1", Advice("add the points that it starts and ends at.") });
  SetPointIds(filter.Get(), { Id(3, 6), Id(9, 6) });
  filter.Works();

  SetPointIds(filter.Get(), { Id(3, 6), Id(9, 6), Id(5, 6) });
  filter.Refuses({ Advice("choose PointIds in the order of a curve that does not cross itself.") });
  SetPointIds(filter.Get(), { Id(3, 6), Id(5, 6), Id(9, 6) });
  filter.Works();

  filter->SetSourceToSelectedPoints();
  SetPointIds(filter.Get(), { Id(3, 6), Id(9, 6) });
  filter.Refuses({ "2 selected points",
    Advice("Select the points of one line, or set Source to "
           "the shortest path between points of it in their "
           "order.") });
  filter->SetSourceToShortestPath();
  filter.Works();
  SetPointIds(filter.Get(), { Id(3, 6), 4711 });
  filter.Refuses({ "4711" });
}

TEST(CurveDeformation, TargetsAreOneOpenLineNearTheSurface)
{
  Sketch sketch;
  Advised<vtkCurveDeformation>& filter = sketch.Filter;
  const cartan::Points good = sketch.Rest();
  filter->SetTargetData(vtktest::MakePolyData(shapes::Plane(1)));
  filter.Refuses({ Advice("The target curve has no lines: connect a polyline, such as a Poly "
                          "Line Source or a Spline Source.") });
  sketch.SetTarget(good);
  filter.Works();

  // Two lines; then one of them.
  const auto two = Line(good);
  two->GetPoints()->InsertNextPoint(0.0, 0.0, 1.0);
  two->GetPoints()->InsertNextPoint(1.0, 0.0, 1.0);
  two->GetLines()->InsertNextCell({ 7, 8 });
  filter->SetTargetData(two);
  filter.Refuses({ "its 2 lines",
    Advice("Connect one open line, such as a part of it from "
           "Extract Cells, or turn ClosedCurve on for a ring.") });
  two->GetLines()->Initialize();
  two->GetLines()->InsertNextCell({ 8, 7 });
  two->Modified();
  filter.Works();

  cartan::Points point = good;
  point.rowwise() = good.row(0).eval();
  sketch.SetTarget(point);
  filter.Refuses({ Advice("give it two different points or more.") });
  point.row(6) = good.row(6);
  sketch.SetTarget(point);
  filter.Works();

  cartan::Points crossing(4, 3);
  crossing << -1, 0, 0, 1, 0, 0, 1, 1, 0, -1, -1, 0;
  sketch.SetTarget(crossing);
  filter.Refuses(
    { "1 segment (id 0)", Advice("move its points apart, or leave a gap between its ends.") });
  crossing(2, 2) = crossing(3, 2) = 0.2;
  sketch.SetTarget(crossing);
  filter.Works();

  sketch.SetTarget(1000.0 * good);
  filter.Refuses({ Advice("move or scale it to the surface (Transform).") });
  sketch.SetTarget(1.1 * good);
  filter.Works();
}

TEST(CurveDeformation, KeysRunAlongBothCurves)
{
  Sketch sketch;
  Advised<vtkCurveDeformation>& filter = sketch.Filter;
  const auto target = Line(sketch.Rest());
  filter->SetTargetData(target);
  const auto setKeys = [&](vtkIdType first, vtkIdType second)
  {
    vtktest::AddArray(target, "SourcePoint", 1,
      [&](vtkIdType i, double* key) {
        *key = i == 2 ? static_cast<double>(first) : i == 4 ? static_cast<double>(second) : -1.0;
      });
    target->Modified();
  };
  setKeys(Id(0, 0), -1);
  filter.Refuses({ Advice("give ids of its points, or -1 for none.") });
  setKeys(sketch.Path[3], -1);
  filter.Works();
  setKeys(sketch.Path[4], sketch.Path[2]);
  filter.Refuses({ Advice("reverse the target, or remove keys.") });
  setKeys(-1, sketch.Path[2]);
  filter.Works();
}
}
