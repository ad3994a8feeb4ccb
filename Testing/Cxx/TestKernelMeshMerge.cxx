// SPDX-License-Identifier: BSD-3-Clause
#include "AdviceWords.h"
#include "MergeShapes.h"

#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Base/Constants.h"
#include "Kernel/Differential/RotationFit.h"
#include "Kernel/Merging/BoundaryFrames.h"
#include "Kernel/Mesh/Geometry.h"

#include <gtest/gtest.h>

namespace
{
using namespace shapes;

constexpr double Degrees = cartan::Pi / 180.0;

/// A tube around the arc of radius 2 from `from` to `to` in radians, with waves along it.
Shape CurvedTube(double from, double to, int along)
{
  PatchOptions options;
  options.CountU = 40;
  options.CountV = along;
  options.PeriodicU = true;
  return Patch(options,
    [&](double u, double v)
    {
      const double angle = from + (to - from) * v;
      const double radius = 0.5 + 0.04 * std::cos(6 * Pi * u) * std::cos(5.0 * angle);
      const double out = 2.0 + radius * std::cos(2 * Pi * u);
      return Eigen::Vector3d(
        out * std::cos(angle), radius * std::sin(2 * Pi * u), -out * std::sin(angle));
    });
}

/// No edge with more than two triangles is a matter of TriangleMesh: it would throw.
void ExpectSewn(const Merged& merged, const Shape& target, const Shape& source, int loops)
{
  const auto euler = [](const Shape& shape)
  {
    const cartan::TriangleMesh mesh = MakeMesh(shape);
    return mesh.NumberOfVertices() - mesh.NumberOfEdges() + mesh.NumberOfTriangles();
  };
  const auto before = cartan::FindBoundaryLoops(MakeMesh(target)).size() +
    cartan::FindBoundaryLoops(MakeMesh(source)).size();
  // Circles that are glued add nothing to Euler's number.
  EXPECT_EQ(merged.EulerNumber(), euler(target) + euler(source));
  EXPECT_EQ(cartan::FindBoundaryLoops(merged.Mesh).size(), before - 2 * loops);
}
}

TEST(BoundaryLoops, RunWithTheSurfaceOnTheirLeft)
{
  const Shape tube = OpenCylinder(10, 4, 1.0, 3.0);
  const auto loops = cartan::FindBoundaryLoops(MakeMesh(tube));
  ASSERT_EQ(loops.size(), 2u);
  for (const cartan::BoundaryLoop& loop : loops)
  {
    ASSERT_EQ(loop.Vertices.size(), 10u);
    EXPECT_EQ(loop.Vertices[0], *std::min_element(loop.Vertices.begin(), loop.Vertices.end()));
    const auto measures = cartan::MeasureLoop(tube.Positions(loop.Vertices, Eigen::all));
    const double z = tube.Positions(loop.Vertices[0], 2);
    EXPECT_NEAR(measures.Length, 20.0 * std::sin(Pi / 10), 1e-13);
    EXPECT_LT((measures.Center - Eigen::Vector3d(0, 0, z)).norm(), 1e-14);
    // Into the surface, seen from the loop: against the outward normal of a lid.
    const double area = 5.0 * std::sin(2 * Pi / 10);
    EXPECT_NEAR(measures.AreaVector[2], z < 1.5 ? area : -area, 1e-13);
  }
  EXPECT_TRUE(cartan::FindBoundaryLoops(MakeMesh(Icosphere(1))).empty());
}

TEST(MatchLoops, DividesLengthsBetweenKeysAlike)
{
  // A square of side 1 and a polygon of unequal segments of lengths 1, 3, 2, 2.
  cartan::Points square(4, 3);
  square << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  cartan::Points other(4, 3);
  other << 0, 0, 0, 1, 0, 0, 1, 3, 0, -1, 3, 0;
  const double last = (other.row(0) - other.row(3)).norm();
  const auto places = cartan::MatchLoops(square, other, { { 2, { 2, 0.0 } }, { 0, { 0, 0.0 } } });
  EXPECT_EQ(places[0].Segment, 0);
  EXPECT_EQ(places[0].Fraction, 0.0);
  EXPECT_EQ(places[1].Segment, 1); // 2 of 4
  EXPECT_NEAR(places[1].Fraction, 1.0 / 3.0, 1e-14);
  EXPECT_EQ(places[2].Segment, 2);
  EXPECT_EQ(places[2].Fraction, 0.0);
  EXPECT_EQ(places[3].Segment, 3); // half of 2 + last
  EXPECT_NEAR(places[3].Fraction, (0.5 * (2.0 + last) - 2.0) / last, 1e-14);
}

TEST(MatchLoops, RefusesKeysThatCross)
{
  const Shape tube = OpenCylinder(12, 3);
  const cartan::Points circle = tube.Positions.topRows<12>();
  const std::string advice = Advice("Exchange or remove keys until the orders agree.");
  try
  {
    cartan::MatchLoops(circle, circle, { { 0, { 0, 0 } }, { 4, { 8, 0 } }, { 8, { 4, 0 } } });
    FAIL();
  }
  catch (const cartan::Error& error)
  {
    EXPECT_NE(std::string(error.what()).find(advice), std::string::npos) << error.what();
  }
  const auto places =
    cartan::MatchLoops(circle, circle, { { 0, { 0, 0 } }, { 4, { 4, 0 } }, { 8, { 8, 0 } } });
  for (int i = 0; i < 12; ++i)
  {
    EXPECT_LT((cartan::PointAt(circle, places[i]) - circle.row(i)).norm(), 1e-14);
  }
}

TEST(FindFirstKey, FindsTheTurnWhateverTheSimilarity)
{
  const auto ellipse = [](int count, double start)
  {
    cartan::Points curve(count, 3);
    for (int i = 0; i < count; ++i)
    {
      const double t = 2 * Pi * (start + i) / count;
      curve.row(i) << 2.0 * std::cos(t), std::sin(t) + 0.3 * std::cos(2 * t), 0.2 * std::cos(2 * t);
    }
    return curve;
  };
  const cartan::Points target = ellipse(60, 0.0);
  for (const int start : { 0, 7, 19, 33 })
  {
    for (unsigned int seed = 1; seed <= 4; ++seed)
    {
      const cartan::Points source =
        Transformed(ellipse(40, start * 40.0 / 60.0), 0.1 * seed, RandomRigidMotion(seed, 5.0));
      const cartan::LoopKey key =
        cartan::FindFirstKey(source, target, cartan::LoopAlignment::BySimilarity);
      EXPECT_LT((cartan::PointAt(target, key.Target) - target.row(start)).norm(), 0.05);
    }
  }
}

TEST(MeshMerge, AgreesWithASecondImplementation)
{
  // Places that no vertex is snapped from, which the other implementation does not do.
  const cartan::MergeInput target = MakeInput(MergeMesh("small-target"));
  const cartan::MergeInput source = MakeInput(MergeMesh("small-source"));
  const std::vector<int> from = cartan::FindBoundaryLoops(*source.Mesh)[0].Vertices;
  std::vector<int> to = cartan::FindBoundaryLoops(*target.Mesh)[1].Vertices;
  std::reverse(to.begin(), to.end());
  std::vector<cartan::LoopKey> keys;
  for (const auto& [a, b] : Keys{ { 0, 6 }, { 36, 27 }, { 72, 48 } })
  {
    keys.push_back({ static_cast<int>(std::find(from.begin(), from.end(), a) - from.begin()),
      { static_cast<int>(std::find(to.begin(), to.end(), b) - to.begin()), 0.0 } });
  }
  const auto curve = [](const cartan::MergeInput& surface, const std::vector<int>& loop)
  {
    return cartan::BoundaryCurve{ (*surface.Positions)(loop, Eigen::all),
      cartan::AngleWeightedNormals(*surface.Mesh, *surface.Positions, loop) };
  };
  const cartan::BoundaryCurve fromCurve = curve(source, from);
  const cartan::BoundaryCurve toCurve = curve(target, to);
  const auto places = cartan::MatchLoops(fromCurve.Positions, toCurve.Positions, keys);
  cartan::HandleProblem problem;
  problem.Mesh = source.Mesh;
  problem.Rest = source.Positions;
  problem.Handle.assign(source.Mesh->NumberOfVertices(), 0);
  problem.Moving = { 1 };
  cartan::HandleTargets targets;
  targets.Motions.resize(1);
  targets.Vertices = from; // they ascend
  targets.Positions.resize(from.size(), 3);
  for (std::size_t i = 0; i < from.size(); ++i)
  {
    problem.Handle[from[i]] = 1;
    targets.Positions.row(i) = cartan::PointAt(toCurve.Positions, places[i]);
  }
  targets.Transforms = cartan::LoopSimilarities(fromCurve, toCurve, places, from);
  cartan::SimilarityDeformer deformer(problem, {});
  deformer.SetReconstruction(cartan::SimilarityReconstruction::LeastSquares);
  deformer.SetScaleFeatures(true);
  cartan::DeformedSurface result;
  deformer.Deform(targets, false, result, {});
  const double distance =
    (result.Positions - MergeMesh("small-result").Positions).rowwise().norm().maxCoeff();
  ShowFigure("largest distance from the other implementation, of a size of 3", distance);
  // It weights Laplacian coordinates by edge lengths instead of areas.
  EXPECT_LT(distance, 0.01);
}

TEST(MeshMerge, SewsTubesOfDifferentLoops)
{
  const MergeCase tubes = TubesCase();
  const Merged merged = Merge(tubes.Target, tubes.Source, tubes.Pairs);
  ExpectSewn(merged, tubes.Target, tubes.Source, 1);
  EXPECT_LE(EdgeChange(tubes.Source, merged.Fit.Positions), 0.052);
  const cartan::SeamAngles angles = merged.Angles();
  EXPECT_LE(angles.Mean, 3.2 * Degrees);
  EXPECT_LE(angles.Maximum, 22.0 * Degrees);
  const cartan::SeamAngles faired = merged.Angles(merged.Faired(2));
  EXPECT_LE(faired.Mean, 2.9 * Degrees);
  EXPECT_LE(faired.Maximum, 8.0 * Degrees);
  ShowFigure("edge change", EdgeChange(tubes.Source, merged.Fit.Positions));
  ShowFigure("seam angle, mean", angles.Mean / Degrees);
  ShowFigure("seam angle, largest", angles.Maximum / Degrees);
  ShowFigure("seam angle after fairing, mean", faired.Mean / Degrees);
  ShowFigure("seam angle after fairing, largest", faired.Maximum / Degrees);
}

TEST(MeshMerge, PutsAHeadOnADinosaur)
{
  const MergeCase head = HeadCase();
  const Merged merged = Merge(head.Target, head.Source, head.Pairs);
  ExpectSewn(merged, head.Target, head.Source, 1);
  const double change = EdgeChange(head.Source, merged.Fit.Positions);
  const cartan::SeamAngles angles = merged.Angles();
  const cartan::SeamAngles faired = merged.Angles(merged.Faired(2));
  ShowFigure("points of the source", head.Source.NumberOfVertices());
  ShowFigure("points of the target", head.Target.NumberOfVertices());
  ShowFigure("edge change", change);
  ShowFigure("seam angle, mean", angles.Mean / Degrees);
  ShowFigure("seam angle, largest", angles.Maximum / Degrees);
  ShowFigure("seam angle after fairing, mean", faired.Mean / Degrees);
  ShowFigure("seam angle after fairing, largest", faired.Maximum / Degrees);
  EXPECT_LE(change, 0.063);
  EXPECT_LE(faired.Mean, 2.3 * Degrees);
  EXPECT_LE(faired.Maximum, 10.5 * Degrees);
}

TEST(MeshMerge, DoesNotDependOnTheSimilarityOfTheSource)
{
  const Shape target = MergeMesh("small-target");
  Shape source = MergeMesh("small-source");
  const Keys keys = { { 0, 6 }, { 36, 27 }, { 72, 48 } };
  const Merged reference = Merge(target, source, keys);
  const double size = cartan::BoundingDiagonal(reference.Fit.Positions);
  const cartan::Points rest = source.Positions;
  for (unsigned int seed = 1; seed <= 20; ++seed)
  {
    const double scale = std::pow(10.0, -2.0 + 4.0 * (seed - 1) / 19.0);
    source.Positions = Transformed(rest, scale, RandomRigidMotion(seed, 3.0));
    const Merged merged = Merge(target, source, keys);
    EXPECT_LT(
      (merged.Fit.Positions - reference.Fit.Positions).rowwise().norm().maxCoeff(), 1e-10 * size)
      << "seed " << seed;
  }
}

TEST(MeshMerge, IsTheSimilarityThatFitsExactly)
{
  const Shape target = OpenCylinder(16, 5, 1.0, 2.0);
  Shape source = target;
  source.Positions.rowwise() += Eigen::RowVector3d(0, 0, 2.0);
  const cartan::Points expected = source.Positions;
  source.Positions = Transformed(expected, 0.3, RandomRigidMotion(5, 4.0));
  // The source's lower loop begins with its first point.
  const Merged merged = Merge(target, source, { { 0, target.NumberOfVertices() - 16 } });
  EXPECT_LT((merged.Fit.Positions - expected).rowwise().norm().maxCoeff(), 1e-12);
  EXPECT_LT(merged.Angles().Maximum, 1e-10);
  EXPECT_EQ(merged.Joined.NumberOfVertices(), 2 * target.NumberOfVertices() - 16);
}

TEST(MeshMerge, SewsATubeThatWasCutInTwo)
{
  const Shape target = CurvedTube(0.0, 0.75, 40);
  Shape source = CurvedTube(0.75, 1.5, 40);
  const cartan::Points expected = source.Positions;
  source.Positions = Transformed(expected, 2.0, RandomRigidMotion(3, 4.0));
  const int ring = target.NumberOfVertices() - 40;
  const Merged merged = Merge(target, source, { { 0, ring } });
  const double distance = (merged.Fit.Positions - expected).rowwise().norm().maxCoeff();
  ShowFigure("largest distance, of a size of 3", distance);
  EXPECT_LT(distance, 0.0046 * 3.0);
  const cartan::Matrices rotations =
    cartan::FitRotations(MakeMesh(source), expected, merged.Fit.Positions);
  double largest = 0.0;
  for (Eigen::Index v = 0; v < rotations.rows(); ++v)
  {
    const double cosine = 0.5 * (cartan::MatrixAt(rotations, v).trace() - 1.0);
    largest = std::max(largest, std::acos(std::min(1.0, std::max(-1.0, cosine))));
  }
  ShowFigure("largest rotation, degrees", largest / Degrees);
  EXPECT_LT(largest, 2.7 * Degrees);
}

TEST(MeshMerge, TurnsBoundariesWhenFeaturesAreHeld)
{
  // A gap of .35 with a tilt of 25 degrees; the far end of the source is held.
  const Shape target = OpenCylinder(32, 12, 1.0, 3.0);
  Shape source = target;
  const Eigen::Matrix3d tilt =
    Eigen::AngleAxisd(25.0 * Degrees, Eigen::Vector3d::UnitX()).toRotationMatrix();
  source.Positions = (source.Positions * tilt.transpose()).rowwise() +
    Eigen::RowVector3d(0, 0, 3.35 + std::sin(25.0 * Degrees));
  std::vector<cartan::SourceHold> holds(source.NumberOfVertices());
  std::fill(holds.end() - 3 * 32, holds.end(), cartan::SourceHold::Kept);
  const Merged merged = Merge(target, source, { { 0, target.NumberOfVertices() - 32 } }, holds);
  for (int v = source.NumberOfVertices() - 3 * 32; v < source.NumberOfVertices(); ++v)
  {
    EXPECT_EQ((merged.Fit.Positions.row(v) - source.Positions.row(v)).norm(), 0.0);
  }
  ShowFigure("seam angle, mean", merged.Angles().Mean / Degrees);
  EXPECT_LT(merged.Angles().Mean, 3.3 * Degrees);
}

TEST(PairLoops, FindsTheLoopsThatLieAlike)
{
  // A tube whose ends differ.
  Shape target = OpenCylinder(12, 5, 1.0, 2.0);
  for (int v = 0; v < target.NumberOfVertices(); ++v)
  {
    target.Positions.row(v).head<2>() *= 1.0 + 0.5 * target.Positions(v, 2);
  }
  // A band around it that joins both ends, its outside away from the tube.
  Shape source = target;
  for (int v = 0; v < source.NumberOfVertices(); ++v)
  {
    const double z = source.Positions(v, 2);
    source.Positions.row(v).head<2>() *= 1.0 + z * (2.0 - z);
  }
  source = Inverted(source);
  const cartan::Points rest = source.Positions;
  source.Positions = Transformed(rest, 3.0, RandomRigidMotion(2, 5.0));
  const Merged merged = Merge(target, source, {});
  ExpectSewn(merged, target, source, 2);
  EXPECT_TRUE(cartan::FindBoundaryLoops(merged.Mesh).empty());
  EXPECT_EQ(merged.EulerNumber(), 0);
  // Each loop lies where it was before the similarity.
  for (const cartan::SeamLoop& loop : merged.Fit.Loops)
  {
    for (const int v : loop.Source)
    {
      EXPECT_NEAR(merged.Fit.Positions(v, 2), rest(v, 2), 1e-9);
    }
  }
}
