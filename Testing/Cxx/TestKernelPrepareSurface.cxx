// SPDX-License-Identifier: BSD-3-Clause
#include "PrepareShapes.h"
#include "RealMeshes.h"

#include "Kernel/Base/Error.h"

#include <filesystem>
#include <limits>
#include <map>
#include <random>

using cartan::RepairedSurface;
using cartan::RepairOptions;
using shapes::Repaired;
using shapes::Shape;
using shapes::Topology;
using shapes::TopologyOf;

namespace
{
Shape Box(const Eigen::RowVector3d& at = Eigen::RowVector3d::Zero(), int n = 1)
{
  return shapes::Moved(shapes::Bar(n, n, n, { 1, 1, 1 }), at);
}

/// Merges all points, also those of bodies in contact.
RepairOptions MergingAll()
{
  RepairOptions options;
  options.MergesInnerPoints = true;
  return options;
}

/// A band of quads that closes after `turns` half twists; ids as in Patch.
Shape TwistedBand(int around, int across, int turns)
{
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3i> faces;
  const auto id = [&](int i, int j) {
    return i < around ? i * (across + 1) + j : turns % 2 == 1 ? across - j : j;
  };
  for (int i = 0; i < around; ++i)
  {
    const double u = 2 * shapes::Pi * i / around;
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
  return { shapes::ToPoints(positions), shapes::ToTriangles(faces) };
}

/// The grid of a Klein bottle immersed in space (the figure-8 immersion): v comes
/// back reversed after u went around.
Shape KleinBottle(int around, int tube)
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
    const double u = 2 * shapes::Pi * i / around;
    for (int j = 0; j < tube; ++j)
    {
      const double v = 2 * shapes::Pi * j / tube;
      const double r = 3.0 + std::cos(u / 2) * std::sin(v) - std::sin(u / 2) * std::sin(2 * v);
      positions.emplace_back(r * std::cos(u), r * std::sin(u),
        std::sin(u / 2) * std::sin(v) + std::cos(u / 2) * std::sin(2 * v));
      faces.emplace_back(id(i, j), id(i + 1, j), id(i + 1, j + 1));
      faces.emplace_back(id(i, j), id(i + 1, j + 1), id(i, j + 1));
    }
  }
  return { shapes::ToPoints(positions), shapes::ToTriangles(faces) };
}

/// `pages` unit squares of n x n quads that share one side along z.
Shape Book(int pages, int n)
{
  Shape book;
  for (int page = 0; page < pages; ++page)
  {
    const double angle = 2 * shapes::Pi * page / pages;
    shapes::PatchOptions options;
    options.CountU = options.CountV = n;
    const Shape sheet = shapes::Patch(options,
      [angle](double u, double v)
      { return Eigen::Vector3d(u * std::cos(angle), u * std::sin(angle), v); });
    book = page == 0 ? sheet : shapes::Union(book, sheet);
  }
  return book;
}

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

TEST(PrepareSurface, BoxesThatShareAnEdgeBecomeTwoClosedOnes)
{
  // On one edge, and along a line of three: points within the line have four
  // edges of four triangles.
  for (const int n : { 1, 3 })
  {
    const Shape boxes = shapes::Union(Box({ 0, 0, 0 }, n), Box({ 1, 1, 0 }, n));
    for (const bool insideOut : { false, true })
    {
      const RepairedSurface result =
        Repaired(insideOut ? shapes::Inverted(boxes) : boxes, MergingAll());
      const Topology topology = TopologyOf(result);
      EXPECT_EQ(topology.Components, 2);
      EXPECT_EQ(topology.BorderEdges, 0);
      EXPECT_EQ(topology.Euler, 4);
      EXPECT_EQ(result.Counts.NonManifoldEdges, n);
      EXPECT_EQ(result.Counts.CutPoints, n + 1);
      EXPECT_EQ(result.Counts.CopiedPoints, n + 1);
      EXPECT_NEAR(shapes::Volume(result.Positions, result.Faces), 2.0, 1e-12);
    }
  }
}

TEST(PrepareSurface, BoxesThatShareAVertexBecomeTwo)
{
  const Shape boxes = shapes::Union(Box(), Box({ 1, 1, 1 }));
  const RepairedSurface result = Repaired(boxes, MergingAll());
  EXPECT_EQ(TopologyOf(result).Components, 2);
  EXPECT_EQ(TopologyOf(result).BorderEdges, 0);
  EXPECT_EQ(result.Counts.MergedPoints, 1);
  EXPECT_EQ(result.Counts.CutPoints, 1);
  EXPECT_EQ(result.Positions.rows(), 16);
  // Each box gets its own point back, so that it can be carried back.
  for (int v = 0; v < 16; ++v)
  {
    EXPECT_EQ(result.OriginalPoints[result.PreparedPoints[v]], v);
  }
  std::map<int, int> sizes;
  for (const int first : result.CopyOf)
  {
    ++sizes[first];
  }
  EXPECT_EQ(std::count_if(sizes.begin(), sizes.end(),
              [](const std::pair<const int, int>& size) { return size.second == 2; }),
    1);
  EXPECT_EQ(sizes.size(), 15u);
}

TEST(PrepareSurface, ABodyThatTouchesItselfIsCutButStaysWhole)
{
  // A ring of seven boxes of a 3 x 3 frame whose first and last share an edge.
  // Their soup has the walls between neighbors twice.
  const std::vector<Eigen::RowVector3d> cells = { { 0, 0, 0 }, { 1, 0, 0 }, { 2, 0, 0 },
    { 2, 1, 0 }, { 2, 2, 0 }, { 1, 2, 0 }, { 0, 1, 0 } };
  Shape ring = Box(cells[0]);
  for (std::size_t i = 1; i < cells.size(); ++i)
  {
    ring = shapes::Union(ring, Box(cells[i]));
  }
  const RepairedSurface result = Repaired(ring, MergingAll());
  const Topology topology = TopologyOf(result);
  EXPECT_EQ(topology.Components, 1);
  EXPECT_EQ(topology.BorderEdges, 0);
  EXPECT_EQ(topology.Euler, 2);
  EXPECT_NEAR(shapes::Volume(result.Positions, result.Faces), 7.0, 1e-12);
  EXPECT_EQ(result.Counts.DoubledTriangles, 2 * 2 * 6);
}

TEST(PrepareSurface, PointsInsideTheSurfaceAreLeftAlone)
{
  // Boxes in contact, and a plate of no thickness that is closed at its rim.
  const Shape front = shapes::Plane(4);
  Shape plate = shapes::Union(front, shapes::Inverted(front));
  for (int corner = 0; corner < plate.Faces.size(); ++corner)
  {
    int& v = plate.Faces.data()[corner];
    v = plate.Positions.row(v).cwiseAbs().maxCoeff() > 0.49 ? v % front.NumberOfVertices() : v;
  }
  for (const bool dropsDoubled : { false, true })
  {
    RepairOptions options;
    options.DropsDoubled = dropsDoubled;
    const RepairedSurface result = Repaired(plate, options);
    EXPECT_EQ(result.Counts.MergedPoints, 0);
    EXPECT_EQ(TopologyOf(result).BorderEdges, 0);
  }
  const Shape boxes = shapes::Union(Box({ 0, 0, 0 }, 2), Box({ 1, 0, 0 }, 2));
  EXPECT_EQ(Repaired(boxes).Faces, boxes.Faces);
  // As soup they have borders only; the wall between them is there twice.
  EXPECT_EQ(TopologyOf(Repaired(shapes::Soup(boxes))).BorderEdges, 0);
}

TEST(PrepareSurface, PagesOfABookComeApart)
{
  for (const int pages : { 3, 5 })
  {
    const RepairedSurface result = Repaired(Book(pages, 4));
    const Topology topology = TopologyOf(result);
    EXPECT_EQ(topology.Components, pages);
    EXPECT_EQ(topology.Euler, pages);
    EXPECT_EQ(topology.BorderEdges, 16 * pages);
    EXPECT_EQ(result.Counts.NonManifoldEdges, 4);
    EXPECT_EQ(result.Counts.CutPoints, 5);
    EXPECT_EQ(result.Counts.CopiedPoints, 5 * (pages - 1));
    EXPECT_NEAR(shapes::Area(result.Positions, result.Faces), pages, 1e-12);
  }
}

TEST(PrepareSurface, OneSidedSurfacesAreCutAlongAPath)
{
  for (const int turns : { 0, 1, 2, 3 })
  {
    const Shape band = TwistedBand(24, 4, turns);
    const RepairedSurface result = Repaired(band);
    const bool isOneSided = turns % 2 == 1;
    EXPECT_EQ(TopologyOf(result).Components, 1);
    EXPECT_EQ(TopologyOf(result).Euler, isOneSided ? 1 : 0); // a disk or a ring
    EXPECT_EQ(result.Counts.OneSidedEdges > 0, isOneSided);
    EXPECT_LE(result.Counts.OneSidedEdges, 8);
    EXPECT_EQ(result.Faces.rows(), band.Faces.rows());
  }
  const RepairedSurface bottle = Repaired(KleinBottle(24, 12));
  EXPECT_EQ(TopologyOf(bottle).Components, 1);
  EXPECT_EQ(TopologyOf(bottle).Euler, 0); // cut along a circle, a ring
  EXPECT_GT(TopologyOf(bottle).BorderEdges, 0);
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
