// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Geometry.h"

#include <cmath>

namespace cartan
{
namespace
{
/// Below this part of the summed sizes, what is left of a sum of vectors is
/// rounding and has no direction.
constexpr double Canceled = 1e-12;
}

Points TriangleAreaVectors(
  const Points& points, const Triangles& triangles, const ExecutionContext& context)
{
  Points vectors(triangles.rows(), 3);
  context.For(static_cast<int>(triangles.rows()),
    [&](int begin, int end)
    {
      for (int t = begin; t < end; ++t)
      {
        const Eigen::Vector3d a = points.row(triangles(t, 0));
        const Eigen::Vector3d ab = points.row(triangles(t, 1)).transpose() - a;
        const Eigen::Vector3d ac = points.row(triangles(t, 2)).transpose() - a;
        vectors.row(t) = ab.cross(ac);
      }
    });
  return vectors;
}

Points VertexNormals(
  const TriangleMesh& mesh, const Points& points, const ExecutionContext& context)
{
  const Points areaVectors = TriangleAreaVectors(points, mesh.GetTriangles(), context);
  const Eigen::VectorXd sizes = areaVectors.rowwise().norm();
  Points normals(mesh.NumberOfVertices(), 3);
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
        double size = 0.0;
        for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
        {
          if (mesh.LeftTriangle(d) >= 0)
          {
            sum += areaVectors.row(mesh.LeftTriangle(d));
            size += sizes[mesh.LeftTriangle(d)];
          }
        }
        const double length = sum.norm();
        if (length > Canceled * size)
        {
          normals.row(v) = sum / length;
        }
        else
        {
          normals.row(v).setZero();
        }
      }
    });
  return normals;
}

Eigen::VectorXd MixedVoronoiAreas(
  const TriangleMesh& mesh, const Points& points, const ExecutionContext& context)
{
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(mesh.NumberOfVertices());
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
        {
          const int next = mesh.NextAround(v, d);
          if (next < 0)
          {
            continue;
          }
          const Eigen::Vector3d p = points.row(v);
          const Eigen::Vector3d pq = points.row(mesh.Neighbor(d)).transpose() - p;
          const Eigen::Vector3d pr = points.row(mesh.Neighbor(next)).transpose() - p;
          const Eigen::Vector3d qr = pr - pq;
          const double twiceArea = pq.cross(pr).norm();
          if (pq.dot(pr) < 0.0)
          {
            areas[v] += twiceArea / 4.0;
          }
          else if (-pq.dot(qr) < 0.0 || pr.dot(qr) < 0.0)
          {
            areas[v] += twiceArea / 8.0;
          }
          else if (twiceArea > 0.0)
          {
            // |pq|^2 cot(r) + |pr|^2 cot(q), over eight.
            areas[v] +=
              (pq.squaredNorm() * pr.dot(qr) - pr.squaredNorm() * pq.dot(qr)) / (8.0 * twiceArea);
          }
        }
      }
    });
  return areas;
}

bool EnclosesVolume(double volume, double area)
{
  return std::abs(volume) > 1e-12 * area * std::sqrt(area);
}

double BoundingDiagonal(const Points& points)
{
  return points.rows() ? (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm() : 0.0;
}

double BoundingDiagonal(const Points& points, const Triangles& triangles)
{
  if (triangles.rows() == 0)
  {
    return 0.0;
  }
  // Numbers of their own, which stay in registers: a box of Eigen's goes through memory.
  const Eigen::Vector3d first = points.row(triangles(0, 0));
  double lowX = first.x(), highX = first.x();
  double lowY = first.y(), highY = first.y();
  double lowZ = first.z(), highZ = first.z();
  for (Eigen::Index corner = 0; corner < triangles.size(); ++corner)
  {
    const double* point = points.data() + 3 * Eigen::Index(triangles.data()[corner]);
    lowX = std::min(lowX, point[0]);
    highX = std::max(highX, point[0]);
    lowY = std::min(lowY, point[1]);
    highY = std::max(highY, point[1]);
    lowZ = std::min(lowZ, point[2]);
    highZ = std::max(highZ, point[2]);
  }
  return Eigen::Vector3d(highX - lowX, highY - lowY, highZ - lowZ).norm();
}
}
