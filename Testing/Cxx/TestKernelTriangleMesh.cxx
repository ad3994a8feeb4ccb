// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Mesh/TriangleMesh.h"

#include "Kernel/Base/DisjointSets.h"
#include "Kernel/Mesh/GrowByRings.h"
#include "RealMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

using cartan::MeshReport;
using cartan::Points;
using cartan::TriangleMesh;
using cartan::Triangles;
using shapes::MakeMesh;
using shapes::Shape;

namespace
{
Triangles MakeTriangles(const std::vector<Eigen::Vector3i>& faces)
{
  return shapes::ToTriangles(faces);
}

/// All that the class promises of its directed edges.
void ExpectConsistent(const TriangleMesh& mesh)
{
  std::vector<int> uses(mesh.NumberOfTriangles(), 0);
  int directedEdges = 0;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    ASSERT_EQ(mesh.RingBegin(v), directedEdges);
    ASSERT_EQ(mesh.Valence(v), mesh.RingEnd(v) - mesh.RingBegin(v));
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      const int twin = mesh.Twin(d);
      ASSERT_EQ(mesh.Origin(d), v);
      ASSERT_EQ(mesh.Twin(twin), d);
      ASSERT_EQ(mesh.Origin(twin), mesh.Neighbor(d));
      ASSERT_EQ(mesh.Neighbor(twin), v);
      ASSERT_EQ(mesh.Component(mesh.Neighbor(d)), mesh.Component(v));
      ASSERT_EQ(mesh.Next(d), mesh.NextAround(v, d));
      const int triangle = mesh.LeftTriangle(d);
      // A boundary ring starts at the boundary edge with a triangle on its left
      // and ends at the one without.
      ASSERT_EQ(triangle < 0, mesh.IsBoundary(v) && d == mesh.RingEnd(v) - 1);
      ASSERT_EQ(mesh.LeftTriangle(twin) < 0, mesh.IsBoundary(v) && d == mesh.RingBegin(v));
      if (triangle < 0)
      {
        ASSERT_EQ(mesh.Next(d), -1);
        ASSERT_EQ(mesh.Opposite(d), -1);
        continue;
      }
      ASSERT_EQ(mesh.Next(d), d + 1 < mesh.RingEnd(v) ? d + 1 : mesh.RingBegin(v));
      ASSERT_EQ(mesh.Opposite(d), mesh.Neighbor(mesh.Next(d)));
      const Eigen::Vector3i corners = mesh.GetTriangles().row(triangle);
      const int corner =
        static_cast<int>(std::find(corners.begin(), corners.end(), v) - corners.begin());
      ASSERT_LT(corner, 3);
      ASSERT_EQ(corners[(corner + 1) % 3], mesh.Neighbor(d));
      ASSERT_EQ(corners[(corner + 2) % 3], mesh.Opposite(d));
      ++uses[triangle];
    }
    directedEdges += mesh.Valence(v);
    ASSERT_EQ(mesh.IsUsed(v), mesh.Valence(v) > 0);
    ASSERT_EQ(mesh.Component(v) >= 0, mesh.IsUsed(v));
  }
  ASSERT_EQ(mesh.NumberOfDirectedEdges(), directedEdges);
  ASSERT_EQ(mesh.NumberOfDirectedEdges(), 2 * mesh.NumberOfEdges());
  ASSERT_EQ(std::count(uses.begin(), uses.end(), 3), mesh.NumberOfTriangles());
}

int CountBoundary(const TriangleMesh& mesh)
{
  int count = 0;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    count += mesh.IsBoundary(v);
  }
  return count;
}

int EulerCharacteristic(const TriangleMesh& mesh)
{
  int used = 0;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    used += mesh.IsUsed(v);
  }
  return used - mesh.NumberOfEdges() + mesh.NumberOfTriangles();
}

/// A hub (vertex 0) and `count` rim vertices, its triangles in random order.
Shape Fan(int count, bool isClosed)
{
  Shape shape;
  shape.Positions = Points::Zero(count + 1, 3);
  std::vector<Eigen::Vector3i> faces;
  for (int i = 0; i < count; ++i)
  {
    const double angle = shapes::Pi * 2.0 * i / count;
    shape.Positions.row(i + 1) << std::cos(angle), std::sin(angle), 0.0;
    if (isClosed || i + 1 < count)
    {
      faces.emplace_back(0, 1 + i, 1 + (i + 1) % count);
    }
  }
  std::shuffle(faces.begin(), faces.end(), std::mt19937(3));
  shape.Faces = MakeTriangles(faces);
  return shape;
}

/// What an edge from one vertex to another has on its left, by its ends.
using LeftTriangles = std::map<std::pair<int, int>, int>;

LeftTriangles FindLeftTriangles(const Triangles& triangles)
{
  LeftTriangles left;
  for (int t = 0; t < triangles.rows(); ++t)
  {
    for (int c = 0; c < 3; ++c)
    {
      left[{ triangles(t, c), triangles(t, (c + 1) % 3) }] = t;
    }
  }
  return left;
}

/// Numbers the components as the class does, by joining the triangles' corners.
std::vector<int> FindComponents(int numberOfVertices, const Triangles& triangles)
{
  cartan::DisjointSets sets(numberOfVertices);
  std::vector<char> isUsed(numberOfVertices, 0);
  for (int t = 0; t < triangles.rows(); ++t)
  {
    for (int c = 0; c < 3; ++c)
    {
      sets.Join(triangles(t, c), triangles(t, 0));
      isUsed[triangles(t, c)] = 1;
    }
  }
  std::map<int, int> numbers;
  std::vector<int> components(numberOfVertices, -1);
  for (int v = 0; v < numberOfVertices; ++v)
  {
    if (isUsed[v])
    {
      components[v] = numbers.emplace(sets.Find(v), static_cast<int>(numbers.size())).first->second;
    }
  }
  return components;
}

/// Everything against a map of the edges.
void ExpectEqualToNaive(const Shape& shape)
{
  const TriangleMesh mesh = MakeMesh(shape);
  const LeftTriangles left = FindLeftTriangles(shape.Faces);
  std::vector<std::set<int>> neighbors(shape.NumberOfVertices());
  for (const auto& [ends, triangle] : left)
  {
    neighbors[ends.first].insert(ends.second);
    neighbors[ends.second].insert(ends.first);
  }
  const std::vector<int> components = FindComponents(shape.NumberOfVertices(), shape.Faces);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    ASSERT_EQ(mesh.Component(v), components[v]);
    ASSERT_EQ(mesh.Valence(v), static_cast<int>(neighbors[v].size()));
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      const int w = mesh.Neighbor(d);
      ASSERT_EQ(neighbors[v].count(w), 1u);
      ASSERT_EQ(mesh.Origin(d), v);
      ASSERT_EQ(mesh.Neighbor(mesh.Twin(d)), v);
      ASSERT_EQ(mesh.Origin(mesh.Twin(d)), w);
      const auto found = left.find({ v, w });
      ASSERT_EQ(mesh.LeftTriangle(d), found == left.end() ? -1 : found->second);
    }
  }
}
}

TEST(TriangleMesh, DirectedEdgesAreConsistentOnClosedAndOpenSurfaces)
{
  shapes::Shape unused = shapes::Plane(3);
  unused.Positions.conservativeResize(unused.Positions.rows() + 4, 3);
  const std::vector<Shape> surfaces = { shapes::Icosphere(2), shapes::Torus(9, 7),
    shapes::UvSphere(8, 5), shapes::Plane(6, 1.0, 0.3, 5), shapes::OpenCylinder(7, 3),
    shapes::Bar(2, 3, 4, { 1, 1, 1 }), Fan(1, false), Fan(3, true), unused,
    shapes::Union(shapes::Torus(5, 4), shapes::OpenCylinder(5, 2)) };
  for (const Shape& surface : surfaces)
  {
    ExpectConsistent(MakeMesh(surface));
  }
}

TEST(TriangleMesh, DirectedEdgesAreConsistentOnRealMeshes)
{
  for (const char* name : { "camel", "elephant", "lion-head" })
  {
    ExpectConsistent(MakeMesh(shapes::RealMesh(name)));
  }
}

TEST(TriangleMesh, VerticesMinusEdgesPlusTrianglesIsTheEulerCharacteristic)
{
  EXPECT_EQ(EulerCharacteristic(MakeMesh(shapes::Icosphere(3))), 2);
  EXPECT_EQ(EulerCharacteristic(MakeMesh(shapes::Bar(3, 2, 4, { 1, 2, 3 }))), 2);
  EXPECT_EQ(EulerCharacteristic(MakeMesh(shapes::Torus(12, 8))), 0);
  EXPECT_EQ(EulerCharacteristic(MakeMesh(shapes::Plane(5))), 1);
  EXPECT_EQ(EulerCharacteristic(MakeMesh(shapes::OpenCylinder(8, 3))), 0);
  EXPECT_EQ(
    EulerCharacteristic(MakeMesh(shapes::Union(shapes::Torus(6, 5), shapes::Icosphere(1)))), 2);
}

TEST(TriangleMesh, RingsRunCounterClockwiseSeenFromOutside)
{
  const Shape plane = shapes::Plane(8, 1.0, 0.3, 2); // normals to +z
  const TriangleMesh mesh = MakeMesh(plane);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    double total = 0.0;
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      const int next = mesh.Next(d);
      if (next >= 0)
      {
        const Eigen::RowVector3d a = plane.Positions.row(mesh.Neighbor(d)) - plane.Positions.row(v);
        const Eigen::RowVector3d b =
          plane.Positions.row(mesh.Neighbor(next)) - plane.Positions.row(v);
        const double turn = std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
        EXPECT_GT(turn, 0.0);
        total += turn;
      }
    }
    if (!mesh.IsBoundary(v))
    {
      EXPECT_NEAR(total, 2.0 * shapes::Pi, 1e-12);
    }
  }
}

TEST(TriangleMesh, BoundaryIsWhereAnEdgeHasOneTriangle)
{
  EXPECT_EQ(CountBoundary(MakeMesh(shapes::Icosphere(2))), 0);
  EXPECT_EQ(CountBoundary(MakeMesh(shapes::Plane(6))), 24);
  EXPECT_EQ(CountBoundary(MakeMesh(shapes::OpenCylinder(9, 4))), 18);
  const TriangleMesh triangle(5, MakeTriangles({ { 1, 3, 2 } }));
  EXPECT_EQ(CountBoundary(triangle), 3);
  EXPECT_FALSE(triangle.IsBoundary(0)); // unused
  EXPECT_FALSE(triangle.IsUsed(0));
  EXPECT_EQ(triangle.Valence(1), 2);
  EXPECT_EQ(triangle.Neighbor(triangle.RingBegin(1)), 3);
  EXPECT_EQ(triangle.Opposite(triangle.RingBegin(1)), 2);
}

TEST(TriangleMesh, ComponentsAreNumberedByTheirFirstVertices)
{
  // 0-3-4, 1-2-6, 5 unused.
  const TriangleMesh mesh(7, MakeTriangles({ { 6, 2, 1 }, { 4, 3, 0 } }));
  EXPECT_EQ(mesh.NumberOfComponents(), 2);
  const std::vector<int> expected = { 0, 1, 1, 0, 0, -1, 1 };
  for (int v = 0; v < 7; ++v)
  {
    EXPECT_EQ(mesh.Component(v), expected[v]) << v;
  }
}

TEST(TriangleMesh, AHubOfManyTrianglesHasItsRingInOrder)
{
  // Quadratic work per vertex would not come back from this one.
  constexpr int Count = 100000;
  for (const bool isClosed : { true, false })
  {
    const Shape fan = Fan(Count, isClosed);
    const TriangleMesh mesh = MakeMesh(fan);
    ASSERT_EQ(mesh.Valence(0), Count);
    ASSERT_EQ(mesh.IsBoundary(0), !isClosed);
    const int first = mesh.Neighbor(mesh.RingBegin(0));
    ASSERT_TRUE(isClosed || first == 1);
    for (int k = 0; k < Count; ++k)
    {
      ASSERT_EQ(mesh.Neighbor(mesh.RingBegin(0) + k), 1 + (first - 1 + k) % Count);
    }
    ExpectConsistent(mesh);
  }
}

TEST(TriangleMesh, TheOrderOfTrianglesAndTheirCornersChangesNoNeighborhood)
{
  const Shape torus = shapes::Torus(8, 6);
  Shape shuffled = torus;
  std::vector<int> order(torus.Faces.rows());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  for (std::size_t t = 0; t < order.size(); ++t)
  {
    for (int c = 0; c < 3; ++c)
    {
      shuffled.Faces(static_cast<int>(t), c) = torus.Faces(order[t], (c + order[t]) % 3);
    }
  }
  const TriangleMesh a = MakeMesh(torus);
  const TriangleMesh b = MakeMesh(shuffled);
  ExpectConsistent(b);
  for (int v = 0; v < a.NumberOfVertices(); ++v)
  {
    std::map<int, int> nextOf;
    for (int d = a.RingBegin(v); d < a.RingEnd(v); ++d)
    {
      nextOf[a.Neighbor(d)] = a.Opposite(d);
    }
    ASSERT_EQ(a.Valence(v), b.Valence(v));
    for (int d = b.RingBegin(v); d < b.RingEnd(v); ++d)
    {
      EXPECT_EQ(nextOf.at(b.Neighbor(d)), b.Opposite(d));
    }
  }
}

TEST(TriangleMesh, NoTrianglesAreAMeshOfUnusedVertices)
{
  for (const int count : { 0, 4 })
  {
    const TriangleMesh mesh(count, Triangles(0, 3));
    EXPECT_EQ(mesh.NumberOfVertices(), count);
    EXPECT_EQ(mesh.NumberOfDirectedEdges(), 0);
    EXPECT_EQ(mesh.NumberOfComponents(), 0);
  }
  EXPECT_EQ(TriangleMesh().NumberOfVertices(), 0);
}

TEST(TriangleMesh, TwoTrianglesBackToBackAreClosed)
{
  const TriangleMesh mesh(3, MakeTriangles({ { 0, 1, 2 }, { 0, 2, 1 } }));
  ExpectConsistent(mesh);
  EXPECT_EQ(CountBoundary(mesh), 0);
  EXPECT_EQ(EulerCharacteristic(mesh), 2);
}

TEST(TriangleMesh, EqualsAConstructionByAMapOfEdges)
{
  for (const char* name : { "camel", "elephant", "lion-head", "triceratops", "man" })
  {
    SCOPED_TRACE(name);
    ExpectEqualToNaive(shapes::RealMesh(name));
  }
  ExpectEqualToNaive(shapes::Plane(6, 1.0, 0.3, 5));
  ExpectEqualToNaive(shapes::Union(shapes::OpenCylinder(7, 3), shapes::Icosphere(2)));
}

TEST(TriangleMesh, BuildTakesGoodTrianglesAndLeavesBadOnes)
{
  Triangles good = MakeTriangles({ { 0, 1, 2 }, { 0, 2, 3 } });
  MeshReport report;
  const TriangleMesh mesh = TriangleMesh::Build(5, std::move(good), report);
  EXPECT_TRUE(report.IsManifold());
  EXPECT_EQ(report.Unused.GetFirst(), std::vector<long long>({ 4 }));
  EXPECT_EQ(mesh.NumberOfTriangles(), 2);

  const Triangles bad = MakeTriangles({ { 0, 1, 2 }, { 0, 1, 3 } });
  Triangles given = bad;
  EXPECT_EQ(TriangleMesh::Build(5, std::move(given), report).NumberOfVertices(), 0);
  EXPECT_FALSE(report.IsManifold());
  EXPECT_EQ(given, bad);
}

TEST(TriangleMesh, GrowByRingsFindsTheVerticesByTheirDistanceInEdges)
{
  const Shape shape = shapes::Union(shapes::Torus(12, 9), shapes::Icosphere(1));
  const TriangleMesh mesh = MakeMesh(shape);
  const std::vector<int> seeds = { 5, 40 };
  // Distances by Bellman and Ford's rounds over all edges.
  std::vector<int> distance(mesh.NumberOfVertices(), mesh.NumberOfVertices());
  distance[5] = distance[40] = 0;
  for (int round = 0; round < mesh.NumberOfVertices(); ++round)
  {
    for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
    {
      distance[mesh.Neighbor(d)] =
        std::min(distance[mesh.Neighbor(d)], distance[mesh.Origin(d)] + 1);
    }
  }
  for (const int rings : { 0, 1, 3, 100 })
  {
    const std::vector<int> reached = cartan::GrowByRings(mesh, seeds, rings);
    EXPECT_TRUE(std::is_sorted(
      reached.begin(), reached.end(), [&](int a, int b) { return distance[a] < distance[b]; }));
    const std::set<int> found(reached.begin(), reached.end());
    EXPECT_EQ(found.size(), reached.size());
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      EXPECT_EQ(found.count(v), distance[v] <= rings ? 1u : 0u) << v;
    }
  }
  EXPECT_TRUE(cartan::GrowByRings(mesh, {}, 3).empty());
  EXPECT_EQ(cartan::GrowByRings(mesh, { 7, 7 }, 0), std::vector<int>({ 7 }));
}
