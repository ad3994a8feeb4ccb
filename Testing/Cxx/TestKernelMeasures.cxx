// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Measure/Areas.h"
#include "Kernel/Measure/ComponentVolumes.h"
#include "Kernel/Measure/EdgeLengths.h"
#include "Kernel/Measure/LocalVolumes.h"
#include "Kernel/Measure/ShapeDistance.h"

#include "Kernel/Differential/RotationFit.h"
#include "MeasureShapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

using namespace cartan;
using shapes::BentBar;
using shapes::MakeMesh;

namespace
{
std::shared_ptr<const TriangleMesh> SharedMesh(const shapes::Shape& shape)
{
  return std::make_shared<const TriangleMesh>(MakeMesh(shape));
}

double VolumeOf(const shapes::Shape& shape)
{
  return MeasureComponents(MakeMesh(shape), shape.Positions).front().Volume;
}
}

TEST(Measures, VolumeAndAreaOfABarAreExact)
{
  const shapes::Shape bar = shapes::Bar(3, 4, 5, { 1.0, 2.0, 3.0 });
  const auto components = MeasureComponents(MakeMesh(bar), bar.Positions);
  ASSERT_EQ(components.size(), 1u);
  EXPECT_TRUE(components[0].IsClosed);
  EXPECT_NEAR(components[0].Volume, 6.0, 1e-13);
  EXPECT_NEAR(components[0].Area, 22.0, 1e-13);
}

TEST(Measures, VolumeOfASphereConvergesWithTheSquareOfTheEdgeLength)
{
  const double exact = 4.0 * shapes::Pi / 3.0;
  const double coarse = exact - VolumeOf(shapes::Icosphere(3));
  const double fine = exact - VolumeOf(shapes::Icosphere(4));
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.05);
}

TEST(Measures, VolumeKeepsItsDigitsFarAway)
{
  shapes::Shape bar = shapes::Bar(3, 4, 5, { 1.0, 2.0, 3.0 });
  bar.Positions.rowwise() += Eigen::RowVector3d(1e6, 1e6, -1e6);
  EXPECT_NEAR(VolumeOf(bar), 6.0, 1e-8);
}

TEST(Measures, InvertedSurfacesAndCavitiesHaveNegativeVolume)
{
  const shapes::Shape outer = shapes::Bar(2, 2, 2, { 2.0, 2.0, 2.0 });
  EXPECT_NEAR(VolumeOf(shapes::Inverted(outer)), -8.0, 1e-13);
  const shapes::Shape shell =
    shapes::Union(outer, shapes::Inverted(shapes::Bar(2, 2, 2, { 1.0, 1.0, 1.0 })));
  const auto components = MeasureComponents(MakeMesh(shell), shell.Positions);
  ASSERT_EQ(components.size(), 2u);
  EXPECT_NEAR(components[0].Volume, 8.0, 1e-13);
  EXPECT_NEAR(components[1].Volume, -1.0, 1e-13);
}

TEST(Measures, OpenComponentsSaySo)
{
  const shapes::Shape both =
    shapes::Union(shapes::OpenCylinder(12, 3), shapes::Bar(1, 1, 1, { 1.0, 1.0, 1.0 }));
  const auto components = MeasureComponents(MakeMesh(both), both.Positions);
  ASSERT_EQ(components.size(), 2u);
  EXPECT_FALSE(components[0].IsClosed);
  EXPECT_TRUE(components[1].IsClosed);
}

TEST(Measures, AreasSumUp)
{
  const shapes::Shape torus = shapes::Torus(24, 16, 2.0, 0.7, 0.2);
  const TriangleMesh mesh = MakeMesh(torus);
  const Eigen::VectorXd triangles = TriangleAreas(mesh, torus.Positions);
  const double total = MeasureComponents(mesh, torus.Positions)[0].Area;
  EXPECT_NEAR(triangles.sum(), total, 1e-12);
  EXPECT_NEAR(BarycentricAreas(mesh, triangles).sum(), total, 1e-12);
}

TEST(Measures, RatiosAreDefinedOrNotANumber)
{
  const Eigen::VectorXd ratios =
    Ratios(Eigen::Vector4d(2.0, 0.0, 0.0, -1.0), Eigen::Vector4d(1.0, 0.0, 1.0, 1.0));
  EXPECT_EQ(ratios[0], 0.5);
  EXPECT_EQ(ratios[1], 1.0);
  EXPECT_TRUE(std::isnan(ratios[2]));
  EXPECT_TRUE(std::isnan(ratios[3]));
}

TEST(Measures, UniformScalingChangesAllEdgesAlike)
{
  const shapes::Shape torus = shapes::Torus(24, 16);
  const EdgeLengthChange change =
    CompareEdgeLengths(MakeMesh(torus), torus.Positions, 1.25 * torus.Positions);
  EXPECT_NEAR(change.RootMeanSquare, 0.25, 1e-13);
  EXPECT_NEAR(change.Maximum, 0.25, 1e-13);
  EXPECT_LT((change.VertexRatio.array() - 1.25).abs().maxCoeff(), 1e-13);
}

TEST(Measures, EdgesOfLengthZeroAreLeftOutAndCounted)
{
  shapes::Shape plane = shapes::Plane(2);
  const Points current = plane.Positions;
  plane.Positions.row(1) = plane.Positions.row(0);
  const EdgeLengthChange change = CompareEdgeLengths(MakeMesh(plane), plane.Positions, current);
  EXPECT_EQ(change.ZeroLength.GetCount(), 1u);
  EXPECT_TRUE(std::isfinite(change.RootMeanSquare));
  EXPECT_TRUE(change.VertexRatio.allFinite());
}

TEST(Measures, UnusedPointsHaveNotChanged)
{
  Triangles triangle(1, 3);
  triangle << 0, 1, 2;
  Points points(4, 3);
  points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5;
  const TriangleMesh mesh(4, triangle);
  EXPECT_EQ(CompareEdgeLengths(mesh, points, 2.0 * points).VertexRatio[3], 1.0);
  EXPECT_EQ(MeasureShapeDistance(mesh, points, 2.0 * points).Density[3], 0.0);
  EXPECT_TRUE(MatrixAt(FitRotations(mesh, points, points), 3).isIdentity(1e-15));
  const LocalVolumes volumes(std::make_shared<const TriangleMesh>(mesh), points);
  EXPECT_EQ(volumes.GetReference()[3], 0.0);
  EXPECT_TRUE(std::isnan(volumes.GetReference()[0]));
}

TEST(LocalVolumes, SumToTheEnclosedVolume)
{
  for (const shapes::Shape& shape : { shapes::Bar(4, 4, 20, { 1.0, 1.0, 5.0 }),
         shapes::Torus(32, 16), shapes::Noisy(shapes::Icosphere(3), 0.05) })
  {
    const LocalVolumes volumes(SharedMesh(shape), shape.Positions);
    EXPECT_NEAR(volumes.GetReference().sum(), VolumeOf(shape), 1e-11);
    const shapes::Shape other = shapes::Noisy(shape, 0.1, 5);
    EXPECT_NEAR(volumes.Measure(other.Positions).Values.sum(), VolumeOf(other), 1e-11);
  }
}

TEST(LocalVolumes, OfTheReferenceAgreeWithTheMeasuredOnes)
{
  const shapes::Shape shape = shapes::Noisy(shapes::Torus(32, 16), 0.03);
  const LocalVolumes volumes(SharedMesh(shape), shape.Positions);
  EXPECT_LT(
    (volumes.Measure(shape.Positions).Values - volumes.GetReference()).cwiseAbs().maxCoeff(),
    1e-12);
}

TEST(LocalVolumes, InvariantToRigidMotions)
{
  const shapes::Shape shape = shapes::Torus(32, 16, 2.0, 0.7, 0.2);
  const LocalVolumes volumes(SharedMesh(shape), shape.Positions);
  const Points moved = shapes::RandomRigidMotion(3, 10.0)(shape.Positions);
  EXPECT_LT((volumes.Measure(moved).Values - volumes.GetReference()).cwiseAbs().maxCoeff(), 1e-12);
  const LocalVolumes ofMoved(SharedMesh(shape), moved);
  EXPECT_LT((ofMoved.GetReference() - volumes.GetReference()).cwiseAbs().maxCoeff(), 1e-12);
}

// As a difference of products of long edges, below rounding: the result then depends on the frame.
TEST(LocalVolumes, KnowTheirRounding)
{
  const shapes::Shape shape = shapes::Noisy(shapes::Torus(32, 16, 2.0, 0.7, 0.2), 0.05);
  const LocalVolumes volumes(SharedMesh(shape), shape.Positions);
  const auto turn = shapes::RandomRigidMotion(3, 0.0);
  const auto differenceOf = [&](double stretch)
  {
    Points stretched = shape.Positions;
    stretched.col(0) = stretched.col(0).array().cube() * stretch;
    const cartan::MeasuredVolumes here = volumes.Measure(stretched);
    const cartan::MeasuredVolumes there = volumes.Measure(turn(stretched));
    const double largest = here.Values.cwiseAbs().maxCoeff();
    return std::pair(here.Rounding, (here.Values - there.Values).cwiseAbs().maxCoeff() / largest);
  };
  for (const double stretch : { 1.0, 1e2, 1e3 })
  {
    const auto [rounding, difference] = differenceOf(stretch);
    EXPECT_LT(rounding, cartan::LargestVolumeRounding) << stretch;
    EXPECT_LT(difference, 1e-4) << stretch;
  }
  for (const double stretch : { 1e7, 1e9 })
  {
    const auto [rounding, difference] = differenceOf(stretch);
    EXPECT_GT(rounding, cartan::LargestVolumeRounding) << stretch;
  }
  EXPECT_GT(differenceOf(1e9).second, 1e-3);
  // Alike in all directions, all digits stay, and flattened, nothing is left to be off.
  Points flat = shape.Positions;
  flat.col(2).setZero();
  EXPECT_LT(volumes.Measure(flat).Rounding, 1e-12);
  EXPECT_LT(volumes.Measure(1e9 * shape.Positions).Rounding, 1e-12);
}

TEST(LocalVolumes, AreEqualOnASphere)
{
  const shapes::Shape sphere = shapes::Icosphere(3);
  const TriangleMesh mesh = MakeMesh(sphere);
  const LocalVolumes volumes(SharedMesh(sphere), sphere.Positions);
  const Eigen::VectorXd perArea = volumes.GetReference().cwiseQuotient(
    BarycentricAreas(mesh, TriangleAreas(mesh, sphere.Positions)));
  EXPECT_LT((perArea.array() * 3.0 - 1.0).abs().maxCoeff(), 0.03);
}

TEST(LocalVolumes, FindWhereTheVolumeWasLost)
{
  // The ends move rigidly, the middle is bent and thinned.
  const shapes::Shape bar = shapes::Bar(6, 6, 60, { 1.0, 1.0, 10.0 });
  const Points bent = BentBar(bar.Positions, 4.0, 6.0, 1.5, 0.4);
  const LocalVolumes volumes(SharedMesh(bar), bar.Positions);
  const Eigen::VectorXd now = volumes.Measure(bent).Values;
  double endsBefore = 0.0;
  double endsNow = 0.0;
  double middleBefore = 0.0;
  double middleNow = 0.0;
  for (int v = 0; v < bar.NumberOfVertices(); ++v)
  {
    const double z = bar.Positions(v, 2);
    if (z < 2.5 || z > 7.5)
    {
      endsBefore += volumes.GetReference()[v];
      endsNow += now[v];
      EXPECT_NEAR(now[v] / volumes.GetReference()[v], 1.0, 0.1);
    }
    else if (std::abs(z - 5.0) < 0.2)
    {
      middleBefore += volumes.GetReference()[v];
      middleNow += now[v];
    }
  }
  EXPECT_NEAR(endsNow / endsBefore, 1.0, 0.01);
  EXPECT_NEAR(middleNow / middleBefore, 0.36, 0.06);
}

TEST(LocalVolumes, FlatClosedSurfacesEncloseNothing)
{
  shapes::Shape flat = shapes::Bar(2, 2, 2, { 1.0, 1.0, 1.0 });
  flat.Positions.col(2).setZero();
  const LocalVolumes volumes(SharedMesh(flat), flat.Positions);
  EXPECT_TRUE(volumes.GetReference().array().isNaN().all());
}
