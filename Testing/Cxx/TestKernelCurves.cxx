// SPDX-License-Identifier: BSD-3-Clause
#include "AdviceWords.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Base/Error.h"
#include "Kernel/Deformation/CurveDeltas.h"
#include "Kernel/Deformation/CurveMatch.h"
#include "Kernel/Differential/Laplacian.h"
#include "Kernel/Mesh/EdgePaths.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

namespace
{
using cartan::Points;
using cartan::TriangleMesh;

Points Helix(int count, double turns)
{
  Points helix(count, 3);
  for (int i = 0; i < count; ++i)
  {
    const double t = 2.0 * shapes::Pi * turns * i / (count - 1.0);
    helix.row(i) << std::cos(t), std::sin(t), 0.2 * t;
  }
  return helix;
}

double LengthOf(const Points& curve)
{
  return cartan::ArcLengths(curve)[curve.rows() - 1];
}

template <typename Call>
std::string MessageOf(const Call& call)
{
  try
  {
    call();
  }
  catch (const cartan::Error& error)
  {
    return error.what();
  }
  return "";
}

TEST(EdgePaths, GridPathsHaveTheirKnownLength)
{
  const shapes::Shape plane = shapes::Plane(10, 10.0);
  const TriangleMesh mesh(plane.NumberOfVertices(), plane.Faces);
  // Along the diagonals of the quads, or across them.
  const std::vector<int> along = cartan::ShortestEdgePath(mesh, plane.Positions, 0, 120);
  EXPECT_EQ(along.size(), 11u);
  const std::vector<int> side = cartan::ShortestEdgePath(mesh, plane.Positions, 0, 10);
  EXPECT_EQ(side.size(), 11u);
  for (int i = 0; i <= 10; ++i)
  {
    EXPECT_EQ(side[i], i);
  }
  const std::vector<int> through = cartan::PathThrough(mesh, plane.Positions, { 0, 10, 120 });
  EXPECT_EQ(through.size(), 21u);
}

TEST(EdgePaths, FeaturesOfABarAreItsEdgesAndItsOutlineIsARing)
{
  const shapes::Shape bar = shapes::Bar(4, 4, 8, { 1.0, 1.0, 2.0 });
  const TriangleMesh mesh(bar.NumberOfVertices(), bar.Faces);
  const auto lengthOf = [&](const cartan::EdgeMask& mask)
  {
    double length = 0.0;
    for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
    {
      length += mask[d]
        ? 0.5 * (bar.Positions.row(mesh.Origin(d)) - bar.Positions.row(mesh.Neighbor(d))).norm()
        : 0.0;
    }
    return length;
  };
  EXPECT_NEAR(lengthOf(cartan::FeatureEdges(mesh, bar.Positions, 0.5)), 8.0 + 8.0, 1e-12);
  EXPECT_EQ(lengthOf(cartan::FeatureEdges(mesh, bar.Positions, 1.6)), 0.0);
  // Seen along (1, 1, 0), the outline is two long edges and both ends' diagonal corners.
  EXPECT_NEAR(lengthOf(cartan::SilhouetteEdges(mesh, bar.Positions, { 1.0, 1.0, 0.1 })),
    2.0 * 2.0 + 4.0, 1e-12);
  // A border is both.
  const shapes::Shape plane = shapes::Plane(4);
  const TriangleMesh sheet(plane.NumberOfVertices(), plane.Faces);
  const cartan::EdgeMask border = cartan::FeatureEdges(sheet, plane.Positions, 0.5);
  EXPECT_EQ(std::count(border.begin(), border.end(), 1), 2 * 16);
}

TEST(EdgePaths, ChainsAreSortedAndOthersRefused)
{
  const shapes::Shape plane = shapes::Plane(4);
  const TriangleMesh mesh(plane.NumberOfVertices(), plane.Faces);
  // From the end that is named first.
  EXPECT_EQ(cartan::ChainVertices(mesh, { 3, 1, 2, 0, 2 }), (std::vector<int>{ 3, 2, 1, 0 }));
  EXPECT_EQ(cartan::ChainVertices(mesh, { 2, 0, 1, 3 }), (std::vector<int>{ 0, 1, 2, 3 }));
  for (const std::vector<int>& wrong :
    { std::vector<int>{ 0 }, { 0, 1, 3, 4 }, { 0, 1, 2, 6, 7, 5 } })
  {
    EXPECT_NE(MessageOf([&] { cartan::ChainVertices(mesh, wrong); }).find("not one line"),
      std::string::npos);
  }
}

TEST(CurveMatch, EqualCurvesMatchPointByPointAndImagesLieOnTheTarget)
{
  const Points helix = Helix(40, 1.5);
  EXPECT_LT((cartan::MatchCurves(helix, helix, {}) - helix).cwiseAbs().maxCoeff(), 1e-14);
  // A coarser polyline of another length: equal parts of the length.
  const Points other = 3.0 * Helix(17, 0.7);
  const Points matched = cartan::MatchCurves(helix, other, {});
  EXPECT_EQ(matched.row(0), other.row(0));
  EXPECT_EQ(matched.row(39), other.row(16));
  const Eigen::VectorXd parts = cartan::ArcLengths(helix) / LengthOf(helix);
  for (int i = 0; i < 40; ++i)
  {
    double nearest = 1e300;
    double length = 0.0;
    for (int j = 0; j < 16; ++j)
    {
      const Eigen::RowVector3d edge = other.row(j + 1) - other.row(j);
      const Eigen::RowVector3d way = matched.row(i) - other.row(j);
      const double t = std::min(std::max(way.dot(edge) / edge.squaredNorm(), 0.0), 1.0);
      if ((way - t * edge).norm() < nearest - 1e-12)
      {
        nearest = (way - t * edge).norm();
        length = cartan::ArcLengths(other)[j] + t * edge.norm();
      }
    }
    EXPECT_LT(nearest, 1e-12);
    EXPECT_NEAR(length / LengthOf(other), parts[i], 1e-9);
  }
}

TEST(CurveMatch, KeysMatchExactly)
{
  const Points helix = Helix(40, 1.5);
  const Points other = Helix(30, 0.5);
  const Points matched = cartan::MatchCurves(helix, other, { { 30, 25 }, { 10, 20 } });
  EXPECT_EQ(matched.row(10), other.row(20));
  EXPECT_EQ(matched.row(30), other.row(25));
  EXPECT_NE(MessageOf(
              [&] {
                cartan::MatchCurves(helix, other, { { 30, 20 }, { 10, 25 } });
              })
              .find("different orders"),
    std::string::npos);
}

TEST(CurveMatch, FramesOfRigidMotionsAreTheMotion)
{
  const Points helix = Helix(40, 1.5);
  const Eigen::Vector3d vector(0.4, 2.1, -0.9);
  const Eigen::Matrix3d rotation = cartan::RotationFromVector(vector);
  const Points moved = (helix * rotation.transpose()).rowwise() + Eigen::RowVector3d(3.0, 1.0, 2.0);
  const Points vectors = cartan::CurveRotations(helix, moved);
  for (Eigen::Index i = 0; i < vectors.rows(); ++i)
  {
    EXPECT_LT((vectors.row(i).transpose() - vector).norm(), 1e-9);
  }
  EXPECT_EQ(cartan::CurveRotations(helix, helix).norm() < 1e-12, true);
}

TEST(CurveMatch, AStraightCurveThatBendsTurnsAboutTheNormalOfItsPlane)
{
  Points line(21, 3);
  Points arc(21, 3);
  for (int i = 0; i <= 20; ++i)
  {
    const double angle = 0.1 * (i - 10);
    line.row(i) << 0.1 * i, 0.0, 0.0;
    arc.row(i) << std::sin(angle), 1.0 - std::cos(angle), 0.0;
  }
  const Points vectors = cartan::CurveRotations(line, arc);
  for (int i = 1; i < 20; ++i)
  {
    EXPECT_LT((vectors.row(i) - Eigen::RowVector3d(0.0, 0.0, 0.1 * (i - 10))).norm(), 1e-9) << i;
  }
}

TEST(CurveMatch, CurvesThatTouchThemselvesAreRefused)
{
  Points cross(4, 3);
  cross << 0, 0, 0, 1, 1, 0, 1, 0, 0, 0, 1, 0;
  EXPECT_NE(
    MessageOf([&] { cartan::RequireSimpleCurve(cross, "target curve"); }).find("1 segment (id 0)"),
    std::string::npos);
  cross(2, 2) = cross(3, 2) = 0.01; // passes above
  cartan::RequireSimpleCurve(cross, "target curve");
  cartan::RequireSimpleCurve(Helix(500, 20.0), "target curve");
  EXPECT_NE(MessageOf([&] { cartan::RequireSimpleCurve(Points::Ones(3, 3), "target curve"); })
              .find("no length"),
    std::string::npos);
}

/// Around a bar, in the middle of its length.
std::vector<int> RingOfBar(const shapes::Shape& bar)
{
  std::vector<int> ring;
  for (int v = 0; v < bar.NumberOfVertices(); ++v)
  {
    if (std::abs(bar.Positions(v, 2) - 1.0) < 1e-9)
    {
      ring.push_back(v);
    }
  }
  return ring;
}

Points RowsAt(const Points& points, const std::vector<int>& ids)
{
  Points rows(static_cast<Eigen::Index>(ids.size()), 3);
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
  {
    rows.row(i) = points.row(ids[i]);
  }
  return rows;
}

double LengthOfRing(const Points& ring)
{
  return LengthOf(ring) + (ring.row(0) - ring.row(ring.rows() - 1)).norm();
}

/// A ring of 24 points that lies in no plane.
Points Loop()
{
  Points ring(24, 3);
  for (int i = 0; i < 24; ++i)
  {
    const double t = 2.0 * shapes::Pi * i / 24.0;
    ring.row(i) << 2.0 * std::cos(t), std::sin(t), 0.3 * std::sin(2.0 * t);
  }
  return ring;
}

TEST(EdgePaths, RingsRunAroundABar)
{
  const shapes::Shape bar = shapes::Bar(4, 4, 8, { 1.0, 1.0, 2.0 });
  const TriangleMesh mesh(bar.NumberOfVertices(), bar.Faces);
  const std::vector<int> around = RingOfBar(bar);
  ASSERT_EQ(around.size(), 16u);
  const std::vector<int> ring = cartan::ChainVertices(mesh, around, true);
  EXPECT_NEAR(LengthOfRing(RowsAt(bar.Positions, ring)), 4.0, 1e-12);
  EXPECT_EQ(ring.front(), around.front());
  // Named in another order it starts there and runs towards the neighbor that is named first.
  std::vector<int> others = { ring[5], ring[4] };
  others.insert(others.end(), ring.begin(), ring.end());
  std::vector<int> backward;
  for (int i = 0; i < 16; ++i)
  {
    backward.push_back(ring[(21 - i) % 16]);
  }
  EXPECT_EQ(cartan::ChainVertices(mesh, others, true), backward);
  // The same through four of its points, and in no order that crosses itself.
  const std::vector<int> four = { ring[0], ring[4], ring[8], ring[12] };
  const std::vector<int> through = cartan::PathThrough(mesh, bar.Positions, four, {}, true);
  EXPECT_EQ(through, ring);
  EXPECT_NE(MessageOf(
              [&] {
                cartan::PathThrough(mesh, bar.Positions, { ring[0], ring[4] }, {}, true);
              })
              .find(shapes::Advice("three or more around it.")),
    std::string::npos);
  // Of the sharp edges, the shortest ring is the square at an end.
  const cartan::EdgeMask sharp = cartan::FeatureEdges(mesh, bar.Positions, 0.5);
  int pick = 0;
  for (int v = 0; v < bar.NumberOfVertices(); ++v)
  {
    const Eigen::RowVector3d p = bar.Positions.row(v);
    pick =
      std::abs(p.z()) < 1e-9 && (p - Eigen::RowVector3d(0.5, 0.25, 0.0)).norm() < 1e-9 ? v : pick;
  }
  const Points square =
    RowsAt(bar.Positions, cartan::RingThrough(mesh, bar.Positions, pick, sharp));
  EXPECT_EQ(square.rows(), 16);
  EXPECT_EQ(square.col(2).cwiseAbs().maxCoeff(), 0.0);
  const cartan::EdgeMask none(mesh.NumberOfDirectedEdges(), 0);
  EXPECT_NE(MessageOf([&] { cartan::RingThrough(mesh, bar.Positions, pick, none); })
              .find(shapes::Advice("or three PointIds or more around the ring.")),
    std::string::npos);
  EXPECT_NE(MessageOf(
              [&] {
                cartan::ChainVertices(mesh, { ring[0], ring[1], ring[2] }, true);
              })
              .find("not one ring"),
    std::string::npos);
}

TEST(CurveMatch, RingsMatchFromTheNearestPlaceOnWhicheverWayTheyRun)
{
  const Points ring = Loop();
  EXPECT_LT((cartan::MatchClosedCurves(ring, ring, {}, false) - ring).norm(), 1e-13);
  // Elsewhere, larger, started at another point, and backward.
  const Points image = (3.0 * ring).rowwise() + Eigen::RowVector3d(5.0, -1.0, 2.0);
  Points moved(24, 3);
  moved << image.bottomRows(17), image.topRows(7);
  const Points backward = moved.colwise().reverse();
  for (const Points& target : { image, moved, backward })
  {
    EXPECT_LT((cartan::MatchClosedCurves(ring, target, {}, false) - image).norm(), 1e-12);
    const Points other = cartan::MatchClosedCurves(ring, target, {}, true);
    EXPECT_LT((other.row(0) - image.row(0)).norm(), 1e-12);
    EXPECT_LT((other.row(1) - image.row(23)).norm(), 1e-12);
  }
  // A key shifts all, two stretch what is between them, three tell the way.
  const Points one = cartan::MatchClosedCurves(ring, image, { { 3, 6 } }, false);
  EXPECT_LT((one.row(3) - image.row(6)).norm(), 1e-12);
  const Points three =
    cartan::MatchClosedCurves(ring, image, { { 0, 0 }, { 4, 20 }, { 12, 12 } }, true);
  EXPECT_LT((three.row(4) - image.row(20)).norm(), 1e-12);
  EXPECT_LT((three.row(12) - image.row(12)).norm(), 1e-12);
  EXPECT_NE(MessageOf(
              [&] {
                cartan::MatchClosedCurves(ring, image, { { 0, 0 }, { 4, 20 }, { 12, 12 } }, false);
              })
              .find("different orders"),
    std::string::npos);
  cartan::RequireSimpleCurve(ring, "ring", true);
  Points eight = ring;
  eight.col(1) = eight.col(0).cwiseProduct(eight.col(1));
  eight.col(2).setZero();
  EXPECT_NE(MessageOf([&] { cartan::RequireSimpleCurve(eight, "ring", true); }).find("crosses"),
    std::string::npos);
}

TEST(CurveMatch, FramesOfRingsTurnWithThem)
{
  const Points ring = Loop();
  const Eigen::Vector3d vector(0.4, -0.7, 0.2);
  const Points turned = ring * cartan::RotationFromVector(vector).transpose();
  const Points vectors = cartan::CurveRotations(ring, turned, true);
  EXPECT_LT((vectors.rowwise() - vector.transpose()).cwiseAbs().maxCoeff(), 1e-9);
}

/// A dome, the vertices of a line across it, and the distances from that.
struct Dome
{
  Dome()
    : Surface(shapes::Graph(
        20, 4.0, [](double x, double y) { return 1.0 - 0.2 * (x * x + y * y); }, 0.0))
    , Mesh(Surface.NumberOfVertices(), Surface.Faces)
    , Distances(Surface.Positions.col(1).cwiseAbs())
  {
    for (int x = 4; x <= 16; ++x)
    {
      this->Path.push_back(10 * 21 + x);
    }
  }

  Points Deform(double scale, double turn, bool isSharp, double width = 0.9) const
  {
    return cartan::DeformByCurveDeltas(this->Mesh, this->Surface.Positions, this->Path, false,
      this->Distances, { scale, turn, width, isSharp });
  }

  Points Deltas(const Points& x) const
  {
    return cartan::Laplacian(this->Mesh,
             cartan::EdgeWeights(
               this->Mesh, this->Surface.Positions, cartan::LaplacianWeights::Cotangent)) *
      x;
  }

  shapes::Shape Surface;
  TriangleMesh Mesh;
  Eigen::VectorXd Distances;
  std::vector<int> Path;
};

TEST(CurveDeltas, AreScaledAndTurnedByTheirProfile)
{
  const Dome dome;
  const Points before = dome.Deltas(dome.Surface.Positions);
  for (const bool isSharp : { false, true })
  {
    const double turn = 0.7;
    const Points result = dome.Deform(1.8, turn, isSharp);
    const Points after = dome.Deltas(result);
    for (int v = 0; v < dome.Mesh.NumberOfVertices(); ++v)
    {
      const double t = dome.Distances[v] / 0.9;
      if (t >= 1.0)
      {
        EXPECT_EQ(result.row(v), dome.Surface.Positions.row(v));
        continue;
      }
      const double part = isSharp ? (t == 0.0 ? 1.0 : 0.0) : std::pow(1.0 - t * t, 2);
      const double angle = part * turn;
      // The line across runs in planes y = const; its tangent there is that of the parabola.
      const double x = std::clamp(dome.Surface.Positions(v, 0), -1.2, 1.2);
      if (part > 0.0 && t == 0.0 && std::abs(x) < 1.1)
      {
        // The turned delta is as long as the factor makes it, and the part along the tangent
        // of one of the two segments beside the vertex stays.
        EXPECT_NEAR(after.row(v).norm(), (1.0 + 0.8 * part) * before.row(v).norm(), 1e-9);
        const double cosine = after.row(v).normalized().dot(before.row(v).normalized());
        EXPECT_NEAR(std::acos(std::min(cosine, 1.0)), angle, 0.05);
      }
      if (part == 0.0)
      {
        EXPECT_LT((after.row(v) - before.row(v)).norm(), 1e-9);
      }
    }
  }
}

TEST(CurveDeltas, ScalingMakesRidgesOfDomesAndNothingOfPlanes)
{
  const Dome dome;
  EXPECT_EQ(dome.Deform(1.0, 0.0, false), dome.Surface.Positions);
  for (const bool isSharp : { false, true })
  {
    // Linear in the factor.
    const Points twice = dome.Deform(2.0, 0.0, isSharp);
    const Points thrice = dome.Deform(3.0, 0.0, isSharp);
    const Points& rest = dome.Surface.Positions;
    EXPECT_LT((thrice - rest - 2.0 * (twice - rest)).norm(), 1e-9);
    EXPECT_GT(twice(dome.Path[6], 2), rest(dome.Path[6], 2) + 0.01);
    EXPECT_LT(dome.Deform(-1.0, 0.0, isSharp)(dome.Path[6], 2), rest(dome.Path[6], 2) - 0.01);
    // A turn leans to one side, and the opposite turn to the other.
    const double lean = dome.Deform(1.0, 0.5, isSharp)(dome.Path[6], 1);
    EXPECT_GT(std::abs(lean), 1e-3);
    EXPECT_NEAR(dome.Deform(1.0, -0.5, isSharp)(dome.Path[6], 1), -lean, 0.1 * std::abs(lean));
  }
  const shapes::Shape plane = shapes::Plane(8, 4.0);
  const TriangleMesh mesh(plane.NumberOfVertices(), plane.Faces);
  const Points flat = cartan::DeformByCurveDeltas(mesh, plane.Positions, { 38, 39, 40, 41 }, false,
    plane.Positions.rowwise().norm(), { 3.0, 0.4, 1.2, false });
  EXPECT_LT((flat - plane.Positions).norm(), 1e-12);
}

TEST(CurveDeltas, TurnWithTheSurfaceAndNeedAPartThatStays)
{
  const Dome dome;
  const Eigen::Matrix3d turn = cartan::RotationFromVector({ 0.3, 1.1, -0.4 });
  const Points moved = dome.Surface.Positions * turn.transpose();
  const Points result = cartan::DeformByCurveDeltas(
    dome.Mesh, moved, dome.Path, false, dome.Distances, { 1.6, 0.5, 0.9, false });
  EXPECT_LT((result - dome.Deform(1.6, 0.5, false) * turn.transpose()).norm(), 1e-9);
  EXPECT_NE(
    MessageOf([&] { dome.Deform(2.0, 0.0, false, 3.0); }).find(shapes::Advice("lower RidgeWidth.")),
    std::string::npos);
  dome.Deform(2.0, 0.0, false, 1.5);
}
}
