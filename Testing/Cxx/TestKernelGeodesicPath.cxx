// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Mesh/GeodesicPath.h"

#include "AdviceWords.h"
#include "Kernel/Base/Error.h"
#include "Kernel/Mesh/EdgePaths.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace
{
using cartan::CurveAcross;
using cartan::EdgePoint;
using cartan::Points;
using cartan::TriangleMesh;
using shapes::Shape;

TriangleMesh MeshOf(const Shape& shape)
{
  return TriangleMesh(shape.NumberOfVertices(), shape.Faces);
}

double LengthOf(const std::vector<EdgePoint>& path, const Points& points)
{
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i)
  {
    length += (path[i].In(points) - path[i - 1].In(points)).norm();
  }
  return length;
}

double EdgeLength(const TriangleMesh& mesh, const Points& points, int from, int to)
{
  const std::vector<int> path = cartan::ShortestEdgePath(mesh, points, from, to);
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i)
  {
    length += (points.row(path[i]) - points.row(path[i - 1])).norm();
  }
  return length;
}

int Nearest(const Shape& shape, const Eigen::RowVector3d& x)
{
  Eigen::Index nearest = 0;
  (shape.Positions.rowwise() - x).rowwise().squaredNorm().minCoeff(&nearest);
  return static_cast<int>(nearest);
}

/// Whether the vertices beside a curve are a path of edges that passes none twice.
void ExpectPath(const TriangleMesh& mesh, const std::vector<int>& vertices)
{
  for (std::size_t i = 1; i < vertices.size(); ++i)
  {
    bool areNeighbors = false;
    for (int d = mesh.RingBegin(vertices[i]); d < mesh.RingEnd(vertices[i]); ++d)
    {
      areNeighbors = areNeighbors || mesh.Neighbor(d) == vertices[i - 1];
    }
    EXPECT_TRUE(areNeighbors);
  }
  std::vector<int> sorted = vertices;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end());
}

TEST(GeodesicPath, IsStraightInThePlane)
{
  const Shape plane = shapes::Plane(30, 3.0, 0.3, 5);
  const TriangleMesh mesh = MeshOf(plane);
  shapes::Random random(7);
  for (int trial = 0; trial < 20; ++trial)
  {
    const int from = Nearest(plane, { 1.4 * random(), 1.4 * random(), 0.0 });
    const int to = Nearest(plane, { 1.4 * random(), 1.4 * random(), 0.0 });
    const double distance = (plane.Positions.row(to) - plane.Positions.row(from)).norm();
    const auto path = cartan::GeodesicPath(mesh, plane.Positions, from, to);
    EXPECT_NEAR(LengthOf(path, plane.Positions), distance, 1e-9);
    if (from == to)
    {
      continue;
    }
    // Those that move are beside it, and their places on it.
    const CurveAcross curve = cartan::GeodesicThrough(mesh, plane.Positions, { from, to }, false);
    ExpectPath(mesh, curve.Vertices);
    EXPECT_EQ(curve.Vertices.front(), from);
    EXPECT_EQ(curve.Vertices.back(), to);
    double before = -1.0;
    for (Eigen::Index i = 0; i < curve.Places.rows(); ++i)
    {
      const Eigen::RowVector3d place = curve.Places.row(i);
      const double along = (place - plane.Positions.row(from)).norm();
      EXPECT_NEAR(along + (place - plane.Positions.row(to)).norm(), distance, 1e-9);
      EXPECT_GT(along, before);
      EXPECT_LT((place - plane.Positions.row(curve.Vertices[i])).norm(), 0.11);
      before = along;
    }
  }
}

TEST(GeodesicPath, UnrollsDevelopables)
{
  // Up a tube and a third of the way around it; along edges it is longer.
  const Shape tube = shapes::OpenCylinder(60, 60, 1.0, 4.0);
  const TriangleMesh mesh = MeshOf(tube);
  const double turn = 2.0 * shapes::Pi / 3.0;
  const int from = Nearest(tube, { 1.0, 0.0, tube.Positions.col(2).minCoeff() });
  const int to =
    Nearest(tube, { std::cos(turn), std::sin(turn), tube.Positions.col(2).maxCoeff() });
  const double around = 20.0 * 2.0 * std::sin(shapes::Pi / 60.0);
  const double length =
    LengthOf(cartan::GeodesicPath(mesh, tube.Positions, from, to), tube.Positions);
  EXPECT_NEAR(length, std::hypot(around, 4.0), 1e-6);
  EXPECT_GT(EdgeLength(mesh, tube.Positions, from, to), 1.02 * length);
}

TEST(GeodesicPath, FollowsGreatCircles)
{
  const Shape sphere = shapes::Icosphere(4);
  const TriangleMesh mesh = MeshOf(sphere);
  shapes::Random random(3);
  for (int trial = 0; trial < 20; ++trial)
  {
    const int from = Nearest(sphere, { random(), random(), random() });
    const int to = Nearest(sphere, { random(), random(), random() });
    const Eigen::Vector3d a = sphere.Positions.row(from).transpose();
    const Eigen::Vector3d b = sphere.Positions.row(to).transpose();
    const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
    if (angle < 0.3 || angle > 2.8)
    {
      continue;
    }
    const auto path = cartan::GeodesicPath(mesh, sphere.Positions, from, to);
    EXPECT_NEAR(LengthOf(path, sphere.Positions), angle, 0.005 * angle);
    EXPECT_LE(LengthOf(path, sphere.Positions), EdgeLength(mesh, sphere.Positions, from, to));
    const Eigen::Vector3d normal = a.cross(b).normalized();
    for (const EdgePoint& point : path)
    {
      EXPECT_LT(std::abs(point.In(sphere.Positions).dot(normal)), 0.05);
    }
  }
}

TEST(GeodesicPath, DistancesFromItAreThoseOnTheSphere)
{
  const Shape sphere = shapes::Icosphere(4);
  const TriangleMesh mesh = MeshOf(sphere);
  const int a = Nearest(sphere, { 1.0, 0.1, 0.0 });
  const int b = Nearest(sphere, { -0.5, 0.8, 0.1 });
  const int c = Nearest(sphere, { -0.5, -0.8, -0.1 });
  const CurveAcross ring = cartan::GeodesicThrough(mesh, sphere.Positions, { a, b, c }, true);
  const Eigen::VectorXd distances =
    cartan::DistanceFromCurve(mesh, sphere.Positions, ring, true, 0.8);
  const Eigen::Vector3d axis = (sphere.Positions.row(b) - sphere.Positions.row(a))
                                 .cross(sphere.Positions.row(c) - sphere.Positions.row(a))
                                 .normalized()
                                 .transpose();
  for (int v = 0; v < sphere.NumberOfVertices(); ++v)
  {
    const double angle = std::abs(std::asin(sphere.Positions.row(v).dot(axis)));
    if (angle < 0.6)
    {
      EXPECT_NEAR(distances[v], angle, 0.08);
    }
    EXPECT_TRUE(std::isfinite(distances[v]) || angle > 0.7);
  }
}

TEST(GeodesicPath, TurnsAroundCorners)
{
  // Without the quadrant x, y > 0 the way leads over the corner in the middle, beyond which
  // distances are of first order.
  Shape plane = shapes::Plane(20, 2.0);
  Points kept(0, 3);
  std::vector<Eigen::Vector3i> faces;
  for (Eigen::Index t = 0; t < plane.Faces.rows(); ++t)
  {
    Eigen::RowVector3d middle = Eigen::RowVector3d::Zero();
    for (int c = 0; c < 3; ++c)
    {
      middle += plane.Positions.row(plane.Faces(t, c)) / 3.0;
    }
    if (middle.x() < 0.0 || middle.y() < 0.0)
    {
      faces.emplace_back(plane.Faces.row(t).transpose());
    }
  }
  plane.Faces = shapes::ToTriangles(faces);
  const TriangleMesh mesh = MeshOf(plane);
  const int from = Nearest(plane, { 0.9, -0.3, 0.0 });
  const int to = Nearest(plane, { -0.3, 0.7, 0.0 });
  const auto path = cartan::GeodesicPath(mesh, plane.Positions, from, to);
  EXPECT_NEAR(LengthOf(path, plane.Positions), std::hypot(0.9, 0.3) + std::hypot(0.3, 0.7), 0.01);
}

TEST(GeodesicPath, LeadsThroughPicksAndAround)
{
  const Shape sphere = shapes::Icosphere(3);
  const TriangleMesh mesh = MeshOf(sphere);
  const int a = Nearest(sphere, { 1.0, 0.0, 0.3 });
  const int b = Nearest(sphere, { -0.5, 0.8, 0.3 });
  const int c = Nearest(sphere, { -0.5, -0.8, 0.3 });
  const CurveAcross ring = cartan::GeodesicThrough(mesh, sphere.Positions, { a, b, c }, true);
  ExpectPath(mesh, ring.Vertices);
  EXPECT_EQ(ring.Vertices.front(), a);
  EXPECT_EQ(std::count(ring.Vertices.begin(), ring.Vertices.end(), c), 1);
  EXPECT_EQ(ring.Places.rows(), static_cast<Eigen::Index>(ring.Vertices.size()));
  const CurveAcross line = cartan::GeodesicThrough(mesh, sphere.Positions, { a, b, c }, false);
  EXPECT_EQ(line.Vertices.back(), c);
  EXPECT_LT(line.Vertices.size(), ring.Vertices.size());
  // Between components there is none.
  const Shape two = shapes::Union(sphere, shapes::Icosphere(1, 3.0));
  EXPECT_TRUE(
    cartan::GeodesicPath(MeshOf(two), two.Positions, 0, two.NumberOfVertices() - 1).empty());
  EXPECT_THROW(
    cartan::GeodesicThrough(MeshOf(two), two.Positions, { 0, two.NumberOfVertices() - 1 }, false),
    cartan::Error);
}
}
