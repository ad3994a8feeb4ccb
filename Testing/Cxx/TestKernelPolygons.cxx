// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Mesh/Polygons.h"

#include "Kernel/Mesh/DoubledTriangles.h"
#include "Kernel/Mesh/Geometry.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace cartan;
using shapes::ToPoints;
using shapes::ToTriangles;

namespace
{
constexpr double Tolerance = 1e-14;

/// A hexagon that is not flat, and its triangles by three ways to split it.
const Points Hexagon = ToPoints(
  { { 2, 0, 0.3 }, { 1, 1.5, -0.2 }, { -1, 2, 0.1 }, { -2, 0, 0 }, { -1, -1, 0.4 }, { 1, -2, 0 } });
const Triangles Splits[] = { ToTriangles({ { 0, 1, 2 }, { 0, 2, 3 }, { 0, 3, 4 }, { 0, 4, 5 } }),
  ToTriangles({ { 1, 2, 3 }, { 3, 4, 5 }, { 5, 0, 1 }, { 1, 3, 5 } }),
  ToTriangles({ { 2, 3, 4 }, { 2, 4, 5 }, { 2, 5, 0 }, { 2, 0, 1 } }) };

Triangles Stack(const Triangles& first, const Triangles& second)
{
  Triangles both(first.rows() + second.rows(), 3);
  both << first, second;
  return both;
}
}

TEST(PolygonNormals, DependOnTheBorderOnly)
{
  // Newell's formula: the sum of p_i x p_(i+1) around the border.
  Eigen::RowVector3d newell = Eigen::RowVector3d::Zero();
  for (int i = 0; i < 6; ++i)
  {
    newell += Hexagon.row(i).cross(Hexagon.row((i + 1) % 6));
  }
  for (const Triangles& split : Splits)
  {
    const Points normals = PolygonNormals(Hexagon, split, { 0, 0, 0, 0 }, 1);
    EXPECT_LT((normals.row(0) - newell.normalized()).norm(), Tolerance);
  }
}

TEST(PolygonNormals, AreThoseOfTrianglesAndZeroWhereThereIsNone)
{
  // Polygon 1 has no triangles, polygon 2 no area.
  const Points points = ToPoints({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 2, 2 }, { 2, 0, 0 } });
  const Triangles triangles = ToTriangles({ { 0, 1, 2 }, { 0, 1, 3 }, { 0, 2, 1 } });
  const Points normals = PolygonNormals(points, triangles, { 0, 2, 3 }, 4);
  const Eigen::RowVector3d expected = Eigen::RowVector3d(0, -1, 1).normalized();
  EXPECT_LT((normals.row(0) - expected).norm(), Tolerance);
  EXPECT_EQ(normals.row(1).norm(), 0.0);
  EXPECT_EQ(normals.row(2).norm(), 0.0);
  EXPECT_LT((normals.row(3) + expected).norm(), Tolerance);
}

TEST(SplitDoubledPolygonsAlike, MakesDoubledPolygonsDoubledTriangles)
{
  // Front and back of the hexagon, split in different ways.
  for (const Triangles& split : Splits)
  {
    Triangles back = split;
    back.col(1).swap(back.col(2));
    Triangles both = Stack(Splits[0], back);
    SplitDoubledPolygonsAlike(both, { 0, 0, 0, 0, 1, 1, 1, 1 });
    EXPECT_EQ(both.topRows(4), Splits[0]);
    const std::vector<char> drop = FindDoubledTriangles(6, both);
    EXPECT_EQ(std::count(drop.begin(), drop.end(), 1), 4);
  }
}

TEST(SplitDoubledPolygonsAlike, LeavesOthersAlone)
{
  // Single triangles, polygons that share some points, and a strip that comes back
  // to its first points.
  const Triangles apart = Stack(ToTriangles({ { 0, 1, 2 }, { 2, 1, 0 } }),
    ToTriangles({ { 0, 1, 2 }, { 0, 2, 3 }, { 0, 1, 3 }, { 1, 4, 3 } }));
  Triangles result = apart;
  SplitDoubledPolygonsAlike(result, { 0, 1, 2, 2, 3, 3 });
  EXPECT_EQ(result, apart);

  const Triangles strips = Stack(ToTriangles({ { 0, 1, 2 }, { 1, 3, 2 }, { 2, 3, 0 } }),
    ToTriangles({ { 3, 0, 1 }, { 0, 2, 1 }, { 1, 2, 3 } }));
  result = strips;
  SplitDoubledPolygonsAlike(result, { 0, 0, 0, 1, 1, 1 });
  EXPECT_EQ(result, strips);
}
