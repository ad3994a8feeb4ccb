// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Mesh/Geometry.h"

#include "RealMeshes.h"

#include <gtest/gtest.h>

using cartan::Points;
using cartan::TriangleMesh;
using shapes::MakeMesh;
using shapes::Shape;

namespace
{
double Area(const Shape& shape)
{
  return 0.5 * cartan::TriangleAreaVectors(shape.Positions, shape.Faces).rowwise().norm().sum();
}

Eigen::VectorXd MixedAreas(const Shape& shape)
{
  return cartan::MixedVoronoiAreas(MakeMesh(shape), shape.Positions);
}

Shape Triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
{
  return { shapes::ToPoints({ a, b, c }), shapes::ToTriangles({ { 0, 1, 2 } }) };
}

/// The area of the part of a convex polygon in the plane z = 0 that is nearer
/// to p than to q (Sutherland-Hodgman clipping).
std::vector<Eigen::Vector3d> ClipNearer(
  const std::vector<Eigen::Vector3d>& polygon, const Eigen::Vector3d& p, const Eigen::Vector3d& q)
{
  const auto side = [&](const Eigen::Vector3d& x)
  { return (x - q).squaredNorm() - (x - p).squaredNorm(); };
  std::vector<Eigen::Vector3d> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const Eigen::Vector3d& a = polygon[i];
    const Eigen::Vector3d& b = polygon[(i + 1) % polygon.size()];
    if (side(a) >= 0.0)
    {
      kept.push_back(a);
    }
    if ((side(a) > 0.0 && side(b) < 0.0) || (side(a) < 0.0 && side(b) > 0.0))
    {
      kept.push_back(a + side(a) / (side(a) - side(b)) * (b - a));
    }
  }
  return kept;
}

double PolygonArea(const std::vector<Eigen::Vector3d>& polygon)
{
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const Eigen::Vector3d& a = polygon[i];
    const Eigen::Vector3d& b = polygon[(i + 1) % polygon.size()];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return 0.5 * std::abs(twice);
}
}

TEST(AreaVectors, FollowTheRightHandRule)
{
  const Shape triangle = Triangle({ 1, 1, 5 }, { 4, 1, 5 }, { 1, 3, 5 });
  const Points vectors = cartan::TriangleAreaVectors(triangle.Positions, triangle.Faces);
  EXPECT_TRUE(vectors.row(0).isApprox(Eigen::RowVector3d(0, 0, 6)));
}

TEST(AreaVectors, CancelOnClosedSurfaces)
{
  for (const char* name : { "camel", "armadillo" })
  {
    const Shape shape = shapes::RealMesh(name);
    const Points vectors = cartan::TriangleAreaVectors(shape.Positions, shape.Faces);
    EXPECT_LT(vectors.colwise().sum().norm(), 1e-12 * vectors.rowwise().norm().sum());
  }
}

TEST(VertexNormals, AreTheAreaWeightedMeanOfTheTriangles)
{
  // Two triangles at the edge (0, 1), of areas 1 in z = 0 and 3 in y = 0.
  Shape shape;
  shape.Positions = shapes::ToPoints({ { 0, 0, 0 }, { 2, 0, 0 }, { 0, 1, 0 }, { 0, 0, 3 } });
  shape.Faces = shapes::ToTriangles({ { 0, 1, 2 }, { 1, 0, 3 } });
  const Points normals = cartan::VertexNormals(MakeMesh(shape), shape.Positions);
  const Eigen::RowVector3d expected = Eigen::RowVector3d(0, 3, 1).normalized();
  EXPECT_TRUE(normals.row(0).isApprox(expected, 1e-15));
  EXPECT_TRUE(normals.row(1).isApprox(expected, 1e-15));
  EXPECT_TRUE(normals.row(2).isApprox(Eigen::RowVector3d(0, 0, 1), 1e-15));
  EXPECT_TRUE(normals.row(3).isApprox(Eigen::RowVector3d(0, 1, 0), 1e-15));
}

TEST(VertexNormals, PointOutwardsOnASphereAndConvergeToTheRadius)
{
  double last = 1.0;
  for (const int level : { 2, 3, 4 })
  {
    const Shape sphere = shapes::Icosphere(level, 3.0);
    const Points normals = cartan::VertexNormals(MakeMesh(sphere), sphere.Positions);
    const double error = (normals - sphere.Positions / 3.0).rowwise().norm().maxCoeff();
    EXPECT_LT(error, 0.6 * last);
    last = error;
  }
  EXPECT_LT(last, 0.02);
}

TEST(VertexNormals, DoNotDependOnTheUnitAndTurnWithTheSurface)
{
  const Shape camel = shapes::RealMesh("camel");
  const TriangleMesh mesh = MakeMesh(camel);
  const Points normals = cartan::VertexNormals(mesh, camel.Positions);
  EXPECT_LT((normals.rowwise().norm().array() - 1.0).abs().maxCoeff(), 1e-14);
  const Points tiny = cartan::VertexNormals(mesh, 1e-9 * camel.Positions);
  EXPECT_LT((tiny - normals).cwiseAbs().maxCoeff(), 1e-12);
  const shapes::RigidMotion motion = shapes::RandomRigidMotion(2);
  const Points turned = cartan::VertexNormals(mesh, motion(camel.Positions));
  EXPECT_LT((turned - normals * motion.Rotation.transpose()).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(VertexNormals, AreZeroWhereThereIsNone)
{
  // A triangle with its back, and an unused point.
  Shape shape = Triangle({ 0, 0, 0 }, { 1, 0, 0 }, { 0.3, 0.7, 0.1 });
  shape.Faces = shapes::ToTriangles({ { 0, 1, 2 }, { 0, 2, 1 } });
  shape.Positions.conservativeResize(4, 3);
  shape.Positions.row(3) << 1, 2, 3;
  EXPECT_TRUE(cartan::VertexNormals(MakeMesh(shape), shape.Positions).isZero(0.0));
}

//------------------------------------------------------------------------------
TEST(MixedAreas, SumToTheSurfaceAndAreNotNegative)
{
  const std::vector<Shape> surfaces = { shapes::Icosphere(3), shapes::Torus(20, 11),
    shapes::UvSphere(30, 9), shapes::Plane(12, 2.0, 0.3, 7),
    shapes::Noisy(shapes::Icosphere(2), 0.1), shapes::RealMesh("camel"),
    shapes::RealMesh("elephant") };
  for (const Shape& surface : surfaces)
  {
    const Eigen::VectorXd areas = MixedAreas(surface);
    EXPECT_NEAR(areas.sum(), Area(surface), 1e-12 * Area(surface));
    EXPECT_GE(areas.minCoeff(), 0.0);
  }
}

TEST(MixedAreas, OfSpecialTriangles)
{
  const double h = std::sqrt(3.0) / 2.0;
  const Eigen::VectorXd equilateral = MixedAreas(Triangle({ 0, 0, 0 }, { 1, 0, 0 }, { 0.5, h, 0 }));
  for (int v = 0; v < 3; ++v)
  {
    EXPECT_NEAR(equilateral[v], h / 6.0, 1e-15);
  }
  // The circumcenter of a right triangle is the middle of its long side.
  const Eigen::VectorXd right = MixedAreas(Triangle({ 0, 0, 0 }, { 3, 0, 0 }, { 0, 4, 0 }));
  EXPECT_NEAR(right[0], 3.0, 1e-14);
  EXPECT_NEAR(right[1], 1.5, 1e-14);
  EXPECT_NEAR(right[2], 1.5, 1e-14);
  // Obtuse: half for the wide angle, a quarter for the others.
  const Eigen::VectorXd obtuse = MixedAreas(Triangle({ 0, 0, 0 }, { 4, 0, 0 }, { -1, 1, 0 }));
  EXPECT_NEAR(obtuse[0], 1.0, 1e-15);
  EXPECT_NEAR(obtuse[1], 0.5, 1e-15);
  EXPECT_NEAR(obtuse[2], 0.5, 1e-15);
  EXPECT_TRUE(MixedAreas(Triangle({ 0, 0, 0 }, { 1, 0, 0 }, { 3, 0, 0 })).isZero(0.0));
}

TEST(MixedAreas, OfAcuteTrianglesAreTheNearestPointsRegions)
{
  shapes::Random random(5);
  int tested = 0;
  while (tested < 50)
  {
    std::vector<Eigen::Vector3d> corners(3);
    for (Eigen::Vector3d& corner : corners)
    {
      corner = Eigen::Vector3d{ random(), random(), 0.0 };
    }
    bool isAcute = (corners[1] - corners[0]).cross(corners[2] - corners[0])[2] > 0.05;
    for (int c = 0; c < 3; ++c)
    {
      isAcute = isAcute &&
        (corners[(c + 1) % 3] - corners[c]).dot(corners[(c + 2) % 3] - corners[c]) > 0.01;
    }
    if (!isAcute)
    {
      continue;
    }
    ++tested;
    const Eigen::VectorXd areas = MixedAreas(Triangle(corners[0], corners[1], corners[2]));
    for (int c = 0; c < 3; ++c)
    {
      const auto region = ClipNearer(
        ClipNearer(corners, corners[c], corners[(c + 1) % 3]), corners[c], corners[(c + 2) % 3]);
      EXPECT_NEAR(areas[c], PolygonArea(region), 1e-13);
    }
  }
}

TEST(BoundingDiagonal, IsThatOfTheBox)
{
  EXPECT_EQ(cartan::BoundingDiagonal(Points(0, 3)), 0.0);
  EXPECT_DOUBLE_EQ(cartan::BoundingDiagonal(shapes::Bar(2, 2, 2, { 2, 3, 6 }).Positions), 7.0);
}
