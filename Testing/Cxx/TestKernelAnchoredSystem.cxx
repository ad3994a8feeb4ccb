// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Algebra/AnchoredSystem.h"
#include "Kernel/Differential/LaplaceOperator.h"
#include "TestShapes.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

namespace
{
using cartan::AnchoredSystem;
using cartan::AnchorMode;
using cartan::Anchors;
using cartan::Field;
using cartan::SparseMatrix;

/// A bumpy plane with its Laplacian, its differential coordinates and a few
/// anchors.
struct Case
{
  Case()
    : Shape(shapes::Noisy(shapes::Saddle(9, 2.0, 0.1), 0.02))
    , Mesh(Shape.NumberOfVertices(), Shape.Faces)
  {
    const cartan::LaplaceOperator laplace(
      this->Mesh, this->Shape.Positions, cartan::LaplacianWeights::Cotangent);
    this->Laplacian = cartan::Laplacian(this->Mesh, laplace.GetWeights());
    this->InverseMass = laplace.GetMass().cwiseInverse();
    this->Differential = this->InverseMass.asDiagonal() * (this->Laplacian * this->Shape.Positions);
    this->Anchored.assign(this->Mesh.NumberOfVertices(), 0);
    for (const int v : { 0, 8, 40, 44, 80 })
    {
      this->Anchored[v] = 1;
    }
  }

  Field Unsolved() const
  {
    Field values = Field::Constant(this->Mesh.NumberOfVertices(), 3, 99.0);
    for (std::size_t v = 0; v < this->Anchored.size(); ++v)
    {
      if (this->Anchored[v])
      {
        values.row(static_cast<Eigen::Index>(v)) =
          this->Shape.Positions.row(static_cast<Eigen::Index>(v));
      }
    }
    return values;
  }

  Anchors Hard() const
  {
    Anchors anchors;
    anchors.IsHard = this->Anchored;
    return anchors;
  }

  Anchors Soft(double stiffness) const
  {
    Anchors anchors;
    anchors.IsHard.assign(this->Anchored.size(), 0);
    anchors.Stiffness.setZero(this->Mesh.NumberOfVertices());
    for (std::size_t v = 0; v < this->Anchored.size(); ++v)
    {
      anchors.Stiffness[static_cast<Eigen::Index>(v)] = this->Anchored[v] ? stiffness : 0.0;
    }
    return anchors;
  }

  shapes::Shape Shape;
  cartan::TriangleMesh Mesh;
  SparseMatrix Laplacian;
  Eigen::VectorXd InverseMass;
  Field Differential;
  std::vector<char> Anchored;
};

TEST(AnchoredSystem, GetsASurfaceBackFromItsDifferentialCoordinates)
{
  const Case test;
  for (const AnchorMode mode : { AnchorMode::Soft, AnchorMode::Hard, AnchorMode::Substituted })
  {
    AnchoredSystem system;
    system.FactorizeFit(test.Laplacian, test.InverseMass,
      mode == AnchorMode::Soft ? test.Soft(1.0) : test.Hard(), mode);
    Field values = test.Unsolved();
    system.Solve(test.Differential, values);
    EXPECT_LT((values - test.Shape.Positions).cwiseAbs().maxCoeff(), 1e-8)
      << static_cast<int>(mode);
  }
}

TEST(AnchoredSystem, FitsNoisyCoordinatesInTheLeastSquaresSense)
{
  const Case test;
  const Field noisy = test.Differential + 0.1 * Field::Random(test.Differential.rows(), 3);
  // M^1/2 (M^-1 L x - d) and the anchors' equations, by QR.
  const Eigen::VectorXd root = test.InverseMass.cwiseSqrt();
  const Eigen::MatrixXd equations = root.asDiagonal() * Eigen::MatrixXd(test.Laplacian);
  const Eigen::MatrixXd wanted = root.cwiseInverse().asDiagonal() * Eigen::MatrixXd(noisy);
  const Field start = test.Unsolved();

  const double weight = 0.7;
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(2 * equations.rows(), equations.cols());
  Eigen::MatrixXd allWanted = Eigen::MatrixXd::Zero(all.rows(), 3);
  all.topRows(equations.rows()) = equations;
  allWanted.topRows(equations.rows()) = wanted;
  std::vector<int> free;
  std::vector<int> held;
  for (int v = 0; v < test.Mesh.NumberOfVertices(); ++v)
  {
    (test.Anchored[v] ? held : free).push_back(v);
    if (test.Anchored[v])
    {
      all(equations.rows() + v, v) = weight;
      allWanted.row(equations.rows() + v) = weight * start.row(v);
    }
  }
  AnchoredSystem soft;
  soft.FactorizeFit(test.Laplacian, test.InverseMass, test.Soft(weight * weight), AnchorMode::Soft);
  Field values = start;
  soft.Solve(noisy, values);
  EXPECT_LT((Eigen::MatrixXd(values) - all.householderQr().solve(allWanted)).norm(), 1e-8);

  AnchoredSystem hard;
  hard.FactorizeFit(test.Laplacian, test.InverseMass, test.Hard(), AnchorMode::Hard);
  values = start;
  hard.Solve(noisy, values);
  const Eigen::MatrixXd ofFree = equations(Eigen::all, free);
  const Eigen::MatrixXd rest =
    wanted - equations(Eigen::all, held) * Eigen::MatrixXd(start)(held, Eigen::all);
  EXPECT_LT(
    (Eigen::MatrixXd(values)(free, Eigen::all) - ofFree.householderQr().solve(rest)).norm(), 1e-8);

  AnchoredSystem substituted;
  substituted.FactorizeFit(test.Laplacian, test.InverseMass, test.Hard(), AnchorMode::Substituted);
  values = start;
  substituted.Solve(noisy, values);
  const Eigen::MatrixXd residual = equations * Eigen::MatrixXd(values) - wanted;
  // The free points' equations hold exactly.
  EXPECT_LT(residual(free, Eigen::all).cwiseAbs().maxCoeff(), 1e-8);
  for (const int v : held)
  {
    EXPECT_EQ(values.row(v), start.row(v));
  }
}

TEST(AnchoredSystem, PullsSoftAnchorsTowardTheirTargets)
{
  const Case test;
  double last = std::numeric_limits<double>::infinity();
  for (const double stiffness : { 0.01, 1.0, 100.0, 1e6 })
  {
    AnchoredSystem system;
    system.Factorize(test.Laplacian, test.Soft(stiffness));
    Field values = test.Unsolved();
    system.Solve(Field::Zero(values.rows(), 3), values);
    double miss = 0.0;
    for (std::size_t v = 0; v < test.Anchored.size(); ++v)
    {
      if (test.Anchored[v])
      {
        const auto row = static_cast<Eigen::Index>(v);
        miss += (values.row(row) - test.Shape.Positions.row(row)).norm();
      }
    }
    EXPECT_LT(miss, last);
    last = miss;
  }
  EXPECT_LT(last, 1e-4);
}

TEST(AnchoredSystem, RepeatsAnchorsForCoordinatesSideBySide)
{
  Anchors anchors = Anchors::After(2, 3);
  anchors.Stiffness.resize(3);
  anchors.Stiffness << 0.0, 2.0, 0.0;
  anchors.Vertices = { 7, 5, 9 };
  const Anchors repeated = anchors.Repeated(3);
  EXPECT_EQ(repeated.IsHard, (std::vector<char>{ 0, 0, 0, 0, 0, 0, 1, 1, 1 }));
  EXPECT_EQ(repeated.Vertices, (std::vector<int>{ 7, 7, 7, 5, 5, 5, 9, 9, 9 }));
  EXPECT_DOUBLE_EQ(repeated.Stiffness[2], 0.0);
  EXPECT_DOUBLE_EQ(repeated.Stiffness[5], 2.0);
}

TEST(AnchoredSystem, NamesVerticesWhereAPartHasNoAnchor)
{
  const shapes::Shape two = shapes::Union(shapes::Plane(2), shapes::Plane(2));
  const cartan::TriangleMesh mesh(two.NumberOfVertices(), two.Faces);
  Anchors anchors = Anchors::After(two.NumberOfVertices(), two.NumberOfVertices());
  anchors.IsHard[0] = 1;
  for (int v = 0; v < two.NumberOfVertices(); ++v)
  {
    anchors.Vertices.push_back(100 + v);
  }
  AnchoredSystem system;
  try
  {
    system.Factorize(
      cartan::Laplacian(mesh, Eigen::VectorXd::Ones(mesh.NumberOfDirectedEdges())), anchors);
    FAIL() << "accepted";
  }
  catch (const cartan::Error& error)
  {
    const int half = two.NumberOfVertices() / 2;
    EXPECT_NE(
      std::string(error.what()).find("ids " + std::to_string(100 + half)), std::string::npos)
      << error.what();
    EXPECT_NE(std::string(error.what()).find("no constraint"), std::string::npos);
  }
}
}
