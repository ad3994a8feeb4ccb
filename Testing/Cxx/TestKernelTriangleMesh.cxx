// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Mesh/TriangleMesh.h"

#include "RealMeshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <set>

using cartan::ErrorCode;
using cartan::IdSample;
using cartan::MeshReport;
using cartan::Points;
using cartan::TriangleMesh;
using cartan::Triangles;
using shapes::MakeMesh;
using shapes::Shape;

namespace
{
using Ids = std::vector<long long>;

Triangles MakeTriangles(const std::vector<Eigen::Vector3i>& faces)
{
  return shapes::ToTriangles(faces);
}

/// Points in general position: no triangle of them is degenerate.
Points SomePoints(int count)
{
  Points points(count, 3);
  for (int i = 0; i < count; ++i)
  {
    points.row(i) << i, i * i, i * i * i + 1.0;
  }
  return points;
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

MeshReport Check(const std::vector<Eigen::Vector3i>& faces, int numberOfPoints)
{
  return TriangleMesh::Check(SomePoints(numberOfPoints), MakeTriangles(faces));
}

void ExpectSample(const IdSample& sample, const Ids& ids)
{
  EXPECT_EQ(sample.GetCount(), ids.size());
  EXPECT_EQ(sample.GetFirst(),
    Ids(ids.begin(), ids.begin() + static_cast<long>(std::min(ids.size(), IdSample::Kept))));
}

/// The constructor must refuse with a sentence that contains all `parts`.
void ExpectRefused(const std::vector<Eigen::Vector3i>& faces, int numberOfPoints,
  const std::vector<std::string>& parts)
{
  try
  {
    TriangleMesh(numberOfPoints, MakeTriangles(faces));
    FAIL() << "accepted";
  }
  catch (const cartan::Error& error)
  {
    EXPECT_EQ(error.GetCode(), ErrorCode::BadInput);
    for (const std::string& part : parts)
    {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
        << "expected: " << part << "\nfound: " << error.what();
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
    EXPECT_TRUE(TriangleMesh::Check(fan.Positions, fan.Faces).IsUsable());
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

//------------------------------------------------------------------------------
TEST(MeshReport, FindsNothingOnGoodSurfaces)
{
  for (const Shape& shape : { shapes::Icosphere(2), shapes::Plane(4), shapes::Torus(7, 5) })
  {
    const MeshReport report = TriangleMesh::Check(shape.Positions, shape.Faces);
    EXPECT_TRUE(report.IsUsable());
    EXPECT_EQ(report.DescribeErrors(), "");
    EXPECT_TRUE(report.ZeroArea.IsEmpty());
    EXPECT_TRUE(report.Unused.IsEmpty());
  }
}

TEST(MeshReport, CountsTrianglesOutOfRange)
{
  const MeshReport report = Check({ { 0, 1, 2 }, { 0, 2, 9 }, { -1, 1, 2 } }, 4);
  ExpectSample(report.OutOfRange, { 1, 2 });
  EXPECT_FALSE(report.IsUsable());
  ExpectRefused({ { 0, 1, 2 }, { 0, 2, 9 }, { -1, 1, 2 } }, 4,
    { "2 triangles (ids 1, 2)", "does not exist", "repair" });
}

TEST(MeshReport, CountsRepeatedVertices)
{
  const std::vector<Eigen::Vector3i> faces = { { 0, 1, 2 }, { 3, 3, 1 }, { 1, 2, 1 }, { 2, 0, 0 } };
  ExpectSample(Check(faces, 4).RepeatedVertex, { 1, 2, 3 });
  ExpectRefused(faces, 4, { "3 triangles (ids 1, 2, 3)", "twice", "remove" });
}

TEST(MeshReport, CountsEdgesOfMoreThanTwoTriangles)
{
  const std::vector<Eigen::Vector3i> faces = { { 2, 5, 0 }, { 5, 2, 1 }, { 2, 5, 3 } };
  const MeshReport report = Check(faces, 6);
  ExpectSample(report.NonManifoldEdges, { 2 });
  EXPECT_TRUE(report.InconsistentEdges.IsEmpty());
  EXPECT_TRUE(report.NonManifoldVertices.IsEmpty());
  ExpectRefused(faces, 6, { "1 edge (id 2)", "more than two triangles", "split" });
}

TEST(MeshReport, CountsInconsistentOrientation)
{
  const std::vector<Eigen::Vector3i> faces = { { 0, 1, 2 }, { 0, 1, 3 } };
  const MeshReport report = Check(faces, 4);
  ExpectSample(report.InconsistentEdges, { 0 });
  EXPECT_TRUE(report.NonManifoldEdges.IsEmpty());
  ExpectRefused(faces, 4, { "1 edge (id 0)", "opposite orientation", "orient" });

  // No orientation of a Moebius strip is consistent.
  std::vector<Eigen::Vector3i> strip;
  constexpr int Count = 7;
  for (int i = 0; i < Count; ++i)
  {
    const int a = 2 * i;
    const int b = 2 * i + 1;
    const int c = i + 1 < Count ? a + 2 : 1;
    const int d = i + 1 < Count ? b + 2 : 0;
    strip.emplace_back(a, c, b);
    strip.emplace_back(b, c, d);
  }
  EXPECT_EQ(Check(strip, 2 * Count).InconsistentEdges.GetCount(), 1u);
}

TEST(MeshReport, CountsBowTies)
{
  const std::vector<Eigen::Vector3i> open = { { 0, 1, 2 }, { 2, 3, 4 } };
  ExpectSample(Check(open, 5).NonManifoldVertices, { 2 });
  ExpectRefused(open, 5, { "1 point (id 2)", "several fans", "duplicate" });

  // Two tetrahedra that touch in a point: every edge is fine.
  Shape two = shapes::Union(shapes::Icosphere(1), shapes::Icosphere(1));
  const int offset = two.NumberOfVertices() / 2;
  for (Eigen::Index i = 0; i < two.Faces.size(); ++i)
  {
    int& id = two.Faces.data()[i];
    id = id == offset + 3 ? 7 : id;
  }
  const MeshReport report = TriangleMesh::Check(two.Positions, two.Faces);
  ExpectSample(report.NonManifoldVertices, { 7 });
  ExpectSample(report.Unused, { offset + 3 });
}

TEST(MeshReport, CountsPointsThatAreNotFinite)
{
  Shape shape = shapes::Plane(3);
  shape.Positions(4, 1) = std::numeric_limits<double>::quiet_NaN();
  shape.Positions(11, 2) = -std::numeric_limits<double>::infinity();
  const MeshReport report = TriangleMesh::Check(shape.Positions, shape.Faces);
  ExpectSample(report.NonFinite, { 4, 11 });
  EXPECT_FALSE(report.IsUsable());
  EXPECT_NE(
    report.DescribeErrors().find("2 points (ids 4, 11) with a NaN or infinite"), std::string::npos);
}

TEST(MeshReport, DegenerateTrianglesAndUnusedPointsAreNoObstacle)
{
  Points points = SomePoints(6);
  points.row(2) = 0.25 * points.row(0) + 0.75 * points.row(1);
  points.row(4) = points.row(3);
  const Triangles faces = MakeTriangles({ { 0, 1, 2 }, { 0, 3, 1 }, { 3, 4, 1 } });
  const MeshReport report = TriangleMesh::Check(points, faces);
  ExpectSample(report.ZeroArea, { 0, 2 });
  ExpectSample(report.Unused, { 5 });
  EXPECT_TRUE(report.IsUsable());
  EXPECT_EQ(report.DescribeErrors(), "");
  EXPECT_NO_THROW(TriangleMesh(6, faces));
}

TEST(MeshReport, WhetherATriangleHasAreaDoesNotDependOnTheUnit)
{
  for (const double unit : { 1e-9, 1.0, 1e6 })
  {
    for (const auto& [height, isDegenerate] :
      std::vector<std::pair<double, bool>>{ { 1e-11, false }, { 1e-13, true }, { 0.0, true } })
    {
      Points points(3, 3);
      points << 0, 0, 0, 1, 0, 0, 0.3, height, 0;
      const MeshReport report = TriangleMesh::Check(unit * points, MakeTriangles({ { 0, 1, 2 } }));
      EXPECT_EQ(report.ZeroArea.GetCount(), isDegenerate ? 1u : 0u) << unit << " " << height;
    }
  }
}

TEST(MeshReport, NamesCellsByTheIdsThatTheUserKnows)
{
  const MeshReport report = Check({ { 0, 1, 2 }, { 1, 1, 2 } }, 3);
  EXPECT_NE(report.DescribeErrors({ 70, 80 }).find("1 triangle (id 80)"), std::string::npos);
}

TEST(MeshReport, KeepsTheFirstFiveIdsAndCountsAll)
{
  IdSample sample;
  EXPECT_TRUE(sample.IsEmpty());
  for (int i = 0; i < 7; ++i)
  {
    sample.Add(10 + i);
  }
  EXPECT_EQ(sample.Describe("point", "points"), "7 points (ids 10, 11, 12, 13, 14, ...)");
}

TEST(MeshReport, AgreesWithCountingByHandOnRandomTriangles)
{
  // Few points and many triangles: every kind of defect at once.
  std::mt19937 engine(4);
  for (int round = 0; round < 300; ++round)
  {
    const int numberOfPoints = 4 + static_cast<int>(engine() % 12);
    std::vector<Eigen::Vector3i> faces;
    while (faces.size() < static_cast<std::size_t>(2 + round % 14))
    {
      const Eigen::Vector3i face(static_cast<int>(engine() % numberOfPoints),
        static_cast<int>(engine() % numberOfPoints), static_cast<int>(engine() % numberOfPoints));
      if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0])
      {
        faces.push_back(face);
      }
    }

    std::map<std::pair<int, int>, std::vector<int>> edges; // directions, by end points
    for (const Eigen::Vector3i& face : faces)
    {
      for (int c = 0; c < 3; ++c)
      {
        const int a = face[c];
        const int b = face[(c + 1) % 3];
        edges[std::minmax(a, b)].push_back(a < b);
      }
    }
    std::size_t nonManifold = 0;
    std::size_t inconsistent = 0;
    std::set<int> touched;
    for (const auto& [ends, directions] : edges)
    {
      const bool tooMany = directions.size() > 2;
      const bool same = directions.size() == 2 && directions[0] == directions[1];
      nonManifold += tooMany;
      inconsistent += same;
      if (tooMany || same)
      {
        touched.insert({ ends.first, ends.second });
      }
    }
    // Fans of a vertex without bad edges: its triangles, joined by shared edges.
    std::size_t bowTies = 0;
    std::size_t unused = 0;
    for (int v = 0; v < numberOfPoints; ++v)
    {
      std::vector<std::set<int>> fans;
      for (const Eigen::Vector3i& face : faces)
      {
        if ((face.array() == v).any())
        {
          std::set<int> fan(face.begin(), face.end());
          fan.erase(v);
          for (auto other = fans.begin(); other != fans.end();)
          {
            const bool meets =
              std::any_of(fan.begin(), fan.end(), [&](int w) { return other->count(w) > 0; });
            if (meets)
            {
              fan.insert(other->begin(), other->end());
            }
            other = meets ? fans.erase(other) : std::next(other);
          }
          fans.push_back(fan);
        }
      }
      unused += fans.empty();
      bowTies += fans.size() > 1 && !touched.count(v);
    }

    const MeshReport report = Check(faces, numberOfPoints);
    ASSERT_EQ(report.NonManifoldEdges.GetCount(), nonManifold) << round;
    ASSERT_EQ(report.InconsistentEdges.GetCount(), inconsistent) << round;
    ASSERT_EQ(report.NonManifoldVertices.GetCount(), bowTies) << round;
    ASSERT_EQ(report.Unused.GetCount(), unused) << round;
    if (report.IsUsable())
    {
      ExpectConsistent(TriangleMesh(numberOfPoints, MakeTriangles(faces)));
    }
    else
    {
      EXPECT_THROW(TriangleMesh(numberOfPoints, MakeTriangles(faces)), cartan::Error);
    }
  }
}
