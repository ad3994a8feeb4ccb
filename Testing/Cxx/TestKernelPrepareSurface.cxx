// SPDX-License-Identifier: BSD-3-Clause
#include "PrepareShapes.h"
#include "RealMeshes.h"

#include "Kernel/Base/Error.h"

#include <filesystem>
#include <limits>
#include <random>

using cartan::RepairedSurface;
using cartan::RepairOptions;
using shapes::Book;
using shapes::Box;
using shapes::KleinBottle;
using shapes::MergingAll;
using shapes::Repaired;
using shapes::Shape;
using shapes::Topology;
using shapes::TopologyOf;
using shapes::TwistedBand;

namespace
{
/// How many triangles of `faces` are those of `other` with the same start and
/// direction, row by row.
int SameRows(const cartan::Triangles& faces, const cartan::Triangles& other)
{
  int count = 0;
  for (Eigen::Index t = 0; t < faces.rows(); ++t)
  {
    count += faces.row(t) == other.row(t);
  }
  return count;
}
}

TEST(PrepareSurface, SoundSurfacesStayAsTheyAre)
{
  for (const Shape& shape : { shapes::Torus(12, 8), shapes::OpenCylinder(10, 5),
         shapes::Union(shapes::Icosphere(1), shapes::Moved(shapes::Icosphere(1), { 5, 0, 0 })) })
  {
    const RepairedSurface result = Repaired(shape);
    EXPECT_EQ(result.Positions, shape.Positions);
    EXPECT_EQ(result.Faces, shape.Faces);
    EXPECT_EQ(result.Counts.Describe(), "Nothing was to repair.");
    for (int v = 0; v < shape.NumberOfVertices(); ++v)
    {
      EXPECT_EQ(result.OriginalPoints[v], v);
      EXPECT_EQ(result.PreparedPoints[v], v);
      EXPECT_EQ(result.CopyOf[v], v);
    }
  }
}

TEST(PrepareSurface, SoupBecomesTheSurfaceItWas)
{
  const Shape sphere = shapes::Icosphere(3);
  const RepairedSurface result = Repaired(shapes::Soup(sphere));
  const Topology topology = TopologyOf(result);
  EXPECT_EQ(topology.Components, 1);
  EXPECT_EQ(topology.BorderEdges, 0);
  EXPECT_EQ(topology.Euler, 2);
  EXPECT_EQ(result.Positions.rows(), sphere.Positions.rows());
  EXPECT_EQ(result.Faces.rows(), sphere.Faces.rows());
  EXPECT_EQ(result.Counts.MergedPoints, sphere.Faces.size() - sphere.Positions.rows());
  EXPECT_DOUBLE_EQ(
    shapes::Volume(result.Positions, result.Faces), shapes::Volume(sphere.Positions, sphere.Faces));
}

TEST(PrepareSurface, RandomlyTurnedTrianglesAgreeAndFaceOutwards)
{
  for (unsigned int seed = 1; seed < 6; ++seed)
  {
    const Shape torus = shapes::Torus(20, 10);
    const RepairedSurface result = Repaired(shapes::RandomlyTurned(torus, seed));
    EXPECT_EQ(TopologyOf(result).Euler, 0);
    EXPECT_EQ(TopologyOf(result).BorderEdges, 0);
    EXPECT_NEAR(shapes::Volume(result.Positions, result.Faces),
      shapes::Volume(torus.Positions, torus.Faces), 1e-12);
  }
}

TEST(PrepareSurface, OpenPartsKeepTheSideOfMostOfTheirArea)
{
  Shape sheet = shapes::Plane(6);
  std::swap(sheet.Faces(0, 1), sheet.Faces(0, 2));
  const RepairedSurface result = Repaired(sheet);
  EXPECT_EQ(result.Counts.TurnedTriangles, 1);
  EXPECT_EQ(result.Faces, shapes::Plane(6).Faces);
}

TEST(PrepareSurface, WallsOfCavitiesFaceInwards)
{
  const auto ball = [](double radius, const Eigen::RowVector3d& at)
  { return shapes::Moved(shapes::Icosphere(2, radius), at); };
  const double unit = shapes::Volume(ball(1, { 0, 0, 0 }).Positions, ball(1, { 0, 0, 0 }).Faces);
  // A ball of 4 with a cavity of 3 that holds a ball of 2; another cavity-free
  // ball beside it, and one of 0.4 in the shell between 3 and 4.
  Shape shells = shapes::Union(ball(2, { 0, 0, 0 }), shapes::Inverted(ball(4, { 0, 0, 0 })));
  shells = shapes::Union(shells, ball(3, { 0, 0, 0 }));
  shells = shapes::Union(shells, shapes::Inverted(ball(1, { 9, 0, 0 })));
  shells = shapes::Union(shells, ball(0.4, { 3.45, 0, 0 }));
  const RepairedSurface nested = Repaired(shells);
  EXPECT_NEAR(
    shapes::Volume(nested.Positions, nested.Faces), unit * (64 - 27 + 8 + 1 - 0.064), 1e-9);
  EXPECT_EQ(nested.Counts.ReversedComponents, 4);
  RepairOptions options;
  options.AlternatesNested = false;
  const RepairedSurface outwards = Repaired(shells, options);
  EXPECT_NEAR(
    shapes::Volume(outwards.Positions, outwards.Faces), unit * (64 + 27 + 8 + 1 + 0.064), 1e-9);
}

TEST(PrepareSurface, DoubledTrianglesGo)
{
  const Shape sphere = shapes::Icosphere(2);
  // The whole surface twice, once turned over; and one triangle three times.
  for (const Shape& second : { sphere, shapes::Inverted(sphere) })
  {
    const RepairedSurface result = Repaired(shapes::Union(sphere, second), MergingAll());
    EXPECT_EQ(result.Faces, sphere.Faces);
    EXPECT_EQ(result.Counts.DoubledTriangles, sphere.Faces.rows());
  }
  Shape thrice = sphere;
  thrice.Faces.conservativeResize(sphere.Faces.rows() + 2, 3);
  thrice.Faces.bottomRows(2) = sphere.Faces.topRows(1).replicate(2, 1);
  EXPECT_EQ(Repaired(thrice).Faces, sphere.Faces);
  // Front and back of a sheet on the same points.
  const Shape sheet = shapes::Plane(5);
  Shape sides = sheet;
  sides.Faces.resize(2 * sheet.Faces.rows(), 3);
  sides.Faces << sheet.Faces, shapes::Inverted(sheet).Faces;
  EXPECT_EQ(Repaired(sides).Faces, sheet.Faces);
}

TEST(PrepareSurface, PlatesAndBodiesInContactStayClosed)
{
  // A plate: front and back share the rim. At a corner one triangle has all its
  // points on the rim and is there twice.
  const Shape front = shapes::Plane(4);
  Shape plate = shapes::Union(front, shapes::Inverted(front));
  for (int corner = 0; corner < plate.Faces.size(); ++corner)
  {
    int& v = plate.Faces.data()[corner];
    const Eigen::RowVector3d p = plate.Positions.row(v).cwiseAbs();
    v = p.maxCoeff() > 0.49 ? v % front.NumberOfVertices() : v;
    plate.Positions(v, 2) = p.maxCoeff() > 0.49 ? 0.0 : v < front.NumberOfVertices() ? 0.1 : -0.1;
  }
  const RepairedSurface cushion = Repaired(plate, MergingAll());
  EXPECT_EQ(TopologyOf(cushion).BorderEdges, 0);
  EXPECT_EQ(TopologyOf(cushion).Euler, 2);
  EXPECT_GT(cushion.Counts.DoubledTriangles, 0);
  // Two boxes with a face in common become one body.
  const RepairedSurface bar =
    Repaired(shapes::Union(Box({ 0, 0, 0 }, 3), Box({ 1, 0, 0 }, 3)), MergingAll());
  EXPECT_EQ(TopologyOf(bar).Components, 1);
  EXPECT_EQ(TopologyOf(bar).BorderEdges, 0);
  EXPECT_NEAR(shapes::Volume(bar.Positions, bar.Faces), 2.0, 1e-12);
}

TEST(PrepareSurface, ToleranceClosesGapsAndCollapsesNeedles)
{
  const Shape torus = shapes::Torus(16, 10);
  RepairOptions options;
  options.MergeTolerance = 1e-3;
  const RepairedSurface closed = Repaired(shapes::Noisy(shapes::Soup(torus), 1e-4), options);
  EXPECT_EQ(closed.Positions.rows(), torus.Positions.rows());
  EXPECT_EQ(TopologyOf(closed).BorderEdges, 0);
  EXPECT_EQ(TopologyOf(closed).Euler, 0);
  // A point pulled next to its neighbor: both triangles of the short edge go.
  Shape needle = shapes::Icosphere(2);
  const int a = needle.Faces(0, 0);
  const int b = needle.Faces(0, 1);
  needle.Positions.row(a) = needle.Positions.row(b) + Eigen::RowVector3d(1e-5, 0, 0);
  const RepairedSurface result = Repaired(needle, options);
  EXPECT_EQ(result.Counts.CollapsedTriangles, 2);
  EXPECT_EQ(TopologyOf(result).Euler, 2);
  EXPECT_EQ(TopologyOf(result).BorderEdges, 0);
}

TEST(PrepareSurface, ResultsDoNotDependOnUnitsAndPlace)
{
  const Shape input = shapes::RandomlyTurned(
    shapes::Soup(shapes::Union(Box({ 0, 0, 0 }, 3), Box({ 1, 1, 0 }, 3))), 3);
  const RepairedSurface once = Repaired(input);
  for (const double unit : { 9.5367431640625e-7, 1048576.0 }) // powers of two: exact
  {
    Shape scaled = input;
    scaled.Positions *= unit;
    EXPECT_EQ(Repaired(scaled).Faces, once.Faces);
  }
  EXPECT_EQ(Repaired(shapes::Moved(input, { 4096.0, -512.0, 64.0 })).Faces, once.Faces);
}

TEST(PrepareSurface, ASecondRepairChangesNothing)
{
  RepairOptions options;
  for (const Shape& shape : { shapes::Soup(shapes::Union(Box(), Box({ 1, 1, 0 }))), Book(3, 4),
         TwistedBand(24, 4, 1), KleinBottle(24, 12) })
  {
    const RepairedSurface once = Repaired(shape, options);
    const RepairedSurface twice = Repaired({ once.Positions, once.Faces }, options);
    EXPECT_EQ(twice.Faces.rows(), once.Faces.rows());
    EXPECT_EQ(twice.Positions.rows(), once.Positions.rows());
    EXPECT_EQ(SameRows(twice.Faces, once.Faces), once.Faces.rows());
  }
}

TEST(PrepareSurface, SmallComponentsGoWithTheirPoints)
{
  Shape shapes =
    shapes::Union(shapes::Icosphere(2), shapes::Moved(shapes::Icosphere(1, 0.05), { 3, 0, 0 }));
  const int big = shapes::Icosphere(2).NumberOfVertices();
  shapes.Positions.conservativeResize(shapes.Positions.rows() + 1, 3);
  shapes.Positions.bottomRows(1) << 7.0, 7.0, 7.0; // in no triangle
  RepairOptions options;
  options.SmallestComponent = 0.01;
  const RepairedSurface result = Repaired(shapes, options);
  EXPECT_EQ(result.Counts.RemovedComponents, 1);
  EXPECT_EQ(TopologyOf(result).Components, 1);
  ASSERT_EQ(result.Positions.rows(), big + 1);
  EXPECT_EQ(result.OriginalPoints.back(), shapes.NumberOfVertices() - 1);
  EXPECT_EQ(result.PreparedPoints[big], -1);
  EXPECT_EQ(result.PreparedPoints.back(), big);
  options.SmallestComponent = 1e-4;
  EXPECT_EQ(Repaired(shapes, options).Counts.RemovedComponents, 0);
}

TEST(PrepareSurface, RefusesWhatNobodyCanRepair)
{
  Shape sphere = shapes::Icosphere(0);
  const auto refuses = [](const Shape& shape, const std::string& words)
  {
    try
    {
      cartan::RepairSurface(shape.Positions, shape.Faces);
      ADD_FAILURE() << "accepted, not refused with: " << words;
    }
    catch (const cartan::Error& error)
    {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  sphere.Positions(3, 1) = std::numeric_limits<double>::quiet_NaN();
  refuses(sphere, "1 point (id 3) with a NaN or infinite coordinate");
  sphere = shapes::Icosphere(0);
  sphere.Faces(4, 1) = 12;
  refuses(sphere, "1 triangle (id 4) using a point that does not exist");
  sphere = shapes::Icosphere(0);
  sphere.Positions.setZero();
  refuses(sphere, "No triangle is left");
}

/// Triangles between random points of a small grid: edges of many triangles,
/// points twice, points in one place, one-sided parts, touching fans. Whatever
/// the settings, as long as it cuts, the result is a manifold.
TEST(PrepareSurface, AnyTrianglesBecomeAManifold)
{
  int repaired = 0;
  for (unsigned int seed = 1; seed <= 3000; ++seed)
  {
    std::mt19937 random(seed);
    const auto pick = [&random](unsigned int count) { return random() % count; };
    Shape shape;
    shape.Positions.resize(3 + pick(12), 3);
    shape.Faces.resize(1 + pick(25), 3);
    for (Eigen::Index i = 0; i < shape.Positions.size(); ++i)
    {
      shape.Positions.data()[i] = pick(4);
    }
    for (Eigen::Index i = 0; i < shape.Faces.size(); ++i)
    {
      shape.Faces.data()[i] =
        static_cast<int>(pick(static_cast<unsigned int>(shape.Positions.rows())));
    }
    RepairOptions options;
    options.MergesPoints = pick(4) > 0;
    options.MergesInnerPoints = pick(2) > 0;
    options.MergeTolerance = pick(3) > 0 ? 0.0 : 0.5;
    options.DropsDoubled = pick(4) > 0;
    options.Orients = pick(4) > 0;
    options.FlipsEdges = pick(2) > 0;
    options.Flips.MaximumAngle = pick(2) > 0 ? 0.1 : 3.2;
    options.Holes.MaximumEdges = pick(2) > 0 ? 20 : 0;
    options.SmallestComponent = pick(3) > 0 ? 0.0 : 0.2;
    SCOPED_TRACE(seed);
    try
    {
      Repaired(shape, options);
      ++repaired;
    }
    catch (const cartan::Error& error)
    {
      ASSERT_NE(std::string(error.what()).find("No triangle"), std::string::npos) << error.what();
    }
  }
  EXPECT_GT(repaired, 2500);
}

/// Every mesh of libcgal-demo that has triangles becomes one that TriangleMesh
/// takes, of the same area but for doubled triangles, with no closed one opened.
TEST(PrepareSurface, RealMeshesBecomeManifolds)
{
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(CARTAN_MESH_DIR))
  {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() != ".off")
    {
      continue;
    }
    Shape shape;
    try
    {
      shape = shapes::RealMesh(name);
    }
    catch (const std::runtime_error&)
    {
      continue; // not the OFF format, or cut short
    }
    if (shape.Faces.rows() == 0)
    {
      continue;
    }
    SCOPED_TRACE(name);
    ++count;
    const RepairedSurface result = Repaired(shape);
    const double area = shapes::Area(shape.Positions, shape.Faces);
    if (result.Counts.DoubledTriangles == 0)
    {
      EXPECT_NEAR(shapes::Area(result.Positions, result.Faces), area, 1e-9 * area);
    }
    if (cartan::TriangleMesh::Check(shape.Positions, shape.Faces).IsUsable())
    {
      EXPECT_EQ(result.Counts.OneSidedEdges, 0);
    }
    else
    {
      std::cout << "[ figure   ] " << name << ": " << result.Counts.Describe() << "\n";
    }
  }
  shapes::ShowFigure("meshes", count);
  EXPECT_GT(count, 100);
}
