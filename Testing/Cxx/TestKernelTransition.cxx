// SPDX-License-Identifier: BSD-3-Clause
#include "AdviceWords.h"
#include "MergeShapes.h"

#include "Kernel/Base/Constants.h"
#include "Kernel/Merging/Transition.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace
{
using namespace shapes;

/// A tube of radius 1 with `waves` waves of height `height` around it, from z = `from` on.
Shape Relief(int around, int along, double from, double length, int waves, double height)
{
  Shape tube = OpenCylinder(around, along, 1.0, length, 0.2);
  for (int v = 0; v < tube.NumberOfVertices(); ++v)
  {
    const double angle = std::atan2(tube.Positions(v, 1), tube.Positions(v, 0));
    tube.Positions.row(v).head<2>() *= 1.0 + height * std::cos(waves * angle);
    tube.Positions(v, 2) += from;
  }
  return tube;
}

/// Two surfaces with one loop or two, keys at the ends of both, and a transition.
struct Faded : Merged
{
  cartan::Fading Fading;
};

Faded Fade(const Shape& target, const Shape& source, const Keys& keys,
  const cartan::TransitionWidths& widths, const std::vector<cartan::SourceHold>& holds = {})
{
  Sides sides(target, source, keys);
  const cartan::PairedLoops paired =
    cartan::PairLoops(sides.Target, sides.Source, cartan::LoopAlignment::BySimilarity);
  std::vector<std::vector<int>> loops;
  for (const cartan::LoopPair& pair : paired.Pairs)
  {
    loops.push_back(pair.Source);
  }
  const cartan::Transition transition(sides.Target.Surface, paired.Pairs, widths);
  const cartan::CutSurface& cut = transition.GetCut();
  const cartan::MeshMerge merge(sides.Source.Surface, loops, holds);
  Faded faded;
  faded.Fit =
    merge.Fit({ cut.Mesh, cut.Positions }, transition.GetPairs(), transition.MoveKeys(paired.Keys));
  faded.Joined = cartan::JoinSurfaces(*cut.Mesh, *sides.Source.Surface.Mesh, faded.Fit.Loops);
  faded.Positions = cartan::JoinedPositions(faded.Joined, *cut.Positions, faded.Fit.Positions);
  faded.Mesh = cartan::TriangleMesh(faded.Joined.NumberOfVertices(), faded.Joined.Faces);
  faded.Fading = transition.Fade(
    *sides.Source.Surface.Mesh, faded.Fit, holds, faded.Joined, faded.Mesh, faded.Positions);
  return faded;
}

/// The heights of two kinds of waves around the z axis at points between two z.
Eigen::Vector2d WaveHeights(
  const Faded& faded, const Eigen::Vector2d& waves, double from, double to)
{
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d products = Eigen::Vector3d::Zero();
  for (int v = 0; v < faded.Mesh.NumberOfVertices(); ++v)
  {
    const auto p = faded.Positions.row(v);
    if (faded.Mesh.IsUsed(v) && p[2] >= from && p[2] < to)
    {
      const double angle = std::atan2(p[1], p[0]);
      const Eigen::Vector3d model(1.0, std::cos(waves[0] * angle), std::cos(waves[1] * angle));
      squares += model * model.transpose();
      products += p.head<2>().norm() * model;
    }
  }
  return Eigen::Vector3d(squares.ldlt().solve(products)).tail<2>();
}
}

TEST(CutBelow, DividesASurface)
{
  const Shape plane = Plane(12, 2.0, 0.3);
  const cartan::TriangleMesh mesh = MakeMesh(plane);
  const Eigen::VectorXd values =
    plane.Positions.col(0) + 0.37 * plane.Positions.col(1).cwiseProduct(plane.Positions.col(0));
  for (const double level : { 0.2, 0.51, 0.9 })
  {
    const cartan::CutSurface above = cartan::CutBelow(mesh, plane.Positions, values, level);
    const cartan::CutSurface below = cartan::CutBelow(mesh, plane.Positions, -values, -level);
    // Each is a disk, and together they are the whole.
    EXPECT_NEAR(Area(*above.Positions, above.Mesh->GetTriangles()) +
        Area(*below.Positions, below.Mesh->GetTriangles()),
      Area(plane.Positions, plane.Faces), 1e-12);
    EXPECT_EQ(cartan::FindBoundaryLoops(*above.Mesh).size(), 1u);
    ASSERT_EQ(
      above.OriginalFaces.size(), static_cast<std::size_t>(above.Mesh->NumberOfTriangles()));
    const Eigen::VectorXd there = cartan::AtPlaces(values, above.Places);
    double shortest = 1.0;
    for (int v = 0; v < above.Mesh->NumberOfVertices(); ++v)
    {
      if (above.Mesh->IsUsed(v))
      {
        EXPECT_GE(there[v], level - 0.06);
        EXPECT_TRUE(!above.IsOnIsoline[v] || std::abs(there[v] - level) < 0.06);
      }
      for (int d = above.Mesh->RingBegin(v); d < above.Mesh->RingEnd(v); ++d)
      {
        shortest = std::min(shortest,
          (above.Positions->row(v) - above.Positions->row(above.Mesh->Neighbor(d))).norm());
      }
    }
    EXPECT_GT(shortest, 0.01); // of edges of .17
  }
}

TEST(TransitionBands, KnowTheAngleAndFindPlaces)
{
  const Shape tube = Relief(24, 12, 0.0, 2.0, 3, 0.0);
  const cartan::TriangleMesh mesh = MakeMesh(tube);
  const std::vector<int> loop = cartan::FindBoundaryLoops(mesh)[0].Vertices;
  const auto bands = cartan::FindBands(mesh, tube.Positions, { loop }, 1.1, "target");
  Eigen::VectorXd turns(tube.NumberOfVertices());
  for (int v = 0; v < tube.NumberOfVertices(); ++v)
  {
    turns[v] = std::atan2(tube.Positions(v, 1), tube.Positions(v, 0)) / (2.0 * Pi);
    EXPECT_EQ(bands.LoopOf[v], tube.Positions(v, 2) < 1.1 - 1e-9 ? 0 : -1);
  }
  Eigen::VectorXd loopTurns(24);
  for (int i = 0; i < 24; ++i)
  {
    loopTurns[i] = turns[loop[i]];
  }
  const auto band = cartan::FindCoordinates(mesh, tube.Positions, bands, 0, loop, loopTurns);
  const auto size = static_cast<Eigen::Index>(band.Vertices.size());
  Eigen::VectorXd angles(size);
  Eigen::VectorXd distances(size);
  for (Eigen::Index i = 0; i < size; ++i)
  {
    const int v = band.Vertices[i];
    EXPECT_NEAR(cartan::TurnBetween(band.Angles[v], turns[v]), 0.0, 0.02); // of 1/24
    angles[i] = band.Angles[v];
    distances[i] = bands.Distances[v];
  }
  // A vertex is found at its own coordinates.
  const auto places = cartan::PlacesInBand(band, bands.Distances, angles, distances);
  const cartan::Points there = cartan::AtPlaces(tube.Positions, places);
  for (Eigen::Index i = 0; i < size; ++i)
  {
    EXPECT_LT((there.row(i) - tube.Positions.row(band.Vertices[i])).norm(), 1e-9);
  }
}

TEST(Transition, FadesOneReliefIntoTheOther)
{
  constexpr double Height = 0.03;
  const Shape target = Relief(64, 48, 0.0, 4.0, 8, Height);
  Shape source = Relief(72, 48, 2.0, 4.0, 5, Height);
  source.Positions = Transformed(source.Positions, 0.4, RandomRigidMotion(4, 3.0));
  const Faded faded = Fade(target, source, { { 0, target.NumberOfVertices() - 64 } }, { 2.0, 2.0 });
  EXPECT_EQ(cartan::FindBoundaryLoops(faded.Mesh).size(), 2u);
  EXPECT_EQ(faded.EulerNumber(), 0);
  Eigen::Vector2d before(Height, 0.0);
  constexpr int Bins = 8;
  for (int bin = 0; bin < Bins; ++bin)
  {
    const double from = 2.0 + 2.0 * bin / Bins;
    const Eigen::Vector2d heights = WaveHeights(faded, { 8, 5 }, from, from + 2.0 / Bins);
    ShowFigure("height of the target's waves", heights[0] / Height);
    ShowFigure("height of the source's waves", heights[1] / Height);
    EXPECT_LT(heights[0], before[0]) << bin;
    EXPECT_GT(heights[1], before[1]) << bin;
    before = heights;
  }
  const Eigen::Vector2d below = WaveHeights(faded, { 8, 5 }, 1.0, 2.0) / Height;
  EXPECT_NEAR(below[0], 1.0, 0.01);
  EXPECT_NEAR(below[1], 0.0, 0.01);
  const Eigen::Vector2d above = WaveHeights(faded, { 8, 5 }, 4.0, 5.0) / Height;
  EXPECT_NEAR(above[0], 0.0, 0.02);
  EXPECT_GT(above[1], before[1] / Height);
}

TEST(Transition, ChangesNothingWhereBothAgree)
{
  // The isoline goes through a ring of points, and so do those of the source.
  const Shape target = OpenCylinder(32, 30, 1.0, 4.0);
  Shape source = target;
  source.Positions = Transformed(target.Positions, 0.3, RandomRigidMotion(2, 3.0));
  const Faded faded = Fade(target, source, { { 0, target.NumberOfVertices() - 32 } }, { 1.6, 1.6 });
  int count = 0;
  double farthest = 0.0;
  for (int v = 0; v < faded.Mesh.NumberOfVertices(); ++v)
  {
    const int ofSource = faded.Joined.SourceVertices[v];
    if (ofSource >= 0)
    {
      const Eigen::RowVector3d there =
        target.Positions.row(ofSource) + Eigen::RowVector3d(0.0, 0.0, 2.4);
      farthest = std::max(farthest, (faded.Positions.row(v) - there).norm());
      ++count;
    }
  }
  EXPECT_LT(farthest, 1e-6);
  EXPECT_EQ(count, source.NumberOfVertices());
}

TEST(Transition, HasAWidthOnEachSide)
{
  // A band of 1 on the target becomes one of 2 on the source.
  constexpr double Height = 0.03;
  const Shape target = Relief(64, 48, 0.0, 4.0, 8, Height);
  const Shape source = Relief(72, 48, 2.0, 4.0, 5, Height);
  const Faded faded = Fade(target, source, { { 0, target.NumberOfVertices() - 64 } }, { 1.0, 2.0 });
  EXPECT_EQ(cartan::FindBoundaryLoops(faded.Mesh).size(), 2u);
  // The seam is at z = 3, the band's end at 5.
  const Eigen::Vector2d below = WaveHeights(faded, { 8, 5 }, 2.0, 3.0) / Height;
  EXPECT_NEAR(below[0], 1.0, 0.01);
  const Eigen::Vector2d middle = WaveHeights(faded, { 8, 5 }, 3.9, 4.1) / Height;
  EXPECT_NEAR(middle[0], 0.5, 0.1);
  EXPECT_NEAR(middle[1], 0.5, 0.1);
  const Eigen::Vector2d above = WaveHeights(faded, { 8, 5 }, 5.0, 6.0) / Height;
  EXPECT_NEAR(above[0], 0.0, 0.02);
  EXPECT_NEAR(above[1], 1.0, 0.1);
  // Halfway through the source's band is halfway through the target's.
  double farthest = 0.0;
  for (int v = 0; v < faded.Mesh.NumberOfVertices(); ++v)
  {
    const double part = faded.Fading.SourceParts[v];
    if (part > 0.0 && part < 1.0)
    {
      const double there =
        cartan::AtPlaces(target.Positions, { faded.Fading.TargetPlaces[v] })(0, 2);
      farthest = std::max(farthest, std::abs(there - 3.0 - 0.5 * (faded.Positions(v, 2) - 3.0)));
    }
  }
  EXPECT_LT(farthest, 0.1); // an edge is .083 long
}

TEST(Transition, RefusesHeldPoints)
{
  const Shape target = OpenCylinder(24, 20, 1.0, 2.0);
  Shape source = target;
  source.Positions.col(2).array() += 1.0;
  std::vector<cartan::SourceHold> holds(source.NumberOfVertices());
  std::fill(holds.begin() + 8 * 24, holds.end(), cartan::SourceHold::Kept); // from .8 on
  const Keys keys = { { 0, target.NumberOfVertices() - 24 } };
  const std::string advice = Advice("unmark them, or raise BendWidth where that holds them.");
  try
  {
    Fade(target, source, keys, { 1.0, 1.0 }, holds);
    FAIL();
  }
  catch (const cartan::Error& error)
  {
    EXPECT_NE(std::string(error.what()).find(advice), std::string::npos) << error.what();
  }
  std::fill(holds.begin(), holds.begin() + 12 * 24, cartan::SourceHold::Free);
  EXPECT_EQ(Fade(target, source, keys, { 1.0, 1.0 }, holds).EulerNumber(), 0);
}

TEST(Transition, RefusesASourceWidthThatIsTooWide)
{
  const Shape target = Relief(24, 20, 0.0, 2.0, 4, 0.0);
  const Shape source = Relief(24, 10, 0.0, 1.0, 4, 0.0);
  const Keys keys = { { 0, target.NumberOfVertices() - 24 } };
  const std::string advice =
    Advice("Lower TransitionWidth, or SourceTransitionWidth where that is not 0.");
  try
  {
    Fade(target, source, keys, { 0.5, 1.5 });
    FAIL();
  }
  catch (const cartan::Error& error)
  {
    EXPECT_NE(std::string(error.what()).find(advice), std::string::npos) << error.what();
  }
  EXPECT_EQ(cartan::FindBoundaryLoops(Fade(target, source, keys, { 0.5, 0.7 }).Mesh).size(), 2u);
}

TEST(Transition, RefusesWhatIsWiderThanTheSurface)
{
  const Shape target = Relief(24, 20, 0.0, 2.0, 4, 0.0);
  const Shape source = Relief(24, 10, 0.0, 1.0, 4, 0.0);
  const Keys keys = { { 0, target.NumberOfVertices() - 24 } };
  const std::string advice = Advice("Lower TransitionWidth");
  for (const auto& [width, role] : { std::make_pair(2.5, "target"), std::make_pair(1.5, "source") })
  {
    try
    {
      Fade(target, source, keys, { width, width });
      FAIL() << width;
    }
    catch (const cartan::Error& error)
    {
      EXPECT_NE(std::string(error.what()).find(role), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(advice), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(cartan::FindBoundaryLoops(Fade(target, source, keys, { 0.5, 0.5 }).Mesh).size(), 2u);
}
