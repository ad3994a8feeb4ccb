// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Differential/Laplacian.h"

#include "Kernel/Mesh/Geometry.h"
#include "RealMeshes.h"

#include <gtest/gtest.h>

using cartan::LaplacianWeights;
using cartan::Points;
using cartan::SparseMatrix;
using cartan::TriangleMesh;
using shapes::Area;
using shapes::MakeMesh;
using shapes::Shape;

namespace
{
constexpr LaplacianWeights AllWeights[] = { LaplacianWeights::Uniform, LaplacianWeights::Cotangent,
  LaplacianWeights::MeanValue };

Eigen::VectorXd Weights(const Shape& shape, LaplacianWeights weights)
{
  return cartan::EdgeWeights(MakeMesh(shape), shape.Positions, weights);
}

SparseMatrix MakeLaplacian(const Shape& shape, LaplacianWeights weights)
{
  return cartan::Laplacian(MakeMesh(shape), Weights(shape, weights));
}

std::vector<Shape> Surfaces()
{
  return { shapes::Icosphere(2), shapes::Plane(7, 1.0, 0.3, 3), shapes::OpenCylinder(9, 4),
    shapes::UvSphere(12, 5), shapes::Union(shapes::Torus(8, 5), shapes::Plane(2)),
    shapes::RealMesh("elephant") };
}

/// The weight of the edge from a to b.
double WeightOf(const Shape& shape, LaplacianWeights weights, int a, int b)
{
  const TriangleMesh mesh = MakeMesh(shape);
  const Eigen::VectorXd all = cartan::EdgeWeights(mesh, shape.Positions, weights);
  for (int d = mesh.RingBegin(a); d < mesh.RingEnd(a); ++d)
  {
    if (mesh.Neighbor(d) == b)
    {
      return all[d];
    }
  }
  ADD_FAILURE() << "no edge " << a << " " << b;
  return 0.0;
}
}

TEST(Laplacian, HasConstantsInItsNullSpace)
{
  for (const Shape& surface : Surfaces())
  {
    for (const LaplacianWeights weights : AllWeights)
    {
      const SparseMatrix laplacian = MakeLaplacian(surface, weights);
      const Eigen::VectorXd ones = Eigen::VectorXd::Ones(laplacian.rows());
      const double scale = laplacian.diagonal().cwiseAbs().maxCoeff();
      EXPECT_LT((laplacian * ones).cwiseAbs().maxCoeff(), 1e-13 * scale);
    }
  }
}

TEST(Laplacian, IsSymmetricForUniformCotangentAndSymmetrizedWeights)
{
  for (const Shape& surface : Surfaces())
  {
    const TriangleMesh mesh = MakeMesh(surface);
    for (const LaplacianWeights weights : AllWeights)
    {
      const Eigen::VectorXd symmetric = cartan::SymmetricPart(mesh, Weights(surface, weights));
      if (weights != LaplacianWeights::MeanValue)
      {
        EXPECT_LT((symmetric - Weights(surface, weights)).cwiseAbs().maxCoeff(),
          1e-12 * symmetric.cwiseAbs().maxCoeff());
      }
      const SparseMatrix laplacian = cartan::Laplacian(mesh, symmetric);
      const SparseMatrix transposed = laplacian.transpose();
      EXPECT_EQ((laplacian - transposed).norm(), 0.0);
      // Positive semidefinite: no vector has negative energy.
      shapes::Random random(1);
      for (int trial = 0; trial < 20; ++trial)
      {
        const Eigen::VectorXd x =
          Eigen::VectorXd::NullaryExpr(laplacian.rows(), [&random]() { return random(); });
        EXPECT_GE(x.dot(laplacian * x), 0.0);
      }
    }
  }
}

TEST(Laplacian, IsTheGraphLaplacianForUniformWeights)
{
  const Shape surface = shapes::Plane(4);
  const TriangleMesh mesh = MakeMesh(surface);
  const Eigen::MatrixXd laplacian = MakeLaplacian(surface, LaplacianWeights::Uniform);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(laplacian.rows(), laplacian.cols());
  for (Eigen::Index t = 0; t < surface.Faces.rows(); ++t)
  {
    for (int c = 0; c < 3; ++c)
    {
      const int a = surface.Faces(t, c);
      const int b = surface.Faces(t, (c + 1) % 3);
      expected(a, b) = expected(b, a) = -1.0;
    }
  }
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    expected(v, v) = -expected.row(v).sum();
  }
  EXPECT_EQ(laplacian, expected);
}

TEST(Laplacian, OfLinearFunctionsVanishesInsidePlanarMeshes)
{
  // The plane must not lie along the axes, and triangles be of all shapes.
  Shape plane = shapes::RandomRigidMotion(3)(shapes::Plane(12, 2.0, 0.3, 9));
  const TriangleMesh mesh = MakeMesh(plane);
  for (const LaplacianWeights weights :
    { LaplacianWeights::Cotangent, LaplacianWeights::MeanValue })
  {
    const Eigen::VectorXd edgeWeights = Weights(plane, weights);
    // Row-wise, as the header defines it: mean-value weights are not symmetric.
    double worst = 0.0;
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      if (mesh.IsBoundary(v))
      {
        continue;
      }
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      double scale = 0.0;
      for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
      {
        sum += edgeWeights[d] * (plane.Positions.row(v) - plane.Positions.row(mesh.Neighbor(d)));
        scale += std::abs(edgeWeights[d]);
      }
      worst = std::max(worst, sum.norm() / scale);
    }
    EXPECT_LT(worst, 1e-14);
    const Points product = cartan::Laplacian(mesh, edgeWeights) * plane.Positions;
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      if (!mesh.IsBoundary(v))
      {
        EXPECT_LT(product.row(v).norm(), 1e-11);
      }
    }
  }
}

TEST(Laplacian, WithCotangentsIsTheDirichletEnergy)
{
  shapes::Random random(8);
  for (const Shape& surface : Surfaces())
  {
    const SparseMatrix laplacian = MakeLaplacian(surface, LaplacianWeights::Cotangent);
    for (const bool isLinear : { true, false })
    {
      const Eigen::Vector3d direction{ random(), random(), random() };
      const Eigen::VectorXd f = isLinear ? Eigen::VectorXd(surface.Positions * direction)
                                         : Eigen::VectorXd(Eigen::VectorXd::NullaryExpr(
                                             laplacian.rows(), [&random]() { return random(); }));
      double energy = 0.0;
      for (Eigen::Index t = 0; t < surface.Faces.rows(); ++t)
      {
        // The gradient g in the triangle's plane: <g, e> = f(q) - f(p) on edges.
        const Eigen::Vector3d p = surface.Positions.row(surface.Faces(t, 0));
        Eigen::Matrix<double, 3, 2> edges;
        edges.col(0) = surface.Positions.row(surface.Faces(t, 1)).transpose() - p;
        edges.col(1) = surface.Positions.row(surface.Faces(t, 2)).transpose() - p;
        const Eigen::Vector2d differences(f[surface.Faces(t, 1)] - f[surface.Faces(t, 0)],
          f[surface.Faces(t, 2)] - f[surface.Faces(t, 0)]);
        const Eigen::Matrix2d gram = edges.transpose() * edges;
        const Eigen::Vector3d gradient = edges * gram.ldlt().solve(differences);
        energy += gradient.squaredNorm() * 0.5 * edges.col(0).cross(edges.col(1)).norm();
      }
      EXPECT_NEAR(f.dot(laplacian * f), energy, 1e-10 * energy);
    }
  }
}

TEST(Laplacian, WithCotangentsIsTheGradientOfTheArea)
{
  const Shape surface = shapes::Noisy(shapes::Torus(7, 6), 0.05);
  const Points gradient = MakeLaplacian(surface, LaplacianWeights::Cotangent) * surface.Positions;
  constexpr double Step = 1e-5;
  for (Eigen::Index i = 0; i < surface.Positions.size(); ++i)
  {
    Points moved = surface.Positions;
    moved.data()[i] += Step;
    const double plus = Area(moved, surface.Faces);
    moved.data()[i] -= 2.0 * Step;
    const double minus = Area(moved, surface.Faces);
    EXPECT_NEAR(gradient.data()[i], (plus - minus) / (2.0 * Step), 1e-8);
  }
}

TEST(EdgeWeights, OfEquilateralAndRightTriangles)
{
  const double h = std::sqrt(3.0) / 2.0;
  constexpr double Unit = 2.5;
  Shape rhombus; // two equilateral triangles at the edge (0, 1)
  rhombus.Positions =
    Unit * shapes::ToPoints({ { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, h, 0 }, { 0.5, -h, 0 } });
  rhombus.Faces = shapes::ToTriangles({ { 0, 1, 2 }, { 1, 0, 3 } });
  const double cot60 = 1.0 / std::sqrt(3.0);
  const double tan30 = cot60;
  EXPECT_NEAR(WeightOf(rhombus, LaplacianWeights::Cotangent, 0, 1), cot60, 1e-15);
  EXPECT_NEAR(WeightOf(rhombus, LaplacianWeights::Cotangent, 0, 2), 0.5 * cot60, 1e-15);
  EXPECT_NEAR(WeightOf(rhombus, LaplacianWeights::MeanValue, 0, 1), 2 * tan30 / Unit, 1e-15);
  EXPECT_NEAR(WeightOf(rhombus, LaplacianWeights::MeanValue, 2, 0), tan30 / Unit, 1e-15);

  Shape square; // two right triangles at the diagonal (0, 2)
  square.Positions =
    Unit * shapes::ToPoints({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } });
  square.Faces = shapes::ToTriangles({ { 0, 1, 2 }, { 0, 2, 3 } });
  const double tan22 = std::sqrt(2.0) - 1.0; // of half 45 degrees
  EXPECT_NEAR(WeightOf(square, LaplacianWeights::Cotangent, 0, 2), 0.0, 1e-15);
  EXPECT_NEAR(WeightOf(square, LaplacianWeights::Cotangent, 0, 1), 0.5, 1e-15);
  EXPECT_NEAR(WeightOf(square, LaplacianWeights::MeanValue, 0, 2),
    2 * tan22 / (std::sqrt(2.0) * Unit), 1e-15);
  EXPECT_NEAR(WeightOf(square, LaplacianWeights::MeanValue, 0, 1), tan22 / Unit, 1e-15);
  EXPECT_NEAR(WeightOf(square, LaplacianWeights::MeanValue, 1, 0), 1.0 / Unit, 1e-15); // tan 45

  Shape obtuse; // 120 degrees opposite to (0, 1)
  obtuse.Positions = shapes::ToPoints({ { 0, 0, 0 }, { 2 * h, 0, 0 }, { h, 0.5, 0 } });
  obtuse.Faces = shapes::ToTriangles({ { 0, 1, 2 } });
  EXPECT_NEAR(WeightOf(obtuse, LaplacianWeights::Cotangent, 0, 1), -0.5 * cot60, 1e-15);
  EXPECT_NEAR(WeightOf(obtuse, LaplacianWeights::MeanValue, 2, 0), std::sqrt(3.0), 1e-14); // tan 60
}

TEST(EdgeWeights, ScaleAsTheirUnitsSay)
{
  const Shape camel = shapes::RealMesh("camel");
  for (const double unit : { 1e-9, 1e6 })
  {
    Shape scaled = camel;
    scaled.Positions *= unit;
    for (const LaplacianWeights weights : AllWeights)
    {
      const double factor = weights == LaplacianWeights::MeanValue ? unit : 1.0;
      const Eigen::VectorXd a = Weights(camel, weights);
      const Eigen::VectorXd b = factor * Weights(scaled, weights);
      EXPECT_LT(((a - b).array() / (1.0 + a.array().abs())).abs().maxCoeff(), 1e-9);
    }
  }
}

TEST(EdgeWeights, MeanValueIsPositive)
{
  for (const Shape& surface : Surfaces())
  {
    EXPECT_GT(Weights(surface, LaplacianWeights::MeanValue).minCoeff(), 0.0);
  }
}

TEST(EdgeWeights, StayFiniteOnDegenerateTriangles)
{
  // A needle with its tip on the edge, one of coinciding points, a proper one.
  Shape shape;
  shape.Positions =
    shapes::ToPoints({ { 0, 0, 0 }, { 1, 0, 0 }, { 0.4, 0, 0 }, { 0.5, 1, 0 }, { 0.5, 1, 0 } });
  shape.Faces = shapes::ToTriangles({ { 0, 2, 1 }, { 0, 1, 3 }, { 1, 4, 3 } });
  for (const LaplacianWeights weights : AllWeights)
  {
    const Eigen::VectorXd all = Weights(shape, weights);
    EXPECT_TRUE(all.allFinite());
  }
  // The surface stays connected through the degenerate ones.
  for (const LaplacianWeights weights :
    { LaplacianWeights::Cotangent, LaplacianWeights::MeanValue })
  {
    EXPECT_GT(WeightOf(shape, weights, 0, 2), 0.0);
    EXPECT_GT(WeightOf(shape, weights, 2, 1), 0.0);
    EXPECT_GT(WeightOf(shape, weights, 4, 1), 0.0);
  }
  shape.Positions.setZero();
  for (const LaplacianWeights weights : AllWeights)
  {
    EXPECT_TRUE(Weights(shape, weights).allFinite());
  }
}

TEST(Laplacian, HasEmptyRowsForUnusedVertices)
{
  Shape shape = shapes::Plane(2);
  shape.Positions.conservativeResize(11, 3);
  shape.Positions.bottomRows(2).setConstant(std::numeric_limits<double>::quiet_NaN());
  const SparseMatrix laplacian = MakeLaplacian(shape, LaplacianWeights::Cotangent);
  EXPECT_EQ(laplacian.rows(), 11);
  for (const int unused : { 9, 10 })
  {
    EXPECT_EQ(laplacian.col(unused).nonZeros(), 0);
  }
}
