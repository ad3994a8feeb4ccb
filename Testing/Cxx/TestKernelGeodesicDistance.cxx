// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Mesh/GeodesicDistance.h"

#include "TestShapes.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <queue>
#include <string>

using cartan::GeodesicDistance;
using cartan::Points;
using cartan::TriangleMesh;

namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();

TriangleMesh MakeMesh(const shapes::Shape& shape)
{
  return TriangleMesh(shape.NumberOfVertices(), shape.Faces);
}

Eigen::VectorXd StraightDistance(const Points& points, const std::vector<int>& sources)
{
  Eigen::VectorXd distance = Eigen::VectorXd::Constant(points.rows(), Infinity);
  for (const int source : sources)
  {
    distance = distance.cwiseMin((points.rowwise() - points.row(source)).rowwise().norm());
  }
  return distance;
}

// Dijkstra's algorithm on the edges.
Eigen::VectorXd EdgeDistance(
  const TriangleMesh& mesh, const Points& points, const std::vector<int>& sources)
{
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
  Eigen::VectorXd distance = Eigen::VectorXd::Constant(points.rows(), Infinity);
  for (const int source : sources)
  {
    distance[source] = 0.0;
    queue.emplace(0.0, source);
  }
  while (!queue.empty())
  {
    const auto [value, v] = queue.top();
    queue.pop();
    if (value > distance[v])
    {
      continue;
    }
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      const int w = mesh.Neighbor(d);
      const double next = value + (points.row(v) - points.row(w)).norm();
      if (next < distance[w])
      {
        distance[w] = next;
        queue.emplace(next, w);
      }
    }
  }
  return distance;
}

void ExpectWithinBounds(const shapes::Shape& shape, const std::vector<int>& sources)
{
  const TriangleMesh mesh = MakeMesh(shape);
  const Eigen::VectorXd distance = GeodesicDistance(mesh, shape.Positions, sources);
  const Eigen::VectorXd lower = StraightDistance(shape.Positions, sources);
  const Eigen::VectorXd upper = EdgeDistance(mesh, shape.Positions, sources);
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    EXPECT_GE(distance[v], lower[v] * (1 - 1e-12)) << "vertex " << v;
    EXPECT_LE(distance[v], upper[v] * (1 + 1e-12)) << "vertex " << v;
  }
}

// The largest error from the north pole of the unit sphere.
double SphereError(int level)
{
  const shapes::Shape sphere = shapes::Icosphere(level);
  const Eigen::VectorXd distance = GeodesicDistance(MakeMesh(sphere), sphere.Positions, { 0 });
  const Eigen::RowVector3d source = sphere.Positions.row(0);
  double error = 0.0;
  for (int v = 0; v < sphere.NumberOfVertices(); ++v)
  {
    const double cosine = source.dot(sphere.Positions.row(v));
    const double sine = source.cross(sphere.Positions.row(v)).norm();
    error = std::max(error, std::abs(distance[v] - std::atan2(sine, cosine)));
  }
  return error;
}

// The largest error of the distance from a disc of vertices about the origin
// of the unit square, relative to the distance from the disc itself.
double DiscError(int count)
{
  const shapes::Shape plane = shapes::Plane(count, 1.0, 0.25, 3);
  const double radius = 0.2;
  std::vector<int> sources;
  for (int v = 0; v < plane.NumberOfVertices(); ++v)
  {
    if (plane.Positions.row(v).norm() <= radius)
    {
      sources.push_back(v);
    }
  }
  const Eigen::VectorXd distance = GeodesicDistance(MakeMesh(plane), plane.Positions, sources);
  double error = 0.0;
  for (int v = 0; v < plane.NumberOfVertices(); ++v)
  {
    const double exact = std::max(0.0, plane.Positions.row(v).norm() - radius);
    error = std::max(error, std::abs(distance[v] - exact));
  }
  return error;
}
}

TEST(GeodesicDistance, IsStraightInThePlane)
{
  for (const double jitter : { 0.0, 0.3 })
  {
    const shapes::Shape plane = shapes::Plane(30, 2.0, jitter, 5);
    const TriangleMesh mesh = MakeMesh(plane);
    for (const int source : { 0, 15, 480, 960 })
    {
      const Eigen::VectorXd distance = GeodesicDistance(mesh, plane.Positions, { source });
      const Eigen::VectorXd exact = StraightDistance(plane.Positions, { source });
      EXPECT_LT((distance - exact).cwiseAbs().maxCoeff(), 1e-8)
        << "source " << source << ", jitter " << jitter;
    }
  }
}

TEST(GeodesicDistance, IsStraightInAPlaneOfObtuseTriangles)
{
  // Sheared so far that half of the triangles have angles above 150 degrees.
  for (const double shear : { -2.5, -1.0, 1.0, 2.5 })
  {
    shapes::Shape plane = shapes::Plane(20, 1.0, 0.2, 2);
    plane.Positions.col(0) += shear * plane.Positions.col(1);
    const TriangleMesh mesh = MakeMesh(plane);
    for (const int source : { 0, 5, 210, 220 })
    {
      const Eigen::VectorXd distance = GeodesicDistance(mesh, plane.Positions, { source });
      const Eigen::VectorXd exact = StraightDistance(plane.Positions, { source });
      EXPECT_LT(((distance - exact).array() / (exact.array() + 1e-12)).maxCoeff(), 0.01)
        << "shear " << shear << ", source " << source;
    }
  }
}

TEST(GeodesicDistance, ConvergesAtLeastLinearlyFromARegion)
{
  const double coarse = DiscError(25);
  const double fine = DiscError(100);
  RecordProperty("coarse", std::to_string(coarse));
  RecordProperty("fine", std::to_string(fine));
  EXPECT_LT(coarse, 0.04 * std::sqrt(2.0)); // one diagonal: how well vertices fill the disc
  EXPECT_LT(fine, coarse / 3.0);
}

TEST(GeodesicDistance, ConvergesOnTheSphere)
{
  const double error3 = SphereError(3);
  const double error4 = SphereError(4);
  const double error5 = SphereError(5);
  RecordProperty("level3", std::to_string(error3));
  RecordProperty("level5", std::to_string(error5));
  EXPECT_LT(error3, 0.08);
  EXPECT_LT(error4, error3 / 1.6);
  EXPECT_LT(error5, error4 / 1.6);
}

TEST(GeodesicDistance, UnrollsAPrism)
{
  // A cylinder's mesh is a prism, whose sides unroll into the plane.
  const int around = 24;
  const int along = 20;
  const double length = 3.0;
  const shapes::Shape cylinder = shapes::OpenCylinder(around, along, 1.0, length);
  const int source = 10 * around;
  const Eigen::VectorXd distance =
    GeodesicDistance(MakeMesh(cylinder), cylinder.Positions, { source });
  const double side = 2.0 * std::sin(shapes::Pi / around);
  double error = 0.0;
  for (int v = 0; v < cylinder.NumberOfVertices(); ++v)
  {
    const int sides = std::min(v % around, around - v % around);
    const double exact =
      std::hypot(sides * side, cylinder.Positions(v, 2) - cylinder.Positions(source, 2));
    error = std::max(error, std::abs(distance[v] - exact));
  }
  EXPECT_LT(error, 1e-8);
}

TEST(GeodesicDistance, StaysBetweenTheStraightLineAndTheEdges)
{
  ExpectWithinBounds(shapes::Plane(15, 1.0, 0.3, 4), { 7, 130, 131, 255 });
  ExpectWithinBounds(shapes::Torus(30, 16, 2.0, 0.7, 0.25, 6), { 0, 200 });
  ExpectWithinBounds(shapes::Saddle(16, 3.0, 0.2), { 20 });
  ExpectWithinBounds(shapes::Noisy(shapes::Icosphere(3), 0.05), { 1, 2, 3 });
  ExpectWithinBounds(shapes::UvSphere(40, 9), { 0 });
  ExpectWithinBounds(shapes::Bar(4, 3, 9, { 1.0, 1.0, 4.0 }), { 5, 60 });
}

TEST(GeodesicDistance, GoesAroundABoundary)
{
  // A slotted plane: the shortest path from one side of the slot to the other
  // bends at its end.
  const int count = 40;
  shapes::Shape plane = shapes::Plane(count, 2.0);
  const double h = 2.0 / count;
  std::vector<Eigen::Vector3i> kept;
  for (Eigen::Index t = 0; t < plane.Faces.rows(); ++t)
  {
    const Eigen::Vector3i face = plane.Faces.row(t).transpose();
    const Eigen::RowVector3d center =
      (plane.Positions.row(face[0]) + plane.Positions.row(face[1]) + plane.Positions.row(face[2])) /
      3.0;
    if (!(std::abs(center[0]) < h && center[1] < 0.0))
    {
      kept.push_back(face);
    }
  }
  plane.Faces = shapes::ToTriangles(kept);
  const auto at = [](int i, int j) { return j * (count + 1) + i; };
  const int source = at(10, 10); // (-0.5, -0.5)
  const int target = at(30, 10); // (0.5, -0.5)
  const Eigen::VectorXd distance = GeodesicDistance(MakeMesh(plane), plane.Positions, { source });
  const double exact = 2.0 * std::hypot(0.5 - h, 0.5) + 2.0 * h;
  EXPECT_GE(distance[target], exact - 1e-9);
  EXPECT_LT(distance[target], exact + h);
}

TEST(GeodesicDistance, DoesNotChangeUnderRigidMotionsAndScalesWithTheSurface)
{
  const shapes::Shape torus = shapes::Torus(24, 14, 2.0, 0.7, 0.2);
  const Eigen::VectorXd distance = GeodesicDistance(MakeMesh(torus), torus.Positions, { 17 });
  const shapes::Shape moved = shapes::RandomRigidMotion(9, 5.0)(torus);
  EXPECT_LT(
    (GeodesicDistance(MakeMesh(moved), moved.Positions, { 17 }) - distance).cwiseAbs().maxCoeff(),
    1e-8);
  const double tiny = 1e-9;
  const Points scaled = tiny * torus.Positions;
  EXPECT_LT(
    (GeodesicDistance(MakeMesh(torus), scaled, { 17 }) / tiny - distance).cwiseAbs().maxCoeff(),
    1e-8);
}

TEST(GeodesicDistance, TakesTheNearestSource)
{
  const shapes::Shape plane = shapes::Plane(20);
  const TriangleMesh mesh = MakeMesh(plane);
  const Eigen::VectorXd both = GeodesicDistance(mesh, plane.Positions, { 0, 440, 0 });
  const Eigen::VectorXd nearest = GeodesicDistance(mesh, plane.Positions, { 0 })
                                    .cwiseMin(GeodesicDistance(mesh, plane.Positions, { 440 }));
  EXPECT_LT((both - nearest).cwiseAbs().maxCoeff(), 0.05); // one edge length
  EXPECT_EQ(both[0], 0.0);
  EXPECT_EQ(both[440], 0.0);
}

TEST(GeodesicDistance, StaysInItsComponent)
{
  const shapes::Shape sphere = shapes::Icosphere(1);
  shapes::Shape two = shapes::Union(sphere, sphere);
  two.Positions.conservativeResize(two.Positions.rows() + 1, 3); // a vertex in no triangle
  two.Positions.bottomRows(1).setZero();
  const int count = sphere.NumberOfVertices();
  const Eigen::VectorXd distance = GeodesicDistance(MakeMesh(two), two.Positions, { 3, 2 * count });
  EXPECT_TRUE(distance.head(count).array().isFinite().all());
  EXPECT_TRUE((distance.segment(count, count).array() == Infinity).all());
  EXPECT_EQ(distance[2 * count], 0.0); // the unused vertex is a source
  EXPECT_EQ(GeodesicDistance(MakeMesh(two), two.Positions, { 3 })[2 * count], Infinity);
  EXPECT_TRUE((GeodesicDistance(MakeMesh(two), two.Positions, {}).array() == Infinity).all());
}

TEST(GeodesicDistance, IsTheSameWithinALimit)
{
  const shapes::Shape sphere = shapes::Noisy(shapes::Icosphere(4), 0.01);
  const TriangleMesh mesh = MakeMesh(sphere);
  const Eigen::VectorXd whole = GeodesicDistance(mesh, sphere.Positions, { 0, 40 });
  for (const double limit : { 0.0, 0.1, 0.5, 1.0 })
  {
    const Eigen::VectorXd part = GeodesicDistance(mesh, sphere.Positions, { 0, 40 }, limit);
    for (int v = 0; v < sphere.NumberOfVertices(); ++v)
    {
      EXPECT_EQ(part[v], whole[v] <= limit ? whole[v] : Infinity) << "vertex " << v;
    }
  }
}

TEST(GeodesicDistance, SurvivesDegenerateTriangles)
{
  // Two coincident vertices and a triangle without area in a row of triangles.
  shapes::Shape shape;
  shape.Positions = shapes::ToPoints(
    { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 2, 0, 0 }, { 1, 1, 0 } });
  shape.Faces = shapes::ToTriangles({ { 0, 1, 3 }, { 1, 2, 3 }, { 2, 5, 3 }, { 2, 4, 5 } });
  const Eigen::VectorXd distance = GeodesicDistance(MakeMesh(shape), shape.Positions, { 0 });
  EXPECT_NEAR(distance[1], 1.0, 1e-12);
  EXPECT_NEAR(distance[2], 1.0, 1e-12);
  EXPECT_NEAR(distance[4], 2.0, 1e-12);
  EXPECT_NEAR(distance[5], std::sqrt(2.0), 1e-9);
  EXPECT_EQ(GeodesicDistance(TriangleMesh(), Points(0, 3), {}).size(), 0);
}

TEST(GeodesicDistance, ReportsProgressAndStops)
{
  const shapes::Shape sphere = shapes::Icosphere(5);
  const TriangleMesh mesh = MakeMesh(sphere);
  std::vector<double> fractions;
  const cartan::ExecutionContext record({},
    [&fractions](double fraction)
    {
      fractions.push_back(fraction);
      return true;
    });
  GeodesicDistance(mesh, sphere.Positions, { 0 }, Infinity, record);
  ASSERT_GE(fractions.size(), 2u);
  EXPECT_LT(fractions.front(), fractions.back());
  EXPECT_LE(fractions.back(), 1.0);

  const cartan::ExecutionContext stop({}, [](double) { return false; });
  EXPECT_THROW(GeodesicDistance(mesh, sphere.Positions, { 0 }, Infinity, stop), cartan::Error);
}

TEST(GeodesicDistance, RefusesWhatIsNoSourceOrLimit)
{
  const shapes::Shape plane = shapes::Plane(2);
  const TriangleMesh mesh = MakeMesh(plane);
  const auto message = [&](const std::vector<int>& sources, double limit) -> std::string
  {
    try
    {
      GeodesicDistance(mesh, plane.Positions, sources, limit);
    }
    catch (const cartan::Error& error)
    {
      EXPECT_EQ(error.GetCode(), cartan::ErrorCode::BadInput);
      return error.what();
    }
    return {};
  };
  EXPECT_NE(message({ 0, -1, 9 }, 1.0).find("2 vertices that are (ids -1, 9) not in the mesh of 9"),
    std::string::npos);
  EXPECT_NE(message({ 0 }, -1.0).find("limit"), std::string::npos);
  EXPECT_NE(message({ 0 }, std::nan("")).find("limit"), std::string::npos);
}
