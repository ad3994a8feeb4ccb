// SPDX-License-Identifier: BSD-3-Clause
#include "PrepareShapes.h"

#include "Kernel/Mesh/CoincidentBorders.h"

using cartan::CoincidentBorders;
using shapes::Shape;

namespace
{
CoincidentBorders Find(const Shape& shape)
{
  return cartan::FindCoincidentBorders(
    cartan::TriangleMesh(shape.NumberOfVertices(), shape.Faces), shape.Positions);
}

/// A sheet rolled to a tube whose seam has two rows of points.
Shape SeamedTube(int around, int along)
{
  shapes::PatchOptions options;
  options.CountU = around;
  options.CountV = along;
  return shapes::Patch(options,
    [](double u, double v)
    {
      const double angle = 2 * shapes::Pi * u; // sin(2 pi) is not 0
      return Eigen::Vector3d(std::cos(angle), std::sin(angle), 2 * v);
    });
}
}

TEST(CoincidentBorders, NoneWhereBordersAreApart)
{
  EXPECT_TRUE(Find(shapes::OpenCylinder(10, 5)).IsEmpty());
  EXPECT_TRUE(Find(shapes::Torus(10, 5)).IsEmpty());
  // Boxes in contact are closed; nothing there is a crack.
  EXPECT_TRUE(Find(shapes::Union(shapes::Bar(1, 1, 1, { 1, 1, 1 }),
                     shapes::Moved(shapes::Bar(1, 1, 1, { 1, 1, 1 }), { 1, 0, 0 })))
                .IsEmpty());
}

TEST(CoincidentBorders, CountsBothSidesOfASeam)
{
  const CoincidentBorders seam = Find(SeamedTube(12, 7));
  EXPECT_EQ(seam.NumberOfEdges, 14);
  EXPECT_EQ(seam.Points.GetCount(), 16u);
  EXPECT_EQ(seam.Points.GetFirst().front(), 0);
  EXPECT_EQ(seam.RelativeTolerance, CoincidentBorders::SamePlace);
}

TEST(CoincidentBorders, CountsSoup)
{
  const Shape sphere = shapes::Icosphere(1);
  const CoincidentBorders soup = Find(shapes::Soup(sphere));
  EXPECT_EQ(soup.NumberOfEdges, sphere.Faces.size());
  EXPECT_EQ(soup.Points.GetCount(), static_cast<std::size_t>(sphere.Faces.size()));
  EXPECT_EQ(soup.RelativeTolerance, 0.0);
}

TEST(CoincidentBorders, TheTipOfASlitIsOnePoint)
{
  // The middle column's lower points doubled for the triangles to their right.
  Shape sheet = shapes::Plane(4);
  const int size = sheet.NumberOfVertices();
  sheet.Positions.conservativeResize(size + 2, 3);
  for (int j = 0; j < 2; ++j)
  {
    sheet.Positions.row(size + j) = sheet.Positions.row(5 * j + 2);
    for (Eigen::Index t = 0; t < sheet.Faces.rows(); ++t)
    {
      for (int corner = 0; corner < 3; ++corner)
      {
        const bool isRight =
          (sheet.Positions(sheet.Faces(t, 0), 0) + sheet.Positions(sheet.Faces(t, 1), 0) +
            sheet.Positions(sheet.Faces(t, 2), 0)) > 0.0;
        sheet.Faces(t, corner) =
          isRight && sheet.Faces(t, corner) == 5 * j + 2 ? size + j : sheet.Faces(t, corner);
      }
    }
  }
  const CoincidentBorders slit = Find(sheet);
  EXPECT_EQ(slit.NumberOfEdges, 4);
  EXPECT_EQ(slit.Points.GetCount(), 4u);
}

TEST(CoincidentBorders, WhatTheyCountIsWhatMergingCloses)
{
  const Shape tube = SeamedTube(12, 7);
  cartan::RepairOptions options;
  options.MergeTolerance = Find(tube).RelativeTolerance * std::sqrt(12.0); // the diagonal
  const cartan::RepairedSurface closed = shapes::Repaired(tube, options);
  EXPECT_EQ(shapes::TopologyOf(closed).Euler, 0); // a ring
  EXPECT_TRUE(Find({ closed.Positions, closed.Faces }).IsEmpty());
}

TEST(CoincidentBorders, LeavesOutWhatMergingCannotClose)
{
  // Three sheets on one line, each with its own points.
  Shape book;
  for (int page = 0; page < 3; ++page)
  {
    const double angle = 2 * shapes::Pi * page / 3;
    const Shape sheet = shapes::Patch({},
      [angle](double u, double v)
      { return Eigen::Vector3d(u * std::cos(angle), u * std::sin(angle), v); });
    book = page == 0 ? sheet : shapes::Union(book, sheet);
  }
  EXPECT_TRUE(Find(book).IsEmpty());
}
