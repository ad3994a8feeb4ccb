// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Algebra/SimilarityFit.h"
#include "Kernel/Merging/ClosestAlignment.h"

#include "TestShapes.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

namespace
{
/// x -> s R x + t.
Eigen::Matrix4d Similarity(double scale, double angle, const Eigen::Vector3d& shift)
{
  Eigen::Matrix4d motion = Eigen::Matrix4d::Identity();
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, -1).normalized();
  motion.topLeftCorner<3, 3>() = scale * Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  motion.topRightCorner<3, 1>() = shift;
  return motion;
}

double LargestDifference(const Eigen::Matrix4d& a, const Eigen::Matrix4d& b)
{
  return (a - b).cwiseAbs().maxCoeff();
}
}

// A copy of the surface finds its place again: three different axes determine it.
TEST(ClosestAlignment, TakesACopyBack)
{
  const shapes::Shape shape = shapes::Ellipsoid(2, { 2.0, 1.0, 0.6 });
  const cartan::TriangleMesh mesh(shape.NumberOfVertices(), shape.Faces);
  for (const double scale : { 1.0, 1.3 })
  {
    const Eigen::Matrix4d motion = Similarity(scale, 0.4, { 3.0, -2.0, 1.0 });
    const cartan::Points moved = cartan::Moved(shape.Positions, motion);
    const Eigen::Matrix4d found =
      cartan::AlignToSurface(moved, mesh, shape.Positions, scale != 1.0);
    EXPECT_LT(LargestDifference(found * motion, Eigen::Matrix4d::Identity()), 1e-3) << scale;
  }
}

// So does one in another unit.
TEST(ClosestAlignment, FindsSizesThatDifferByMuch)
{
  const shapes::Shape shape = shapes::Ellipsoid(2, { 2.0, 1.0, 0.6 });
  const cartan::TriangleMesh mesh(shape.NumberOfVertices(), shape.Faces);
  for (const double scale : { 1e-3, 0.1, 10.0, 1e3 })
  {
    const Eigen::Matrix4d motion = Similarity(scale, 0.3, { 3.0, -2.0, 1.0 });
    const cartan::Points moved = cartan::Moved(shape.Positions, motion);
    const Eigen::Matrix4d found = cartan::AlignToSurface(moved, mesh, shape.Positions, true);
    EXPECT_LT(LargestDifference(found * motion, Eigen::Matrix4d::Identity()), 1e-3) << scale;
  }
}

// A common motion of both sides turns the alignment with them.
TEST(ClosestAlignment, FollowsACommonMotion)
{
  const shapes::Shape shape = shapes::Noisy(shapes::Ellipsoid(2, { 2.0, 1.0, 0.6 }), 0.05);
  const shapes::Shape other = shapes::Ellipsoid(2, { 1.8, 1.1, 0.7 });
  const cartan::TriangleMesh mesh(other.NumberOfVertices(), other.Faces);
  const Eigen::Matrix4d alignment =
    cartan::AlignToSurface(shape.Positions, mesh, other.Positions, true);
  const Eigen::Matrix4d motion = Similarity(2.5, 2.0, { 0.5, 4.0, -1.0 });
  const Eigen::Matrix4d moved = cartan::AlignToSurface(
    cartan::Moved(shape.Positions, motion), mesh, cartan::Moved(other.Positions, motion), true);
  EXPECT_LT(LargestDifference(moved * motion, motion * alignment), 1e-8);
}

// Without scales no length changes, though a smaller copy would lie closer.
TEST(ClosestAlignment, KeepsLengthsWithoutScales)
{
  const shapes::Shape shape = shapes::Ellipsoid(2, { 2.0, 1.0, 0.6 });
  const cartan::TriangleMesh mesh(shape.NumberOfVertices(), shape.Faces);
  const Eigen::Matrix4d found =
    cartan::AlignToSurface(1.2 * shape.Positions, mesh, shape.Positions, false);
  const Eigen::Matrix3d linear = found.topLeftCorner<3, 3>();
  EXPECT_LT((linear * linear.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}
