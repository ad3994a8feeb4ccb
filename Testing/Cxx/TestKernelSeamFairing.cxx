// SPDX-License-Identifier: BSD-3-Clause
#include "MergeShapes.h"

#include "Kernel/Base/Constants.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using namespace shapes;

/// The part of a turned unit sphere on one side of z = .1, its boundary on the sphere.
Shape Cap(int level, unsigned int seed, double side)
{
  constexpr double Height = 0.1;
  Shape sphere = Icosphere(level);
  sphere.Positions = Transformed(sphere.Positions, 1.0, RandomRigidMotion(seed, 0.0));
  Shape cap = CutByPlane(sphere, { 0, 0, Height }, { 0, 0, side });
  const cartan::TriangleMesh mesh = MakeMesh(cap);
  for (int v = 0; v < cap.NumberOfVertices(); ++v)
  {
    if (mesh.IsBoundary(v))
    {
      cap.Positions.row(v).head<2>() *=
        std::sqrt(1.0 - Height * Height) / cap.Positions.row(v).head<2>().norm();
    }
  }
  return cap;
}

/// Both parts as they lie, sewn together.
Merged SewCaps(int levelOfTarget, int levelOfSource)
{
  const Shape target = Cap(levelOfTarget, 3, -1.0);
  const Shape source = Cap(levelOfSource, 5, 1.0);
  shapes::Keys keys;
  for (const double angle : { 0.0, 2.0, 4.0 })
  {
    const Eigen::Vector3d place(std::cos(angle), std::sin(angle), 0.1);
    keys.emplace_back(BoundaryPointAt(source, place), BoundaryPointAt(target, place));
  }
  Merged merged = Merge(target, source, keys);
  for (int v = 0; v < merged.Joined.NumberOfVertices(); ++v)
  {
    if (merged.Joined.SourceVertices[v] >= 0 && !merged.Joined.IsSeam[v])
    {
      merged.Positions.row(v) = source.Positions.row(merged.Joined.SourceVertices[v]);
    }
  }
  return merged;
}

/// Root mean square over all points.
double RadiusError(const cartan::Points& points)
{
  return std::sqrt((points.rowwise().norm().array() - 1.0).square().mean());
}

/// A tube of radius 1 with `waves` waves around it.
Shape WavyTube(double from, int waves, double height)
{
  Shape tube = OpenCylinder(48, 24, 1.0, 2.0);
  for (int v = 0; v < tube.NumberOfVertices(); ++v)
  {
    const double angle = std::atan2(tube.Positions(v, 1), tube.Positions(v, 0));
    tube.Positions.row(v).head<2>() *= 1.0 + height * std::cos(waves * angle);
    tube.Positions(v, 2) += from;
  }
  return tube;
}

/// A tube that was cut in two, sewn again at z = 2.
Merged SewWavyTubes(int waves, double height)
{
  const Shape target = WavyTube(0.0, waves, height);
  return Merge(target, WavyTube(2.0, waves, height), { { 0, target.NumberOfVertices() - 48 } });
}

/// By how much points that lie between two distances from z = 2 moved, root of squares.
double Moves(const Merged& merged, const cartan::Points& points, double from, double to)
{
  double sum = 0.0;
  for (int v = 0; v < merged.Joined.NumberOfVertices(); ++v)
  {
    const double distance = std::abs(merged.Positions(v, 2) - 2.0);
    if (distance >= from && distance < to)
    {
      sum += (points.row(v) - merged.Positions.row(v)).squaredNorm();
    }
  }
  return std::sqrt(sum);
}
}

TEST(SeamFairing, MakesOneSphereOfTwoCaps)
{
  const Merged merged = SewCaps(4, 4);
  const cartan::Points smooth = merged.Faired(3);
  const cartan::Points blended = merged.Blended(3);
  ShowFigure("radius error, thin plate", RadiusError(smooth));
  ShowFigure("radius error, blend", RadiusError(blended));
  EXPECT_LT(RadiusError(smooth), 0.0013);
  EXPECT_LT(RadiusError(blended), 0.00043);
  EXPECT_LT(merged.Angles(blended).Mean, merged.Angles().Mean);
  // Sizes of triangles that differ by two: there the fold was twice as large.
  const Merged graded = SewCaps(4, 3);
  ShowFigure("radius error of other sizes, thin plate", RadiusError(graded.Faired(3)));
  ShowFigure("radius error of other sizes, blend", RadiusError(graded.Blended(3)));
  EXPECT_LT(RadiusError(graded.Blended(3)), 0.5 * RadiusError(graded.Faired(3)));
}

TEST(SeamFairing, KeepsDetailsWithABlend)
{
  const Merged merged = SewWavyTubes(6, 0.03);
  const cartan::Points smooth = merged.Faired(6);
  const cartan::Points blended = merged.Blended(6);
  // Rings are .083 apart; the seam and those beside it lose them.
  const double all = Moves(merged, blended, 0.0, 1.0) / Moves(merged, smooth, 0.0, 1.0);
  const double outside = Moves(merged, blended, 0.2, 1.0) / Moves(merged, smooth, 0.2, 1.0);
  ShowFigure("moved by the blend in parts of the thin plate's", all);
  ShowFigure("the same where details are kept", outside);
  EXPECT_LT(all, 0.3);
  EXPECT_LT(outside, 0.3);
}

TEST(SeamFairing, LeavesAPlane)
{
  Shape ring = OpenCylinder(24, 8, 1.0, 1.0);
  for (int v = 0; v < ring.NumberOfVertices(); ++v)
  {
    ring.Positions.row(v).head<2>() *= 1.0 + ring.Positions(v, 2);
    ring.Positions(v, 2) = 0.0;
  }
  Shape inner = ring;
  inner.Positions *= 0.5;
  const Merged merged = Merge(ring, inner, { { inner.NumberOfVertices() - 24, 0 } });
  EXPECT_LT(merged.Faired(2).col(2).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT(merged.Blended(2).col(2).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT(merged.Angles(merged.Blended(2)).Maximum, 1e-9); // nothing is turned over
}

TEST(SeamFairing, MovesTheRingsAlone)
{
  const Merged merged = SewWavyTubes(6, 0.03);
  const std::vector<int> region =
    cartan::GrowByRings(merged.Mesh, cartan::SeamVertices(merged.Joined), 2);
  for (const cartan::Points& points : { merged.Faired(2), merged.Blended(2) })
  {
    for (int v = 0; v < merged.Joined.NumberOfVertices(); ++v)
    {
      if (std::find(region.begin(), region.end(), v) == region.end())
      {
        EXPECT_EQ((points.row(v) - merged.Positions.row(v)).norm(), 0.0) << v;
      }
    }
  }
}

TEST(SeamFairing, GoesWithSimilarities)
{
  Merged merged = SewCaps(3, 3);
  const RigidMotion motion = RandomRigidMotion(7, 5.0);
  const cartan::Points smooth = Transformed(merged.Faired(2), 30.0, motion);
  const cartan::Points blended = Transformed(merged.Blended(2), 30.0, motion);
  merged.Positions = Transformed(merged.Positions, 30.0, motion);
  EXPECT_LT((merged.Faired(2) - smooth).rowwise().norm().maxCoeff(), 1e-9);
  EXPECT_LT((merged.Blended(2) - blended).rowwise().norm().maxCoeff(), 1e-9);
}
