// SPDX-License-Identifier: BSD-3-Clause
#include "PrepareShapes.h"
#include "RealMeshes.h"

#include "Kernel/Mesh/EdgeFlips.h"
#include "Kernel/Mesh/HoleFilling.h"

#include <set>

using cartan::RepairedSurface;
using cartan::RepairOptions;
using shapes::Repaired;
using shapes::Shape;
using shapes::TopologyOf;

namespace
{
RepairOptions Filling(int edges)
{
  RepairOptions options;
  options.Holes.MaximumEdges = edges;
  return options;
}

RepairOptions Flipping()
{
  RepairOptions options;
  options.FlipsEdges = true;
  return options;
}

/// The shape without the triangles around some vertices.
Shape Pierced(const Shape& shape, const std::set<int>& vertices)
{
  std::vector<Eigen::Vector3i> faces;
  for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
  {
    const Eigen::Vector3i face = shape.Faces.row(t).transpose();
    if (vertices.count(face[0]) + vertices.count(face[1]) + vertices.count(face[2]) == 0)
    {
      faces.push_back(face);
    }
  }
  return { shape.Positions, shapes::ToTriangles(faces) };
}

double SmallestAngle(const cartan::Points& points, const cartan::Triangles& faces)
{
  double smallest = shapes::Pi;
  for (Eigen::Index t = 0; t < faces.rows(); ++t)
  {
    for (int corner = 0; corner < 3; ++corner)
    {
      const Eigen::Vector3d a = points.row(faces(t, corner));
      const Eigen::Vector3d u = points.row(faces(t, (corner + 1) % 3)).transpose() - a;
      const Eigen::Vector3d v = points.row(faces(t, (corner + 2) % 3)).transpose() - a;
      smallest = std::min(smallest, std::atan2(u.cross(v).norm(), u.dot(v)));
    }
  }
  return smallest;
}

/// Whether no point lies inside the circumcircle of a neighbor: in the plane
/// the sum of the two angles opposite to each inner edge is at most pi.
bool IsDelaunay(const cartan::Points& points, const cartan::Triangles& faces)
{
  const cartan::TriangleMesh mesh(static_cast<int>(points.rows()), faces);
  const auto opposite = [&](int d)
  {
    const Eigen::Vector3d p = points.row(mesh.Opposite(d));
    const Eigen::Vector3d u = points.row(mesh.Origin(d)).transpose() - p;
    const Eigen::Vector3d v = points.row(mesh.Neighbor(d)).transpose() - p;
    return std::atan2(u.cross(v).norm(), u.dot(v));
  };
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    const int twin = mesh.Twin(d);
    if (mesh.LeftTriangle(d) >= 0 && mesh.LeftTriangle(twin) >= 0 &&
      opposite(d) + opposite(twin) > shapes::Pi + 1e-7)
    {
      return false;
    }
  }
  return true;
}
}

TEST(PrepareSurfaceHoles, FlatHolesFillToTheFlatArea)
{
  const Shape plane = shapes::Plane(10, 1.0, 0.25, 4);
  const Shape pierced = Pierced(plane, { 5 * 11 + 5, 5 * 11 + 6, 2 * 11 + 2 });
  const RepairedSurface result = Repaired(pierced, Filling(12));
  EXPECT_EQ(result.Counts.FilledHoles, 2);
  EXPECT_EQ(result.Counts.OpenHoles, 1); // the sheet's own border
  EXPECT_NEAR(shapes::Area(result.Positions, result.Faces), 1.0, 1e-12);
  EXPECT_EQ(TopologyOf(result).Euler, 1);
  for (Eigen::Index t = 0; t < result.Faces.rows(); ++t)
  {
    const Eigen::Vector3d a = result.Positions.row(result.Faces(t, 0));
    const Eigen::Vector3d b = result.Positions.row(result.Faces(t, 1));
    const Eigen::Vector3d c = result.Positions.row(result.Faces(t, 2));
    EXPECT_GT((b - a).cross(c - a)[2], 0.0);
  }
  for (Eigen::Index t = pierced.Faces.rows(); t < result.Faces.rows(); ++t)
  {
    EXPECT_EQ(result.OriginalTriangles[t], -1);
  }
}

TEST(PrepareSurfaceHoles, FilledSurfacesEncloseTheirVolumeAgain)
{
  const Shape sphere = shapes::Icosphere(3);
  const double volume = shapes::Volume(sphere.Positions, sphere.Faces);
  const RepairedSurface result = Repaired(Pierced(sphere, { 0, 50, 51, 400 }), Filling(20));
  EXPECT_EQ(TopologyOf(result).BorderEdges, 0);
  EXPECT_EQ(TopologyOf(result).Euler, 2);
  EXPECT_NEAR(shapes::Volume(result.Positions, result.Faces), volume, 2e-3 * volume);
}

TEST(PrepareSurfaceHoles, LengthAndNumberOfEdgesLimitThem)
{
  const Shape cylinder = shapes::OpenCylinder(12, 4);
  EXPECT_EQ(Repaired(cylinder, Filling(11)).Counts.FilledHoles, 0);
  EXPECT_EQ(Repaired(cylinder, Filling(12)).Counts.FilledHoles, 2);
  RepairOptions options = Filling(12);
  options.Holes.MaximumLength = 12 * 2 * std::sin(shapes::Pi / 12) * (1 - 1e-9);
  EXPECT_EQ(Repaired(cylinder, options).Counts.FilledHoles, 0);
  options.Holes.MaximumLength *= 1 + 1e-6;
  const RepairedSurface closed = Repaired(cylinder, options);
  EXPECT_EQ(closed.Counts.FilledHoles, 2);
  // A prism over a regular polygon of 12 corners.
  EXPECT_NEAR(shapes::Volume(closed.Positions, closed.Faces),
    2.0 * 12 * 0.5 * std::sin(2 * shapes::Pi / 12), 1e-12);
}

TEST(PrepareSurfaceHoles, NoFillingMakesAnEdgeThatExists)
{
  // A tetrahedron without two of its faces: the only two fillings of the loop of
  // four are a second triangle on each existing face, and the missing faces.
  Shape open;
  open.Positions = shapes::ToPoints({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } });
  open.Faces = shapes::ToTriangles({ { 0, 2, 1 }, { 0, 1, 3 } });
  const RepairedSurface closed = Repaired(open, Filling(4));
  EXPECT_EQ(closed.Counts.FilledHoles, 1);
  EXPECT_EQ(TopologyOf(closed).Euler, 2);
  EXPECT_NEAR(shapes::Volume(closed.Positions, closed.Faces), 1.0 / 6.0, 1e-15);
  open.Faces = shapes::ToTriangles({ { 0, 2, 1 } });
  EXPECT_EQ(Repaired(open, Filling(4)).Counts.FilledHoles, 0);
}

TEST(PrepareSurfaceHoles, RealHolesClose)
{
  const Shape shape = shapes::RealMesh("elephant-with-holes");
  const RepairedSurface open = Repaired(shape);
  const RepairedSurface closed = Repaired(shape, Filling(cartan::LargestHole));
  EXPECT_GT(TopologyOf(open).BorderEdges, 0);
  EXPECT_EQ(TopologyOf(closed).BorderEdges, 0);
  EXPECT_EQ(closed.Counts.OpenHoles, 0);
  shapes::ShowFigure("holes filled", closed.Counts.FilledHoles);
}

TEST(PrepareSurfaceFlips, ThePlaneBecomesDelaunay)
{
  const Shape plane = shapes::Plane(12, 1.0, 0.3, 7);
  ASSERT_FALSE(IsDelaunay(plane.Positions, plane.Faces));
  const RepairedSurface result = Repaired(plane, Flipping());
  EXPECT_TRUE(IsDelaunay(result.Positions, result.Faces));
  EXPECT_NEAR(shapes::Area(result.Positions, result.Faces), 1.0, 1e-12);
  EXPECT_GT(result.Counts.FlippedEdges, 0);
  EXPECT_GE(
    SmallestAngle(result.Positions, result.Faces), SmallestAngle(plane.Positions, plane.Faces));
  EXPECT_EQ(Repaired({ result.Positions, result.Faces }, Flipping()).Counts.FlippedEdges, 0);
}

TEST(PrepareSurfaceFlips, EdgesOfTheShapeStay)
{
  // A bar's twelve edges are sharp; its faces are free.
  const Shape bar = shapes::Bar(3, 4, 9, { 1, 1, 4 });
  const RepairedSurface result = Repaired(bar, Flipping());
  EXPECT_NEAR(shapes::Area(result.Positions, result.Faces), 18.0, 1e-12);
  EXPECT_NEAR(shapes::Volume(result.Positions, result.Faces), 4.0, 1e-12);
  EXPECT_EQ(TopologyOf(result).Euler, 2);
}

TEST(PrepareSurfaceFlips, CapsVanish)
{
  // A point is moved onto the edge opposite to it, up to a height e: its triangle
  // is a cap whose largest angle is all but pi.
  for (const double e : { 1e-4, 1e-6, 1e-8, 0.0 })
  {
    Shape tube = shapes::OpenCylinder(16, 12);
    const int t = 16 * 2 * 6 + 10;
    const Eigen::RowVector3d b = tube.Positions.row(tube.Faces(t, 1));
    const Eigen::RowVector3d c = tube.Positions.row(tube.Faces(t, 2));
    const Eigen::RowVector3d a = tube.Positions.row(tube.Faces(t, 0));
    const double length = (c - b).norm();
    tube.Positions.row(tube.Faces(t, 0)) = 0.5 * (b + c) + e * length * (a - b).normalized();
    EXPECT_LT(SmallestAngle(tube.Positions, tube.Faces), 2.5 * e + 1e-12);
    const RepairedSurface result = Repaired(tube, Flipping());
    EXPECT_GT(SmallestAngle(result.Positions, result.Faces), 0.1);
    EXPECT_EQ(TopologyOf(result).Euler, 0);
  }
}
