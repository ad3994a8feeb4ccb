// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "TestShapes.h"

#include "Kernel/Mesh/SurfaceRepair.h"
#include "Kernel/Mesh/TriangleMesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

/// Surfaces that are not manifold, not oriented, or not joined, and what can be
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

/// A cube of edge 1 and n x n quads on each side.
inline Shape Box(const Eigen::RowVector3d& at = Eigen::RowVector3d::Zero(), int n = 1)
{
  return Moved(Bar(n, n, n, { 1, 1, 1 }), at);
}

/// Merges all points, also those of bodies in contact.
inline cartan::RepairOptions MergingAll()
{
  cartan::RepairOptions options;
  options.MergesInnerPoints = true;
  return options;
}

/// A band of quads that closes after `turns` half twists; ids as in Patch.
inline Shape TwistedBand(int around, int across, int turns)
{
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3i> faces;
  const auto id = [&](int i, int j) {
    return i < around ? i * (across + 1) + j : turns % 2 == 1 ? across - j : j;
  };
  for (int i = 0; i < around; ++i)
  {
    const double u = 2 * Pi * i / around;
    for (int j = 0; j <= across; ++j)
    {
      const double v = static_cast<double>(j) / across - 0.5;
      const double twist = 0.5 * turns * u;
      const double r = 2.0 + v * std::cos(twist);
      positions.emplace_back(r * std::cos(u), r * std::sin(u), v * std::sin(twist));
    }
    for (int j = 0; j < across; ++j)
    {
      faces.emplace_back(id(i, j), id(i + 1, j), id(i + 1, j + 1));
      faces.emplace_back(id(i, j), id(i + 1, j + 1), id(i, j + 1));
    }
  }
  return { ToPoints(positions), ToTriangles(faces) };
}

/// The grid of a Klein bottle immersed in space (the figure-8 immersion): v comes
/// back reversed after u went around.
inline Shape KleinBottle(int around, int tube)
{
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3i> faces;
  const auto id = [&](int i, int j)
  {
    const int k = i < around ? j : tube - j;
    return (i % around) * tube + (k % tube + tube) % tube;
  };
  for (int i = 0; i < around; ++i)
  {
    const double u = 2 * Pi * i / around;
    for (int j = 0; j < tube; ++j)
    {
      const double v = 2 * Pi * j / tube;
      const double r = 3.0 + std::cos(u / 2) * std::sin(v) - std::sin(u / 2) * std::sin(2 * v);
      positions.emplace_back(r * std::cos(u), r * std::sin(u),
        std::sin(u / 2) * std::sin(v) + std::cos(u / 2) * std::sin(2 * v));
      faces.emplace_back(id(i, j), id(i + 1, j), id(i + 1, j + 1));
      faces.emplace_back(id(i, j), id(i + 1, j + 1), id(i, j + 1));
    }
  }
  return { ToPoints(positions), ToTriangles(faces) };
}

/// `pages` unit squares of n x n quads that share one side along z.
inline Shape Book(int pages, int n)
{
  Shape book;
  for (int page = 0; page < pages; ++page)
  {
    const double angle = 2 * Pi * page / pages;
    PatchOptions options;
    options.CountU = options.CountV = n;
    const Shape sheet = Patch(options,
      [angle](double u, double v)
      { return Eigen::Vector3d(u * std::cos(angle), u * std::sin(angle), v); });
    book = page == 0 ? sheet : Union(book, sheet);
  }
  return book;
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
