// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Differential/FrameReconstruction.h"
#include "Kernel/Measure/ComponentVolumes.h"
#include "Kernel/Mesh/Geometry.h"
#include "Kernel/Morph/DiscreteFormsMorph.h"
#include "Kernel/Morph/IsometricMorph.h"
#include "Kernel/Morph/MorphVolume.h"
#include "Kernel/Morph/PyramidCoordinatesMorph.h"
#include "Kernel/Morph/RigidPlacement.h"
#include "Kernel/Morph/TriangleGradientMorph.h"
#include "MorphShapes.h"
#include "RealMeshes.h"

#include <gtest/gtest.h>

#include <chrono>

using cartan::DiscreteFormsMorph;
using cartan::KeyFrames;
using cartan::Points;
using cartan::RigidPlacement;
using cartan::SurfaceMorph;
using cartan::TriangleGradientMorph;
using Eigen::Vector3d;
using morphshapes::Keys;
using morphshapes::MeasureMorph;
using morphshapes::MorphFigures;
using shapes::Pi;
using shapes::Shape;
using shapes::ShowFigure;

namespace
{
using Solver = DiscreteFormsMorph::FrameSolver;
using Transitions = DiscreteFormsMorph::Transitions;

struct Method
{
  std::string Name;
  std::function<std::unique_ptr<SurfaceMorph>(const KeyFrames&)> Make;
  bool IsSymmetricForManyKeys = true;
};

std::vector<Method> Methods()
{
  const auto forms = [](Transitions transitions, Solver solver)
  {
    return [=](const KeyFrames& keys) -> std::unique_ptr<SurfaceMorph>
    { return std::make_unique<DiscreteFormsMorph>(keys, transitions, solver); };
  };
  return {
    { "transitions", forms(Transitions::Rotations, Solver::RotationAveraging) },
    { "forms", forms(Transitions::Forms, Solver::RotationAveraging) },
    { "conjugate gradients", forms(Transitions::Rotations, Solver::ConjugateGradients) },
    { "direct", forms(Transitions::Forms, Solver::Direct) },
    { "isometric",
      [](const KeyFrames& keys) -> std::unique_ptr<SurfaceMorph>
      { return std::make_unique<cartan::IsometricMorph>(keys); } },
    { "deformation gradient",
      [](const KeyFrames& keys) -> std::unique_ptr<SurfaceMorph>
      { return std::make_unique<TriangleGradientMorph>(keys); },
      false },
    { "pyramid coordinates",
      [](const KeyFrames& keys) -> std::unique_ptr<SurfaceMorph>
      { return std::make_unique<cartan::PyramidCoordinatesMorph>(keys); } },
  };
}

/// What a user sees: the in-between in its place.
Points Placed(const KeyFrames& keys, SurfaceMorph& morph, double t)
{
  Points positions = morph.Evaluate(t, {});
  RigidPlacement(keys, Eigen::VectorXd::Ones(positions.rows())).Place(t, positions);
  return positions;
}

double Distance(const Points& a, const Points& b)
{
  return (a - b).rowwise().norm().maxCoeff();
}

KeyFrames Reversed(KeyFrames keys)
{
  std::reverse(keys.Positions.begin(), keys.Positions.end());
  std::vector<double> parameters;
  for (auto t = keys.Parameters.rbegin(); t != keys.Parameters.rend(); ++t)
  {
    parameters.push_back(1.0 - *t);
  }
  keys.Parameters = parameters;
  return keys;
}

/// Surfaces with boundary, closed, of two components, noisy; two to three keys.
std::vector<std::pair<std::string, KeyFrames>> Cases()
{
  const Shape bar = shapes::Bar(4, 4, 24, { 1, 1, 6 });
  const Shape plane = shapes::Plane(9, 1.0, 0.25);
  Shape rolled = plane;
  for (int v = 0; v < rolled.NumberOfVertices(); ++v)
  {
    const Vector3d x = plane.Positions.row(v);
    rolled.Positions.row(v) << std::sin(3 * x[0]) / 3, x[1], (1 - std::cos(3 * x[0])) / 3;
  }
  const Shape torus = shapes::Torus(24, 12, 2.0, 0.7, 0.2);
  Shape squashed = torus;
  squashed.Positions.col(2) *= 1.5;
  squashed.Positions.col(0) += 0.3 * torus.Positions.col(2).cwiseAbs2();
  const Shape both = shapes::Union(torus, plane);
  return {
    { "bent bar", Keys(bar, { bar.Positions, morphshapes::Bend(bar, 120, 1, 5) }) },
    { "twisted bar", Keys(bar, { bar.Positions, morphshapes::Twist(bar, 150, 1, 5) }) },
    { "rolled plane", Keys(plane, { plane.Positions, rolled.Positions }) },
    { "squashed torus", Keys(torus, { torus.Positions, squashed.Positions }) },
    { "two components", Keys(both, { both.Positions, shapes::Union(squashed, rolled).Positions }) },
    { "three keys",
      Keys(bar,
        { bar.Positions, morphshapes::Twist(bar, 60, 1, 5), morphshapes::Bend(bar, 90, 1, 5) }) },
  };
}
}

TEST(SurfaceMorph, GivesTheKeyFramesBack)
{
  for (const auto& [name, keys] : Cases())
  {
    for (const Method& method : Methods())
    {
      const auto morph = method.Make(keys);
      for (std::size_t k = 0; k < keys.Positions.size(); ++k)
      {
        EXPECT_LT(Distance(Placed(keys, *morph, keys.Parameters[k]), keys.Positions[k]),
          1e-9 * cartan::BoundingDiagonal(keys.Positions[k]))
          << name << ", " << method.Name << ", key frame " << k;
      }
      // A hair beside them as well: nothing jumps there.
      EXPECT_LT(Distance(Placed(keys, *morph, 1e-7), keys.Positions.front()), 1e-5)
        << name << ", " << method.Name;
      EXPECT_LT(Distance(Placed(keys, *morph, 1 - 1e-7), keys.Positions.back()), 1e-5)
        << name << ", " << method.Name;
    }
  }
}

TEST(SurfaceMorph, IsTheSameBackwards)
{
  for (const auto& [name, keys] : Cases())
  {
    const KeyFrames reversed = Reversed(keys);
    for (const Method& method : Methods())
    {
      if (keys.Positions.size() > 2 && !method.IsSymmetricForManyKeys)
      {
        continue;
      }
      const auto forwards = method.Make(keys);
      const auto backwards = method.Make(reversed);
      for (const double t : { 0.2, 0.5, 0.9 })
      {
        EXPECT_LT(Distance(Placed(keys, *forwards, t), Placed(reversed, *backwards, 1 - t)), 1e-8)
          << name << ", " << method.Name << ", t " << t;
      }
    }
  }
}

TEST(SurfaceMorph, DoesNotSeeRigidMotionsOfKeyFrames)
{
  for (const auto& [name, keys] : Cases())
  {
    if (name == "two components")
    {
      continue; // each has a place of its own
    }
    KeyFrames moved = keys;
    for (std::size_t k = 0; k < keys.Positions.size(); ++k)
    {
      moved.Positions[k] = shapes::RandomRigidMotion(5 + k, 3.0)(keys.Positions[k]);
    }
    for (const Method& method : Methods())
    {
      const auto still = method.Make(keys);
      const auto morph = method.Make(moved);
      for (const double t : { 0.3, 0.7 })
      {
        const Points expected = still->Evaluate(t, {});
        const Points found = morph->Evaluate(t, {});
        EXPECT_LT(Distance(shapes::BestRigidMotion(found, expected)(found), expected), 1e-8)
          << name << ", " << method.Name << ", t " << t;
      }
    }
  }
}

TEST(SurfaceMorph, MovesRigidlyBetweenRigidlyMovedKeyFrames)
{
  const Shape torus = shapes::Torus(24, 12);
  shapes::RigidMotion motion;
  motion.Rotation = Eigen::AngleAxisd(2.5, Vector3d(1, 2, 2) / 3.0).matrix();
  motion.Translation = Vector3d(1, 2, 3);
  const KeyFrames keys = Keys(torus, { torus.Positions, motion(torus.Positions) });
  for (const Method& method : Methods())
  {
    const auto morph = method.Make(keys);
    for (const double t : { 0.25, 0.5, -0.5, 1.25 })
    {
      // The torus's center is the origin.
      shapes::RigidMotion part;
      part.Rotation = Eigen::AngleAxisd(2.5 * t, Vector3d(1, 2, 2) / 3.0).matrix();
      part.Translation = t * motion.Translation;
      EXPECT_LT(Distance(Placed(keys, *morph, t), part(torus.Positions)), 1e-8)
        << method.Name << ", t " << t;
    }
  }
}

TEST(SurfaceMorph, GrowsEvenlyBetweenASurfaceAndItsEnlargement)
{
  const Shape torus = shapes::Torus(24, 12);
  const KeyFrames keys = Keys(torus, { torus.Positions, 3.0 * torus.Positions });
  for (const Method& method : Methods())
  {
    const auto morph = method.Make(keys);
    EXPECT_LT(Distance(Placed(keys, *morph, 0.25), 1.5 * torus.Positions), 1e-8) << method.Name;
    EXPECT_LT(Distance(Placed(keys, *morph, 1.5), 4.0 * torus.Positions), 1e-8) << method.Name;
  }
}

TEST(SurfaceMorph, StaysWhereKeyFramesCoincide)
{
  const Shape bar = shapes::Noisy(shapes::Bar(4, 4, 12, { 1, 1, 3 }), 0.03);
  const Points bent = morphshapes::Bend(bar, 90, 0.5, 2.5);
  const KeyFrames keys = Keys(bar, { bar.Positions, bar.Positions, bent, bent });
  for (const Method& method : Methods())
  {
    const auto morph = method.Make(keys);
    EXPECT_LT(Distance(Placed(keys, *morph, 0.2), bar.Positions), 1e-9) << method.Name;
    EXPECT_LT(Distance(Placed(keys, *morph, 0.9), bent), 1e-8) << method.Name;
  }
}

TEST(SurfaceMorph, DoesNotDependOnTheUnitOfLength)
{
  for (const auto& [name, keys] : Cases())
  {
    for (const double unit : { 1e-6, 1e6 })
    {
      KeyFrames scaled = keys;
      for (Points& positions : scaled.Positions)
      {
        positions *= unit;
      }
      for (const Method& method : Methods())
      {
        EXPECT_LT(Distance(Placed(scaled, *method.Make(scaled), 0.4) / unit,
                    Placed(keys, *method.Make(keys), 0.4)),
          1e-8)
          << name << ", " << method.Name;
      }
    }
  }
}

TEST(DiscreteFormsMorph, SolversOfTheLinearSystemAgree)
{
  for (const auto& [name, keys] : Cases())
  {
    for (const Transitions transitions : { Transitions::Rotations, Transitions::Forms })
    {
      DiscreteFormsMorph direct(keys, transitions, Solver::Direct);
      DiscreteFormsMorph gradients(keys, transitions, Solver::ConjugateGradients);
      DiscreteFormsMorph averaged(keys, transitions);
      for (const double t : { 0.25, 0.5 })
      {
        const Points expected = Placed(keys, direct, t);
        EXPECT_LT(Distance(Placed(keys, gradients, t), expected), 1e-7) << name;
        EXPECT_LT(gradients.GetNumberOfIterations(), 60) << name;
        // Another minimum, but of nearly the same.
        EXPECT_LT(Distance(Placed(keys, averaged, t), expected), 0.02) << name;
      }
    }
  }
}

TEST(DiscreteFormsMorph, FindsTheSameFromEveryStart)
{
  const Shape bar = shapes::Bar(4, 4, 32, { 1, 1, 8 });
  const KeyFrames keys = Keys(bar, { bar.Positions, morphshapes::Twist(bar, 540, 1, 7) });
  DiscreteFormsMorph fresh(keys);
  const Points expected = Placed(keys, fresh, 0.55);
  DiscreteFormsMorph played(keys);
  for (const double t : { 0.9, 0.1, 0.3, 0.5 })
  {
    Placed(keys, played, t);
  }
  EXPECT_LT(Distance(Placed(keys, played, 0.55), expected), 1e-8);
  EXPECT_EQ(played.GetWarning(), "");
}

TEST(DiscreteFormsMorph, ReachesThePublishedFiguresOfVolumeAndEdges)
{
  // Volume ratio and edge deviation (rms) at t = 0.5 of an independent
  // implementation, with frames of the 3n x 3n system projected on rotations.
  const Shape bar = shapes::Bar(6, 6, 48, { 1, 1, 8 });
  struct Row
  {
    std::string Name;
    Points End;
    Transitions Method;
    double Volume;
    double Edges;
  };
  const Points twist170 = morphshapes::Twist(bar, 170, 1, 7);
  const Points twist720 = morphshapes::Twist(bar, 720, 1, 7);
  const Points bend300 = morphshapes::Bend(bar, 300, 1, 7);
  for (const Row& row : { Row{ "twist 170, forms", twist170, Transitions::Forms, 1.008, .0022 },
         Row{ "twist 170, transitions", twist170, Transitions::Rotations, 1.005, .0020 },
         Row{ "twist 720, forms", twist720, Transitions::Forms, 1.120, .052 },
         Row{ "twist 720, transitions", twist720, Transitions::Rotations, 1.126, .035 },
         Row{ "bend 300, forms", bend300, Transitions::Forms, 1.013, .0046 },
         Row{ "bend 300, transitions", bend300, Transitions::Rotations, 1.009, .0039 } })
  {
    const KeyFrames keys = Keys(bar, { bar.Positions, row.End });
    DiscreteFormsMorph morph(keys, row.Method);
    const MorphFigures figures = MeasureMorph(keys, morph.Evaluate(0.5, {}), 0.5);
    ShowFigure(row.Name + ", volume", figures.Volume);
    ShowFigure(row.Name + ", edges", figures.EdgeRms);
    EXPECT_LT(std::abs(figures.Volume - 1.0), 1.15 * (row.Volume - 1.0)) << row.Name;
    EXPECT_LT(figures.EdgeRms, 1.15 * row.Edges) << row.Name;
  }
}

TEST(DiscreteFormsMorph, KeepsVolumeAndEdgesThroughOneAndAHalfLaps)
{
  const Shape bar = shapes::Bar(8, 8, 64, { 1, 1, 8 });
  const KeyFrames keys = Keys(bar, { bar.Positions, morphshapes::Twist(bar, 540, 1, 7) });
  DiscreteFormsMorph morph(keys);
  const cartan::MorphVolume volume(keys);
  EXPECT_EQ(volume.GetWarning(), "");
  double worstVolume = 0.0;
  double worstEdges = 0.0;
  double worstClosedEdges = 0.0;
  for (int step = 1; step < 16; ++step)
  {
    const double t = step / 16.0;
    Points positions = morph.Evaluate(t, {});
    const MorphFigures figures = MeasureMorph(keys, positions, t);
    worstVolume = std::max(worstVolume, std::abs(figures.Volume - 1.0));
    worstEdges = std::max(worstEdges, figures.EdgeRms);
    EXPECT_EQ(volume.Close(t, positions), "");
    const MorphFigures closed = MeasureMorph(keys, positions, t);
    EXPECT_NEAR(closed.Volume, 1.0, 1e-9);
    worstClosedEdges = std::max(worstClosedEdges, closed.EdgeRms);
  }
  ShowFigure("volume, at worst", worstVolume);
  ShowFigure("edges, at worst", worstEdges);
  ShowFigure("edges with the volume closed, at worst", worstClosedEdges);
  EXPECT_LT(worstVolume, 0.07);
  EXPECT_LT(worstEdges, 0.035);
  EXPECT_LT(worstClosedEdges, 0.04);
  cartan::IsometricMorph isometric(keys);
  const MorphFigures byHinges = MeasureMorph(keys, isometric.Evaluate(0.5, {}), 0.5);
  ShowFigure("isometric, volume", byHinges.Volume);
  ShowFigure("isometric, edges", byHinges.EdgeRms);
  EXPECT_NEAR(byHinges.Volume, 1.0, 0.07);
  EXPECT_LT(byHinges.EdgeRms, 0.035);
  EXPECT_EQ(isometric.GetWarning(), "");
  const Points middle = 0.5 * (keys.Positions[0] + keys.Positions[1]);
  EXPECT_LT(MeasureMorph(keys, middle, 0.5).Volume, 0.55); // what linear interpolation makes
}

TEST(DiscreteFormsMorph, WindsAndUnwindsEvenly)
{
  // The turn of the bar's end against its start, full turns counted along the bar, is
  // nearly t times that at the end; not quite, because the lengths of its edges,
  // which grow with the square of the turn, go evenly as well.
  const Shape bar = shapes::Bar(4, 4, 64, { 1, 1, 16 });
  const KeyFrames keys = Keys(bar, { bar.Positions, morphshapes::Twist(bar, 900, 1, 15) });
  DiscreteFormsMorph morph(keys);
  for (const double t : { 0.25, 0.5, 0.75 })
  {
    const Points positions = morph.Evaluate(t, {});
    EXPECT_NEAR(morphshapes::TotalTwist(bar, positions), 900 * t, 15.0) << t;
  }
}

TEST(DiscreteFormsMorph, MorphsAScanBetweenPoses)
{
  const Shape camel = shapes::RealMesh("camel");
  const Points bent = morphshapes::BendAlong(camel, 1, 100);
  const KeyFrames keys = Keys(camel, { camel.Positions, bent });
  DiscreteFormsMorph morph(keys);
  for (const double t : { 0.25, 0.5, 0.75 })
  {
    const MorphFigures figures = MeasureMorph(keys, morph.Evaluate(t, {}), t);
    const MorphFigures linear =
      MeasureMorph(keys, (1 - t) * keys.Positions[0] + t * keys.Positions[1], t);
    ShowFigure("camel, volume", figures.Volume);
    ShowFigure("camel, edges", figures.EdgeRms);
    ShowFigure("camel, steps", morph.GetNumberOfIterations());
    EXPECT_NEAR(figures.Volume, 1.0, 0.02);
    EXPECT_LT(figures.EdgeRms, 0.01);
    EXPECT_GT(linear.EdgeRms, 5 * figures.EdgeRms);
    EXPECT_EQ(morph.GetWarning(), "");
  }
}

TEST(DiscreteFormsMorph, RefusesToGoWhereLengthsAreNegative)
{
  const Shape torus = shapes::Torus(12, 8);
  const KeyFrames keys = Keys(torus, { torus.Positions, 3.0 * torus.Positions });
  DiscreteFormsMorph morph(keys);
  try
  {
    morph.Evaluate(-2.0, {});
    FAIL() << "no error";
  }
  catch (const cartan::Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("negative length"), std::string::npos) << error.what();
  }
}

TEST(TriangleGradientMorph, BendsWithoutLossUpToThreeQuartersOfALap)
{
  const Shape bar = shapes::Bar(6, 6, 48, { 1, 1, 8 });
  for (const double angle : { 90.0, 170.0, 270.0 })
  {
    const KeyFrames keys = Keys(bar, { bar.Positions, morphshapes::Bend(bar, angle, 1, 7) });
    TriangleGradientMorph morph(keys);
    const MorphFigures figures = MeasureMorph(keys, morph.Evaluate(0.5, {}), 0.5);
    ShowFigure("bend, volume", figures.Volume);
    ShowFigure("bend, edges", figures.EdgeRms);
    EXPECT_NEAR(figures.Volume, 1.0, 0.01) << angle;
    EXPECT_LT(figures.EdgeRms, 0.01) << angle;
  }
}

TEST(TriangleGradientMorph, FillsTrianglesWithoutAreaFromTheirNeighbors)
{
  Shape bar = shapes::Bar(4, 4, 12, { 1, 1, 3 });
  // A triangle of this side collapses in the second key frame.
  KeyFrames keys = Keys(bar, { bar.Positions, morphshapes::Bend(bar, 90, 0.5, 2.5) });
  const Eigen::RowVector3i face = bar.Faces.row(60);
  keys.Positions[1].row(face[0]) =
    0.5 * (keys.Positions[1].row(face[1]) + keys.Positions[1].row(face[2]));
  TriangleGradientMorph morph(keys);
  EXPECT_TRUE(morph.Evaluate(0.5, {}).allFinite());
  EXPECT_LT(Distance(Placed(keys, morph, 1.0), keys.Positions[1]), 1e-9);
}

TEST(RigidPlacement, KeepsWeightedPointsInPlace)
{
  // One end of the bar is the same in both key frames: pinned, it stays.
  const Shape bar = shapes::Bar(4, 4, 24, { 1, 1, 6 });
  const KeyFrames keys = Keys(bar, { bar.Positions, morphshapes::Bend(bar, 170, 1.5, 5) });
  DiscreteFormsMorph morph(keys);
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(bar.NumberOfVertices());
  for (int v = 0; v < bar.NumberOfVertices(); ++v)
  {
    weights[v] = bar.Positions(v, 2) < 1.0;
  }
  Points positions = morph.Evaluate(0.5, {});
  RigidPlacement(keys, weights).Place(0.5, positions);
  double worst = 0.0;
  for (int v = 0; v < bar.NumberOfVertices(); ++v)
  {
    worst = std::max(worst, weights[v] * (positions.row(v) - bar.Positions.row(v)).norm());
  }
  ShowFigure("pinned end moves by", worst);
  EXPECT_LT(worst, 0.01);
}

TEST(MorphVolume, LeavesOpenSurfacesAlone)
{
  const Shape plane = shapes::Plane(6);
  const Shape bar = shapes::Bar(3, 3, 3, { 1, 1, 1 });
  const Shape both = shapes::Union(plane, bar);
  KeyFrames keys = Keys(both, { both.Positions, 2.0 * both.Positions });
  const cartan::MorphVolume volume(keys);
  EXPECT_NE(volume.GetWarning().find("1 open component (id 0)"), std::string::npos)
    << volume.GetWarning();
  Points positions = 1.1 * both.Positions;
  EXPECT_EQ(volume.Close(0.5, positions), "");
  EXPECT_EQ(Points(positions.topRows(plane.NumberOfVertices())), Points(1.1 * plane.Positions));
  const auto components = cartan::MeasureComponents(*keys.Mesh, positions);
  EXPECT_NEAR(components[1].Volume, 4.5, 1e-9);
}
