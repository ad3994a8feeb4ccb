// SPDX-License-Identifier: BSD-3-Clause
#include "AdviceWords.h"
#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Mesh/Geometry.h"
#include "Kernel/Morph/IsometricMorph.h"
#include "Kernel/Morph/PyramidCoordinatesMorph.h"
#include "MorphShapes.h"
#include "RealMeshes.h"

#include <gtest/gtest.h>

#include <cmath>

using cartan::KeyFrames;
using cartan::Points;
using cartan::PyramidCoordinatesMorph;
using cartan::TriangleMesh;
using Eigen::Vector3d;
using morphshapes::Keys;
using morphshapes::MeasureMorph;
using shapes::Shape;
using shapes::ShowFigure;

namespace
{
double Distance(const Points& a, const Points& b)
{
  return (a - b).rowwise().norm().maxCoeff();
}

/// The edges of v's ring on the plane normal to `normal`, as (length, angle from the
/// first, height).
std::vector<Vector3d> Pyramid(
  const TriangleMesh& mesh, const Points& points, int v, const Vector3d& normal)
{
  std::vector<Vector3d> edges;
  Vector3d before = Vector3d::Zero();
  double angle = 0.0;
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    const Vector3d edge = (points.row(mesh.Neighbor(d)) - points.row(v)).transpose();
    const double height = edge.dot(normal);
    const Vector3d projected = edge - height * normal;
    angle +=
      edges.empty() ? 0.0 : std::atan2(before.cross(projected).dot(normal), before.dot(projected));
    edges.emplace_back(projected.norm(), angle, height);
    before = projected;
  }
  return edges;
}

/// How far the one-rings of `points` are from those half way between two key frames:
/// the sum that the morph makes least, written down once more.
double Misfit(const KeyFrames& keys, const Points& points)
{
  const TriangleMesh& mesh = *keys.Mesh;
  const Points first = cartan::VertexNormals(mesh, keys.Positions[0]);
  const Points last = cartan::VertexNormals(mesh, keys.Positions[1]);
  double sum = 0.0;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const auto from = Pyramid(mesh, keys.Positions[0], v, first.row(v).transpose());
    const auto to = Pyramid(mesh, keys.Positions[1], v, last.row(v).transpose());
    std::vector<Vector3d> targets;
    std::vector<Vector3d> edges;
    std::vector<double> weights;
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    for (int k = 0; k < mesh.Valence(v); ++k)
    {
      const int w = mesh.Neighbor(mesh.RingBegin(v) + k);
      const Vector3d middle = 0.5 * (from[k] + to[k]);
      targets.emplace_back(
        middle[0] * std::cos(middle[1]), middle[0] * std::sin(middle[1]), middle[2]);
      edges.emplace_back((points.row(w) - points.row(v)).transpose());
      weights.push_back(2.0 /
        ((keys.Positions[0].row(w) - keys.Positions[0].row(v)).norm() +
          (keys.Positions[1].row(w) - keys.Positions[1].row(v)).norm()));
      products += weights.back() * edges.back() * targets.back().transpose();
    }
    const Eigen::Matrix3d rotation = cartan::ProjectOnRotations(products);
    for (std::size_t k = 0; k < edges.size(); ++k)
    {
      sum += weights[k] * (edges[k] - rotation * targets[k]).squaredNorm();
    }
  }
  return sum;
}

Points Random(Eigen::Index count, unsigned int seed)
{
  shapes::Random random(seed);
  Points points(count, 3);
  for (double& coordinate : points.reshaped())
  {
    coordinate = random();
  }
  return points;
}
}

TEST(PyramidCoordinatesMorph, FindsTheSurfaceWhoseRingsAreClosest)
{
  const Shape bar = shapes::Bar(3, 3, 12, { 1, 1, 4 });
  const KeyFrames keys = Keys(bar, { bar.Positions, morphshapes::Bend(bar, 90, 0.5, 3.5) });
  PyramidCoordinatesMorph morph(keys);
  const Points found = morph.Evaluate(0.5, {});
  EXPECT_EQ(morph.GetWarning(), "");
  const double least = Misfit(keys, found);
  EXPECT_GT(least, 0.0);
  EXPECT_LT(least, 0.99 * Misfit(keys, cartan::DiscreteFormsMorph(keys).Evaluate(0.5, {})));
  // A minimum: the misfit grows with the square of the distance, the same to both sides.
  for (unsigned int seed = 1; seed <= 10; ++seed)
  {
    const Points way = 1e-4 * Random(found.rows(), seed);
    const double there = Misfit(keys, found + way) - least;
    const double back = Misfit(keys, found - way) - least;
    EXPECT_GT(there, 0.0);
    EXPECT_NEAR(there, back, 0.01 * there) << seed;
  }
}

TEST(PyramidCoordinatesMorph, GivesRestAndRigidMotions)
{
  const Shape torus = shapes::Torus(24, 12, 2.0, 0.7, 0.2);
  const shapes::RigidMotion motion = shapes::RandomRigidMotion(3, 2.0);
  const KeyFrames keys = Keys(torus, { torus.Positions, motion(torus.Positions) });
  PyramidCoordinatesMorph morph(keys);
  const auto misplacement = [&](double t)
  {
    const Points found = morph.Evaluate(t, {});
    return Distance(shapes::BestRigidMotion(found, torus.Positions)(found), torus.Positions);
  };
  ShowFigure("rest", misplacement(0.0));
  ShowFigure("rigid motion", misplacement(0.4));
  EXPECT_LT(misplacement(0.0), 1e-9);
  EXPECT_LT(misplacement(0.4), 1e-8);
  EXPECT_LT(misplacement(1.0), 1e-8);
}

TEST(PyramidCoordinatesMorph, KeepsEdgesOfBendsAndTwists)
{
  const Shape bar = shapes::Bar(6, 6, 48, { 1, 1, 8 });
  struct Row
  {
    std::string Name;
    Points End;
    double Edges;
  };
  for (const Row& row : { Row{ "bend 170", morphshapes::Bend(bar, 170, 1, 7), 0.001 },
         Row{ "bend 300", morphshapes::Bend(bar, 300, 1, 7), 0.003 },
         Row{ "twist 170", morphshapes::Twist(bar, 170, 1, 7), 0.0015 },
         Row{ "twist 540", morphshapes::Twist(bar, 540, 1, 7), 0.011 } })
  {
    const KeyFrames keys = Keys(bar, { bar.Positions, row.End });
    PyramidCoordinatesMorph morph(keys);
    const auto figures = MeasureMorph(keys, morph.Evaluate(0.5, {}), 0.5);
    ShowFigure(row.Name + ", edges", figures.EdgeRms);
    ShowFigure(row.Name + ", volume", figures.Volume);
    ShowFigure(row.Name + ", iterations", morph.GetNumberOfIterations());
    EXPECT_LT(figures.EdgeRms, row.Edges) << row.Name;
    EXPECT_LT(morph.GetNumberOfIterations(), 150) << row.Name;
    EXPECT_EQ(morph.GetWarning(), "") << row.Name;
  }
}

TEST(PyramidCoordinatesMorph, MorphsAScanBetweenPoses)
{
  const Shape camel = shapes::RealMesh("camel");
  const KeyFrames keys = Keys(camel, { camel.Positions, morphshapes::BendAlong(camel, 1, 100) });
  PyramidCoordinatesMorph morph(keys);
  const auto figures = MeasureMorph(keys, morph.Evaluate(0.5, {}), 0.5);
  ShowFigure("camel, edges", figures.EdgeRms);
  ShowFigure("camel, iterations", morph.GetNumberOfIterations());
  EXPECT_LT(figures.EdgeRms, 0.001);
  EXPECT_NEAR(figures.Volume, 1.0, 0.002);
  EXPECT_EQ(morph.GetWarning(), "");
}

/// A thin tube that is twisted twice.
TEST(PyramidCoordinatesMorph, SaysWhenItHasNotSettled)
{
  const Shape tube = shapes::OpenCylinder(3, 200, 0.5, 60.0);
  const KeyFrames keys =
    Keys(tube, { tube.Positions, morphshapes::Twist(tube, 720.0, -1.0, 61.0) });
  PyramidCoordinatesMorph morph(keys);
  const Points found = morph.Evaluate(0.5, {});
  EXPECT_TRUE(found.allFinite());
  EXPECT_NE(
    morph.GetWarning().find(shapes::Advice("Use the Isometric method, which does not iterate.")),
    std::string::npos)
    << morph.GetWarning();
  cartan::IsometricMorph isometric(keys);
  const auto figures = MeasureMorph(keys, isometric.Evaluate(0.5, {}), 0.5);
  EXPECT_EQ(isometric.GetWarning(), "");
  EXPECT_LT(figures.EdgeRms, 1e-3);
}

TEST(PyramidCoordinatesMorph, StopsOnRequest)
{
  const Shape bar = shapes::Bar(3, 3, 12, { 1, 1, 4 });
  const KeyFrames keys = Keys(bar, { bar.Positions, morphshapes::Bend(bar, 90, 0.5, 3.5) });
  PyramidCoordinatesMorph morph(keys);
  const cartan::ExecutionContext stopping({}, [](double part) { return part < 0.5; });
  EXPECT_THROW(morph.Evaluate(0.5, stopping), cartan::Error);
}
