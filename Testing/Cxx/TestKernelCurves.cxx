// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Base/Error.h"
#include "Kernel/Deformation/CurveMatch.h"
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
  EXPECT_EQ(cartan::ChainVertices(mesh, { 3, 1, 2, 0, 2 }), (std::vector<int>{ 0, 1, 2, 3 }));
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
}
