// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Mesh/RayTree.h"

#include "AllTriangles.h"
#include "RealMeshes.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

using namespace cartan;

namespace
{
RayTree TreeOf(const shapes::Shape& shape)
{
  return RayTree(shape.Faces, shape.Positions);
}

Eigen::Vector3d RandomVector(shapes::Random& random)
{
  const double x = random();
  const double y = random();
  const double z = random();
  return { x, y, z };
}

/// Triangles without a common point, of any shape and direction.
shapes::Shape Scattered(int count)
{
  shapes::Random random(4);
  shapes::Shape shape;
  shape.Positions.resize(3 * count, 3);
  shape.Faces.resize(count, 3);
  for (int t = 0; t < count; ++t)
  {
    const Eigen::Vector3d middle = RandomVector(random);
    for (int corner = 0; corner < 3; ++corner)
    {
      shape.Positions.row(3 * t + corner) = middle + 0.2 * RandomVector(random);
      shape.Faces(t, corner) = 3 * t + corner;
    }
  }
  return shape;
}

bool HasCorner(const shapes::Shape& shape, int triangle, int vertex)
{
  return triangle >= 0 && (shape.Faces.row(triangle).array() == vertex).any();
}
}

TEST(RayTree, FindsWhatATestOfAllTrianglesFinds)
{
  const std::vector<std::pair<std::string, shapes::Shape>> cases = {
    { "sphere", shapes::Noisy(shapes::Icosphere(3), 0.05) },
    { "torus", shapes::Noisy(shapes::Torus(30, 15), 0.05) },
    { "bar, flat boxes", shapes::Bar(5, 6, 20, { 1.0, 1.2, 4.0 }) },
    { "two bodies", shapes::Union(shapes::Icosphere(2), shapes::Bar(3, 3, 9, { 1, 1, 3 })) },
    { "scattered", Scattered(500) },
    { "one triangle", Scattered(1) },
    { "camel", shapes::RealMesh("camel") },
  };
  for (const auto& [name, shape] : cases)
  {
    const RayTree tree = TreeOf(shape);
    const RayCaster all = shapes::CastThroughAll(shape);
    const Eigen::Vector3d low = shape.Positions.colwise().minCoeff();
    const Eigen::Vector3d high = shape.Positions.colwise().maxCoeff();
    const double size = (high - low).norm();
    shapes::Random random(1);
    int hits = 0;
    int misses = 0;
    for (int ray = 0; ray < 400; ++ray)
    {
      // From inside and outside of the box to any side.
      const Eigen::Vector3d from =
        0.5 * (low + high) + RandomVector(random).cwiseProduct(high - low);
      const Eigen::Vector3d direction = RandomVector(random).normalized();
      const RayHit found = tree.FirstHit(from, direction);
      const RayHit expected = all(from, direction);
      EXPECT_EQ(found.Triangle, expected.Triangle) << name << ", ray " << ray;
      EXPECT_NEAR(found.Distance, expected.Distance, 1e-12 * size) << name << ", ray " << ray;
      ++(expected.Triangle < 0 ? misses : hits);
    }
    EXPECT_GT(misses, 20) << name;
    EXPECT_TRUE(hits > 20 || shape.Faces.rows() == 1) << name;
  }
}

TEST(RayTree, GivesTheDepthsThatATestOfAllTrianglesGives)
{
  for (const shapes::Shape& shape :
    { shapes::Noisy(shapes::Torus(30, 15), 0.05), shapes::Bar(4, 4, 12, { 1.0, 1.0, 3.0 }) })
  {
    const TriangleMesh mesh = shapes::MakeMesh(shape);
    const RayTree tree = TreeOf(shape);
    const VolumeModel found = MeasureVolumeModel(mesh, shape.Positions,
      [&tree](const Eigen::Vector3d& from, const Eigen::Vector3d& direction)
      { return tree.FirstHit(from, direction); });
    const VolumeModel expected =
      MeasureVolumeModel(mesh, shape.Positions, shapes::CastThroughAll(shape));
    EXPECT_EQ(found.IsMeasured, expected.IsMeasured);
    EXPECT_LT((found.LocalDepth - expected.LocalDepth).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(RayTree, LetsNoRaySlipThroughAnEdgeOrAVertex)
{
  // From inside a convex surface every ray leaves, and what is aimed at is the
  // first to be met.
  for (const shapes::Shape& shape : { shapes::Icosphere(4), shapes::UvSphere(60, 40),
         shapes::Ellipsoid(3, { 1.0, 0.01, 3.0 }), shapes::Bar(7, 7, 7, { 1.0, 1.0, 1.0 }) })
  {
    const RayTree tree = TreeOf(shape);
    const Eigen::Vector3d middle =
      0.5 * (shape.Positions.colwise().minCoeff() + shape.Positions.colwise().maxCoeff());
    const double size =
      (shape.Positions.colwise().maxCoeff() - shape.Positions.colwise().minCoeff()).norm();
    shapes::Random random(2);
    for (const Eigen::Vector3d& from : { middle, Eigen::Vector3d(middle.array() + 0.003) })
    {
      for (int v = 0; v < shape.NumberOfVertices(); ++v)
      {
        const Eigen::Vector3d way = shape.Positions.row(v).transpose() - from;
        const RayHit hit = tree.FirstHit(from, way.normalized());
        EXPECT_TRUE(HasCorner(shape, hit.Triangle, v)) << "vertex " << v;
        EXPECT_NEAR(hit.Distance, way.norm(), 1e-11 * size) << "vertex " << v;
      }
      for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
      {
        const double part = 0.5 + 0.5 * random();
        const int a = shape.Faces(t, t % 3);
        const int b = shape.Faces(t, (t + 1) % 3);
        const Eigen::Vector3d way =
          (1.0 - part) * shape.Positions.row(a) + part * shape.Positions.row(b) - from.transpose();
        const RayHit hit = tree.FirstHit(from, way.normalized());
        EXPECT_TRUE(HasCorner(shape, hit.Triangle, a) || HasCorner(shape, hit.Triangle, b))
          << "an edge of triangle " << t;
        EXPECT_NEAR(hit.Distance, way.norm(), 1e-11 * size) << "an edge of triangle " << t;
      }
    }
  }
}

TEST(RayTree, FollowsAxesAndStartsOnTheSidesOfBoxes)
{
  // All of it lies on planes across the axes: the bar from 0 to 3 along z.
  const shapes::Shape bar = shapes::Bar(4, 4, 12, { 1.0, 1.0, 3.0 });
  const RayTree tree = TreeOf(bar);
  for (int v = 0; v < bar.NumberOfVertices(); ++v)
  {
    const Eigen::Vector3d p = bar.Positions.row(v);
    for (int axis = 0; axis < 3; ++axis)
    {
      const double low = bar.Positions.col(axis).minCoeff();
      const double high = bar.Positions.col(axis).maxCoeff();
      Eigen::Vector3d from = p;
      from[axis] = low - 2.0;
      const Eigen::Vector3d up = Eigen::Vector3d::Unit(axis);
      EXPECT_NEAR(tree.FirstHit(from, up).Distance, 2.0, 1e-12) << v;
      from[axis] = high + 2.0;
      // With zeros of the other sign.
      EXPECT_NEAR(tree.FirstHit(from, -up).Distance, 2.0, 1e-12) << v;
      EXPECT_EQ(tree.FirstHit(from, up).Triangle, -1) << v;
    }
    EXPECT_EQ(tree.FirstHit(p, Eigen::Vector3d(0.36, 0.48, 0.8)).Distance, 0.0) << v;
  }
}

TEST(RayTree, MeetsTheNeighborsOfTrianglesSeenEdgeOn)
{
  // In the plane of the lid: the lid is not met, the side below it is.
  const RayTree tree = TreeOf(shapes::Bar(4, 4, 12, { 1.0, 1.0, 3.0 }));
  const Eigen::Vector3d from(-2.0, 0.1, 3.0);
  const RayHit hit = tree.FirstHit(from, Eigen::Vector3d::UnitX());
  EXPECT_NEAR(hit.Distance, 1.5, 1e-12);
}

TEST(RayTree, MeetsTrianglesSeenEdgeOnWhereTheyAre)
{
  const shapes::Shape shape = Scattered(300);
  shapes::Random random(5);
  for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
  {
    const RayTree tree(shape.Faces.row(t), shape.Positions);
    Eigen::Matrix3d corners;
    for (int corner = 0; corner < 3; ++corner)
    {
      corners.col(corner) = shape.Positions.row(shape.Faces(t, corner));
    }
    const Eigen::Vector3d normal =
      (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0)).normalized();
    const Eigen::Vector3d middle = corners.rowwise().mean();
    const Eigen::Vector3d direction = RandomVector(random).cross(normal).normalized();
    // Tilted so little that rounding takes the distance over.
    for (double tilt = 1e-16; tilt < 1e-12; tilt *= 1.5)
    {
      const Eigen::Vector3d tilted = (direction + tilt * normal).normalized();
      const RayHit hit = tree.FirstHit(middle - tilted, tilted);
      if (hit.Triangle >= 0)
      {
        const Eigen::Vector3d point = middle + (hit.Distance - 1.0) * tilted;
        int axis = 0;
        tilted.cwiseAbs().maxCoeff(&axis);
        EXPECT_GE(point[axis], corners.row(axis).minCoeff() - 1e-12) << t;
        EXPECT_LE(point[axis], corners.row(axis).maxCoeff() + 1e-12) << t;
      }
    }
  }
}

TEST(RayTree, MeetsNothingWithoutArea)
{
  // A plane behind needles and points that the rays run into.
  shapes::Shape shape = shapes::Plane(6, 2.0);
  const int vertices = shape.NumberOfVertices();
  const auto triangles = static_cast<int>(shape.Faces.rows());
  Points positions(vertices + 3, 3);
  positions << shape.Positions, Eigen::RowVector3d(-1.0, 0.1, 1.0),
    Eigen::RowVector3d(0.5, 0.1, 1.0), Eigen::RowVector3d(1.0, 0.1, 1.0);
  Triangles faces(triangles + 3, 3);
  faces << Eigen::RowVector3i(vertices, vertices + 1, vertices + 2),
    Eigen::RowVector3i(vertices, vertices, vertices + 2),
    Eigen::RowVector3i(vertices + 1, vertices + 1, vertices + 1), shape.Faces;
  const RayTree tree(faces, positions);
  for (const double x : { -0.9, 0.0, 0.5, 0.7 })
  {
    const RayHit hit = tree.FirstHit({ x, 0.1, 2.0 }, -Eigen::Vector3d::UnitZ());
    EXPECT_NEAR(hit.Distance, 2.0, 1e-12) << x;
    EXPECT_GE(hit.Triangle, 3) << x;
  }
  // Nothing but points in one place.
  const RayTree points(Triangles::Zero(20, 3), Points::Zero(1, 3));
  EXPECT_EQ(points.FirstHit({ 0.0, 0.0, 1.0 }, -Eigen::Vector3d::UnitZ()).Triangle, -1);
}

TEST(RayTree, TakesTheFirstOfEqualTriangles)
{
  const shapes::Shape sphere = shapes::Noisy(shapes::Icosphere(2), 0.05);
  const Eigen::Index triangles = sphere.Faces.rows();
  Triangles twice(2 * triangles, 3);
  twice << sphere.Faces, sphere.Faces;
  const RayTree once = TreeOf(sphere);
  const RayTree both(twice, sphere.Positions);
  shapes::Random random(3);
  for (int ray = 0; ray < 200; ++ray)
  {
    const Eigen::Vector3d from = 0.3 * RandomVector(random);
    const Eigen::Vector3d direction = RandomVector(random).normalized();
    EXPECT_EQ(both.FirstHit(from, direction).Triangle, once.FirstHit(from, direction).Triangle);
  }
}

TEST(RayTree, FindsTheSameFarAwayAndAtAnySize)
{
  // Multiples of 1/8, and of 2^-10 for the starts: moved and scaled without rounding.
  const shapes::Shape bar = shapes::Bar(8, 8, 8, { 1.0, 1.0, 1.0 });
  const RayTree tree = TreeOf(bar);
  for (const double size : { std::ldexp(1.0, -30), 1.0, std::ldexp(1.0, 30) })
  {
    const Eigen::Vector3d shift = size * Eigen::Vector3d(1 << 20, -(1 << 21), 1 << 19);
    shapes::Shape moved = bar;
    moved.Positions = (size * bar.Positions).rowwise() + shift.transpose();
    const RayTree other = TreeOf(moved);
    for (int v = 0; v < bar.NumberOfVertices(); ++v)
    {
      const Eigen::Vector3d p = bar.Positions.row(v);
      for (const Eigen::Vector3d& from :
        { Eigen::Vector3d(0.0, 0.0, 0.5), Eigen::Vector3d(1.0 / 8.0, 3.0 / 1024.0, 0.5),
          Eigen::Vector3d(p[0], p[1], 2.0), Eigen::Vector3d(-2.0, p[1], p[2]) })
      {
        const Eigen::Vector3d direction = (p - from).normalized();
        const RayHit expected = tree.FirstHit(from, direction);
        const RayHit hit = other.FirstHit(size * from + shift, direction);
        EXPECT_GE(expected.Triangle, 0) << v;
        EXPECT_EQ(hit.Triangle, expected.Triangle) << v;
        EXPECT_NEAR(hit.Distance / size, expected.Distance, 1e-14) << v;
      }
    }
  }
}

TEST(RayTree, MeetsNothingWhereThereIsNothingToMeet)
{
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const RayTree empty(Triangles(0, 3), Points(0, 3));
  EXPECT_EQ(empty.FirstHit(Eigen::Vector3d::Zero(), up).Triangle, -1);
  EXPECT_LT(empty.FirstHit(Eigen::Vector3d::Zero(), up).Distance, 0.0);

  const RayTree tree = TreeOf(shapes::Icosphere(2));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(tree.FirstHit({ 0.0, 0.0, 2.0 }, up).Triangle, -1); // away from it
  EXPECT_EQ(tree.FirstHit(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()).Triangle, -1);
  EXPECT_EQ(tree.FirstHit({ 0.0, nan, 0.0 }, up).Triangle, -1);
  EXPECT_EQ(tree.FirstHit(Eigen::Vector3d::Zero(), { 0.0, nan, 1.0 }).Triangle, -1);
}
