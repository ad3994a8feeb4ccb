// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Spectral/LeastSquaresMesh.h"

#include "Kernel/Base/Error.h"
#include "Kernel/Mesh/FarthestPoints.h"
#include "RealMeshes.h"

#include <gtest/gtest.h>

#include <set>

using cartan::AnchorSelection;
using cartan::LeastSquaresMesh;
using cartan::Points;
using cartan::TriangleMesh;
using shapes::MakeMesh;
using shapes::Shape;

namespace
{
LeastSquaresMesh Make(const Shape& shape, AnchorSelection selection, int count)
{
  LeastSquaresMesh::Settings settings;
  settings.Selection = selection;
  settings.NumberOfAnchors = count;
  return LeastSquaresMesh(MakeMesh(shape), shape.Positions, settings);
}

Shape TwoParts()
{
  return shapes::Union(shapes::Noisy(shapes::Torus(24, 14), 0.02), shapes::Plane(8));
}
}

TEST(FarthestPoints, AreSpreadAndStartInEachComponent)
{
  const Shape shape = TwoParts();
  const TriangleMesh mesh = MakeMesh(shape);
  const std::vector<int> all = cartan::FarthestPoints(mesh, shape.Positions, 30);
  ASSERT_EQ(all.size(), 30u);
  EXPECT_EQ(std::set<int>(all.begin(), all.end()).size(), 30u);
  EXPECT_NE(mesh.Component(all[0]), mesh.Component(all[1]));
  // A prefix of the sequence is the sequence of that length.
  const std::vector<int> some = cartan::FarthestPoints(mesh, shape.Positions, 9);
  EXPECT_TRUE(std::equal(some.begin(), some.end(), all.begin()));
  // A square's corners are farthest from its center and from each other.
  const Shape square = shapes::Plane(6);
  std::set<int> corners;
  for (const int v : cartan::FarthestPoints(MakeMesh(square), square.Positions, 4))
  {
    corners.insert(v);
  }
  EXPECT_EQ(corners, (std::set<int>{ 0, 6, 42, 48 }));
}

TEST(LeastSquaresMesh, EqualsTheOneWithAllItsAnchorsAtOnce)
{
  const Shape shape = TwoParts();
  for (const AnchorSelection selection :
    { AnchorSelection::FarthestPoint, AnchorSelection::Greedy })
  {
    const LeastSquaresMesh gradual = Make(shape, selection, 60);
    ASSERT_EQ(gradual.GetAnchors().size(), 60u);
    for (const int count : { 2, 3, 17, 60 })
    {
      const std::vector<int> anchors(
        gradual.GetAnchors().begin(), gradual.GetAnchors().begin() + count);
      const LeastSquaresMesh whole(MakeMesh(shape), shape.Positions, anchors, 1000000000);
      EXPECT_LT((gradual.Surface(count) - whole.Surface(count)).cwiseAbs().maxCoeff(), 1e-9);
      EXPECT_NEAR(gradual.GetRootMeanSquares()[count - 2], whole.GetRootMeanSquares()[0], 1e-9);
      EXPECT_NEAR(gradual.GetMaxima()[count - 2], whole.GetMaxima()[0], 1e-9);
    }
  }
}

TEST(LeastSquaresMesh, IsTheSumOfItsBasisFunctions)
{
  const Shape shape = TwoParts();
  const LeastSquaresMesh mesh = Make(shape, AnchorSelection::Greedy, 25);
  for (const int count : { 2, 11, 25 })
  {
    const Eigen::MatrixXd functions = mesh.BasisFunctions(count);
    Points anchors(count, 3);
    for (int i = 0; i < count; ++i)
    {
      anchors.row(i) = shape.Positions.row(mesh.GetAnchors()[i]);
      for (int j = 0; j < count; ++j)
      {
        EXPECT_NEAR(functions(mesh.GetAnchors()[i], j), i == j ? 1.0 : 0.0, 1e-9);
      }
    }
    EXPECT_LT((functions * anchors - mesh.Surface(count)).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST(LeastSquaresMesh, PassesThroughAnchorsWithTheSmallestUniformDifferences)
{
  const Shape shape = shapes::Noisy(shapes::Torus(20, 12), 0.05);
  const TriangleMesh topology = MakeMesh(shape);
  const LeastSquaresMesh mesh = Make(shape, AnchorSelection::FarthestPoint, 15);
  const Points surface = mesh.Surface(15);
  const auto energy = [&](const Points& points)
  {
    double sum = 0.0;
    for (int v = 0; v < topology.NumberOfVertices(); ++v)
    {
      Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
      for (int d = topology.RingBegin(v); d < topology.RingEnd(v); ++d)
      {
        mean += points.row(topology.Neighbor(d)) / topology.Valence(v);
      }
      sum += (points.row(v) - mean).squaredNorm();
    }
    return sum;
  };
  for (const int v : mesh.GetAnchors())
  {
    EXPECT_LT((surface.row(v) - shape.Positions.row(v)).norm(), 1e-11);
  }
  shapes::Random random(4);
  for (int trial = 0; trial < 20; ++trial)
  {
    Points other = surface;
    for (int v = 0; v < topology.NumberOfVertices(); ++v)
    {
      other.row(v) += 1e-3 * Eigen::RowVector3d(random(), random(), random());
    }
    for (const int v : mesh.GetAnchors())
    {
      other.row(v) = surface.row(v);
    }
    EXPECT_GT(energy(other), energy(surface));
  }
}

TEST(LeastSquaresMesh, ApproximatesAsPublished)
{
  // Greedy anchors: RMS distance in parts of the bounding box's diagonal.
  struct Case
  {
    const char* Mesh;
    double Errors[3];
  };
  const int counts[] = { 20, 100, 500 };
  for (const Case& asked :
    { Case{ "elephant", { 0.0300, 0.0075, 0.0031 } }, Case{ "camel", { 0.0317, 0.0119, 0.0030 } } })
  {
    Shape shape = shapes::RealMesh(asked.Mesh);
    shape.Positions /=
      (shape.Positions.colwise().maxCoeff() - shape.Positions.colwise().minCoeff()).norm();
    const LeastSquaresMesh mesh = Make(shape, AnchorSelection::Greedy, 500);
    for (int i = 0; i < 3; ++i)
    {
      const double error = mesh.GetRootMeanSquares()[counts[i] - mesh.NumberOfBaseAnchors()];
      shapes::ShowFigure(std::string(asked.Mesh) + " " + std::to_string(counts[i]), error);
      EXPECT_LT(error, asked.Errors[i] + 0.00005); // its last digit
    }
  }
}

TEST(LeastSquaresMesh, RefusesWhatCannotBe)
{
  const Shape shape = TwoParts();
  const auto messageOf = [&](int count, std::uint64_t bytes)
  {
    LeastSquaresMesh::Settings settings;
    settings.NumberOfAnchors = count;
    settings.MaximumBytes = bytes;
    try
    {
      LeastSquaresMesh(MakeMesh(shape), shape.Positions, settings);
    }
    catch (const cartan::Error& error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(messageOf(1, 1000000000).find("Ask for 2 to 417"), std::string::npos)
    << messageOf(1, 1000000000);
  EXPECT_NE(messageOf(418, 1000000000).find("Ask for 2 to 417"), std::string::npos);
  EXPECT_NE(messageOf(100, 100000).find("at most 29 anchors"), std::string::npos)
    << messageOf(100, 100000);
  EXPECT_EQ(messageOf(29, 100000), "");
}
