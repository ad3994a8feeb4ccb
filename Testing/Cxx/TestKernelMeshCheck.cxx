// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Mesh/MeshCheck.h"

#include "Kernel/Mesh/TriangleMesh.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

using cartan::ErrorCode;
using cartan::IdSample;
using cartan::MeshReport;
using cartan::Points;
using cartan::TriangleMesh;
using cartan::Triangles;
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
  ExpectRefused(faces, 6, { "1 edge (id 2)", "more than two triangles", "Prepare Surface" });
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
  ExpectRefused(open, 5, { "1 point (id 2)", "several fans", "Prepare Surface" });

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

TEST(MeshReport, PositionsAreCheckedForEachSetOfPoints)
{
  const Triangles faces = MakeTriangles({ { 0, 1, 2 }, { 0, 2, 3 }, { 0, 3, 9 } });
  Points points = SomePoints(5);
  MeshReport report;
  cartan::CheckPositions(points, faces, report);
  EXPECT_TRUE(report.IsUsable());
  EXPECT_TRUE(report.ZeroArea.IsEmpty());
  points.row(3) = points.row(2);
  points(4, 0) = std::numeric_limits<double>::infinity();
  cartan::CheckPositions(points, faces, report);
  ExpectSample(report.ZeroArea, { 1 });
  ExpectSample(report.NonFinite, { 4 });
  EXPECT_TRUE(report.IsManifold());
  EXPECT_FALSE(report.IsUsable());
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
      EXPECT_EQ(TriangleMesh(numberOfPoints, MakeTriangles(faces)).NumberOfTriangles(),
        static_cast<int>(faces.size()));
    }
    else
    {
      EXPECT_THROW(TriangleMesh(numberOfPoints, MakeTriangles(faces)), cartan::Error);
    }
  }
}
