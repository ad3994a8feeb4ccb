// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "TestShapes.h"

#include "Kernel/Mesh/SurfaceRepair.h"
#include "Kernel/Mesh/TriangleMesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

/// Surfaces that are no manifold, not oriented, or not joined, and what can be
/// said of them once they are repaired.
namespace shapes
{
/// Each triangle with three points of its own, as STL files store surfaces.
inline Shape Soup(const Shape& shape)
{
  Shape soup;
  soup.Positions.resize(shape.Faces.size(), 3);
  soup.Faces.resize(shape.Faces.rows(), 3);
  for (int corner = 0; corner < shape.Faces.size(); ++corner)
  {
    soup.Positions.row(corner) = shape.Positions.row(shape.Faces.data()[corner]);
    soup.Faces.data()[corner] = corner;
  }
  return soup;
}

/// Turns over the triangles that a fixed sequence picks, about half of them.
inline Shape RandomlyTurned(Shape shape, unsigned int seed)
{
  Random random(seed);
  for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
  {
    if (random() < 0.0)
    {
      std::swap(shape.Faces(t, 1), shape.Faces(t, 2));
    }
  }
  return shape;
}

inline Shape Moved(Shape shape, const Eigen::RowVector3d& by)
{
  shape.Positions.rowwise() += by;
  return shape;
}

inline double Area(const cartan::Points& points, const cartan::Triangles& faces)
{
  double area = 0.0;
  for (Eigen::Index t = 0; t < faces.rows(); ++t)
  {
    const Eigen::Vector3d a = points.row(faces(t, 0));
    const Eigen::Vector3d b = points.row(faces(t, 1));
    const Eigen::Vector3d c = points.row(faces(t, 2));
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  return area;
}

inline double Volume(const cartan::Points& points, const cartan::Triangles& faces)
{
  double volume = 0.0;
  for (Eigen::Index t = 0; t < faces.rows(); ++t)
  {
    const Eigen::Vector3d a = points.row(faces(t, 0));
    const Eigen::Vector3d b = points.row(faces(t, 1));
    const Eigen::Vector3d c = points.row(faces(t, 2));
    volume += a.dot(b.cross(c)) / 6.0;
  }
  return volume;
}

/// What a repaired surface is, by counting.
struct Topology
{
  int Components = 0;
  int BorderEdges = 0;
  int Euler = 0; ///< vertices - edges + triangles
};

inline Topology TopologyOf(const cartan::RepairedSurface& surface)
{
  const cartan::TriangleMesh mesh(static_cast<int>(surface.Positions.rows()), surface.Faces);
  Topology topology;
  topology.Components = mesh.NumberOfComponents();
  int used = 0;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    used += mesh.IsUsed(v);
    topology.BorderEdges += mesh.IsBoundary(v);
  }
  topology.Euler = used - mesh.NumberOfEdges() + mesh.NumberOfTriangles();
  return topology;
}

/// The laws of every repair: a manifold whose ids lead back to the input.
inline void ExpectConsistent(
  const Shape& input, const cartan::RepairedSurface& result, double tolerance = 0.0)
{
  const cartan::MeshReport report = cartan::TriangleMesh::Check(result.Positions, result.Faces);
  EXPECT_TRUE(report.IsUsable()) << report.DescribeErrors();
  ASSERT_EQ(result.OriginalPoints.size(), static_cast<std::size_t>(result.Positions.rows()));
  ASSERT_EQ(result.OriginalTriangles.size(), static_cast<std::size_t>(result.Faces.rows()));
  ASSERT_EQ(result.PreparedPoints.size(), static_cast<std::size_t>(input.Positions.rows()));
  for (Eigen::Index v = 0; v < result.Positions.rows(); ++v)
  {
    ASSERT_EQ(result.Positions.row(v), input.Positions.row(result.OriginalPoints[v]));
    const int first = result.CopyOf[v];
    ASSERT_LE(first, v);
    ASSERT_LE((result.Positions.row(first) - result.Positions.row(v)).norm(), 2 * tolerance);
  }
  for (Eigen::Index v = 0; v < input.Positions.rows(); ++v)
  {
    const int prepared = result.PreparedPoints[v];
    if (prepared >= 0)
    {
      ASSERT_LT(prepared, result.Positions.rows());
      ASSERT_LE((result.Positions.row(prepared) - input.Positions.row(v)).norm(), 2 * tolerance);
    }
  }
}

/// Repairs and holds the laws.
inline cartan::RepairedSurface Repaired(
  const Shape& input, const cartan::RepairOptions& options = {})
{
  cartan::RepairedSurface result = cartan::RepairSurface(input.Positions, input.Faces, options);
  ExpectConsistent(input, result, options.MergeTolerance);
  return result;
}
}
