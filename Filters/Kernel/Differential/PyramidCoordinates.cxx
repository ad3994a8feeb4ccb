// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/PyramidCoordinates.h"

#include <Eigen/Geometry>

namespace cartan
{
namespace
{
/// Area vectors below this part of the areas are made of rounding.
constexpr double RoundingOfAreas = 1e-10;

/// The same of products.
constexpr double RoundingOfProducts = 1e-12;

Eigen::Vector3d EdgeOf(const TriangleMesh& mesh, const Points& points, int v, int d)
{
  return (points.row(mesh.Neighbor(d)) - points.row(v)).transpose();
}
}

Eigen::Vector3d RingAreaVector(const TriangleMesh& mesh, const Points& points, int v)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double areas = 0.0;
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    const int next = mesh.NextAround(v, d);
    if (next >= 0)
    {
      const Eigen::Vector3d area =
        0.5 * EdgeOf(mesh, points, v, d).cross(EdgeOf(mesh, points, v, next));
      sum += area;
      areas += area.norm();
    }
  }
  return sum.norm() > RoundingOfAreas * areas ? sum : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

Matrices PyramidFrames(
  const TriangleMesh& mesh, const Points& points, const ExecutionContext& context)
{
  Matrices frames(mesh.NumberOfVertices(), 9);
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        MatrixAt(frames, v).setIdentity();
        const Eigen::Vector3d area = RingAreaVector(mesh, points, v);
        if (!area.isZero(0.0))
        {
          const Eigen::Vector3d normal = area.normalized();
          const Eigen::Vector3d first = normal.unitOrthogonal();
          Eigen::Matrix3d frame;
          frame << first, normal.cross(first), normal;
          MatrixAt(frames, v) = frame;
        }
      }
    });
  return frames;
}

Points PyramidCoordinates(const TriangleMesh& mesh, const Points& points, const Matrices& frames,
  const ExecutionContext& context)
{
  Points rings(mesh.NumberOfDirectedEdges(), 3);
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        const Eigen::Matrix3d frame = MatrixAt(frames, v);
        for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
        {
          rings.row(d) = (frame.transpose() * EdgeOf(mesh, points, v, d)).transpose();
        }
      }
    });
  return rings;
}

Eigen::Matrix3d RingProduct(const TriangleMesh& mesh, const Points& points, const Points& rings,
  const Eigen::VectorXd& weights, int v)
{
  Eigen::Matrix3d product = Eigen::Matrix3d::Zero();
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    product += weights[d] * EdgeOf(mesh, points, v, d) * rings.row(d);
  }
  return product;
}

double RingResidual(const TriangleMesh& mesh, const Points& points, const Points& rings,
  const Eigen::VectorXd& weights, int v, const Eigen::Matrix3d& rotation)
{
  double sum = 0.0;
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    sum +=
      weights[d] * (EdgeOf(mesh, points, v, d) - rotation * rings.row(d).transpose()).squaredNorm();
  }
  return sum;
}

PyramidFit FitPyramid(
  const Eigen::Matrix3d& product, const Eigen::Vector3d& areaVector, const Eigen::Matrix3d& guess)
{
  const double area = areaVector.norm();
  const Eigen::Vector3d n = areaVector / area;
  const Eigen::Vector3d a = product.col(0);
  const Eigen::Vector3d b = product.col(1);
  Eigen::Vector3d r = a - a.dot(n) * n + b.cross(n);
  const bool isDetermined = r.norm() > RoundingOfProducts * product.norm();
  if (!isDetermined)
  {
    r = Eigen::Quaterniond::FromTwoVectors(guess.col(2), n) * guess.col(0);
  }
  r.normalize();
  PyramidFit fit;
  fit.Frame << r, n.cross(r), n;
  // <R, M> = r . (a + b x n) + n . c, in which r is at its best. By n:
  Eigen::Vector3d slope = product.col(2);
  if (isDetermined)
  {
    slope += r.cross(b) - a.dot(n) * r;
  }
  // And n follows the area vector.
  fit.SlopeOfArea = (slope - slope.dot(n) * n) / area;
  return fit;
}
}
