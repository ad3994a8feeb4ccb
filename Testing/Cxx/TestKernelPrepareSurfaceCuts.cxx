// SPDX-License-Identifier: BSD-3-Clause
#include "PrepareShapes.h"

#include <map>

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

/// Where a surface is no manifold it comes apart, and nowhere else.

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
