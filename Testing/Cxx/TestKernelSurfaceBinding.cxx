// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Deformation/SurfaceBinding.h"

#include "Kernel/Mesh/Geometry.h"
#include "RealMeshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using cartan::Points;
using cartan::SurfaceBinding;
using cartan::TriangleMesh;
using shapes::Shape;

namespace
{
SurfaceBinding Bind(const Shape& shape, const Points& queries)
{
  return { std::make_shared<const TriangleMesh>(shapes::MakeMesh(shape)),
    std::make_shared<const Points>(shape.Positions), queries };
}

Points Rows(const std::vector<Eigen::Vector3d>& points)
{
  Points rows(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    rows.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  }
  return rows;
}

/// Points inside and around a box that is larger than the shape.
Points Around(const Shape& shape, int count)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> draw(-0.2, 1.2);
  const Eigen::RowVector3d low = shape.Positions.colwise().minCoeff();
  const Eigen::RowVector3d size = shape.Positions.colwise().maxCoeff() - low;
  Points points(count, 3);
  for (int i = 0; i < count; ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      points(i, k) = low[k] + draw(random) * size[k];
    }
  }
  return points;
}

/// (x, y, z) rolled onto a cylinder of radius r about the y axis at height r over z = 0:
/// planes z = const keep their length at z = 0.
Points Rolled(const Points& points, double radius)
{
  Points rolled(points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    const double angle = points(i, 0) / radius;
    const double arm = radius - points(i, 2);
    rolled.row(i) << arm * std::sin(angle), points(i, 1), radius - arm * std::cos(angle);
  }
  return rolled;
}
}

TEST(SurfaceBinding, FollowsRigidMotionsExactly)
{
  const shapes::RigidMotion motion = shapes::RandomRigidMotion(8, 5.0);
  for (const Shape& shape : { shapes::Noisy(shapes::Icosphere(3), 0.02),
         shapes::Bar(3, 3, 9, { 1.0, 1.0, 3.0 }), shapes::OpenCylinder(20, 10) })
  {
    const Points queries = Around(shape, 300);
    const double diagonal = cartan::BoundingDiagonal(shape.Positions);
    const auto carried = Bind(shape, queries).Evaluate(motion(shape.Positions));
    EXPECT_LT((carried.Positions - motion(queries)).rowwise().norm().maxCoeff(), 1e-12 * diagonal);
  }
}

TEST(SurfaceBinding, TakesPointsOnTheSurfaceToTheirPlaces)
{
  const Shape shape = shapes::Noisy(shapes::Bar(3, 3, 9, { 1.0, 1.0, 3.0 }), 0.02);
  const Points deformed = Rolled(shape.Positions, 0.7);
  const auto vertices = Bind(shape, shape.Positions);
  EXPECT_EQ((vertices.Evaluate(deformed).Positions - deformed).cwiseAbs().maxCoeff(), 0.0);
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    EXPECT_EQ(vertices.VertexOf(v), v);
  }
  std::vector<Eigen::Vector3d> places;
  std::vector<Eigen::Vector3d> expected;
  for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
  {
    const auto at = [&](const Points& points, double a, double b) -> Eigen::Vector3d
    {
      return (a * points.row(shape.Faces(t, 0)) + b * points.row(shape.Faces(t, 1)) +
        (1.0 - a - b) * points.row(shape.Faces(t, 2)))
        .transpose();
    };
    for (const auto& [a, b] : { std::pair(0.2, 0.5), std::pair(0.0, 0.5), std::pair(0.1, 0.1) })
    {
      places.push_back(at(shape.Positions, a, b));
      expected.push_back(at(deformed, a, b));
    }
  }
  const Points carried = Bind(shape, Rows(places)).Evaluate(deformed).Positions;
  EXPECT_LT((carried - Rows(expected)).rowwise().norm().maxCoeff(), 1e-13);
}

// A plate that is rolled up carries what is d above it to the radius r - d.
TEST(SurfaceBinding, MissesABendByNoMoreThanItsBound)
{
  const Shape plate = shapes::Plane(60, 6.0, 0.2);
  std::vector<Eigen::Vector3d> above;
  for (const double height : { -0.6, -0.3, -0.1, 0.1, 0.3, 0.6 })
  {
    for (int i = 0; i < 40; ++i)
    {
      above.emplace_back(-1.0 + 0.05 * i, 0.3 * std::sin(i), height);
    }
  }
  Points rest = plate.Positions;
  rest.rowwise() -= rest.colwise().mean().eval();
  Shape centered = plate;
  centered.Positions = rest;
  const Points queries = Rows(above);
  const auto binding = Bind(centered, queries);
  for (const double radius : { 2.0, 4.0, 8.0 })
  {
    const Points carried = binding.Evaluate(Rolled(rest, radius)).Positions;
    const Points exact = Rolled(queries, radius);
    double largest = 0.0;
    for (Eigen::Index i = 0; i < queries.rows(); ++i)
    {
      const double bound = queries(i, 2) * queries(i, 2) / radius;
      const double error = (carried.row(i) - exact.row(i)).norm();
      EXPECT_LT(error, bound) << radius << " " << queries.row(i);
      largest = std::max(largest, error / bound);
    }
    EXPECT_GT(largest, 0.05); // the bound says something
    EXPECT_NEAR(binding.GetDistances()[0], 0.6, 1e-12);
  }
}

// Across the medial axis, where the nearest place jumps from one side to the other.
TEST(SurfaceBinding, MovesNeighborsAlike)
{
  const Shape bar = shapes::Bar(8, 8, 24, { 1.0, 1.0, 3.0 });
  std::vector<Eigen::Vector3d> line;
  const Eigen::Vector3d low = bar.Positions.colwise().minCoeff().transpose();
  const Eigen::Vector3d high = bar.Positions.colwise().maxCoeff().transpose();
  for (int i = 0; i <= 2000; ++i)
  {
    line.push_back(low + (high - low) * (i / 2000.0));
  }
  Points points = bar.Positions;
  points.col(0).swap(points.col(2));
  Shape along = bar;
  along.Positions = points;
  for (Eigen::Vector3d& place : line)
  {
    std::swap(place[0], place[2]);
  }
  const Points carried = Bind(along, Rows(line)).Evaluate(Rolled(points, 2.0)).Positions;
  const double step = (line[1] - line[0]).norm();
  for (Eigen::Index i = 1; i < carried.rows(); ++i)
  {
    EXPECT_LT((carried.row(i) - carried.row(i - 1)).norm(), 6.0 * step) << i;
  }
}

TEST(TriangleTree, FindsTheClosestPoint)
{
  const Shape shape = shapes::Noisy(shapes::Torus(16, 9), 0.1);
  const cartan::TriangleTree tree(shape.Faces, shape.Positions);
  const Points queries = Around(shape, 200);
  for (Eigen::Index i = 0; i < queries.rows(); ++i)
  {
    const Eigen::Vector3d query = queries.row(i).transpose();
    double smallest = 1e9;
    for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
    {
      const auto corner = [&](int k) -> Eigen::Vector3d
      { return shape.Positions.row(shape.Faces(t, k)).transpose(); };
      const cartan::ClosestPoint found =
        cartan::ClosestOnTriangle(corner(0), corner(1), corner(2), query);
      // Nothing of the triangle is nearer: its points form no acute angle there.
      const Eigen::Vector3d place =
        found.Weights[0] * corner(0) + found.Weights[1] * corner(1) + found.Weights[2] * corner(2);
      EXPECT_NEAR((place - query).norm(), found.Distance, 1e-12);
      for (int k = 0; k < 3; ++k)
      {
        EXPECT_LT((corner(k) - place).dot(query - place), 1e-12);
      }
      smallest = std::min(smallest, found.Distance);
    }
    EXPECT_EQ(tree.Closest(query).second.Distance, smallest);
  }
}
