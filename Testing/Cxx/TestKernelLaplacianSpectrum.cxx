// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Spectral/LaplacianSpectrum.h"

#include "Kernel/Base/Error.h"
#include "Kernel/Differential/Laplacian.h"
#include "Kernel/Mesh/Geometry.h"
#include "RealMeshes.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <numeric>

using cartan::ComputeSpectrum;
using cartan::LaplacianSpectrum;
using cartan::SpectrumOperator;
using cartan::TriangleMesh;
using shapes::MakeMesh;
using shapes::Shape;

namespace
{
constexpr std::uint64_t Gigabyte = 1000000000;

LaplacianSpectrum Spectrum(const Shape& shape, SpectrumOperator kind, int count)
{
  return ComputeSpectrum(MakeMesh(shape), shape.Positions, kind, count, 4 * Gigabyte);
}

/// max |L phi - lambda M phi| over the largest eigenvalue that the matrix can have, and
/// max |Phi^T M Phi - I|.
std::pair<double, double> ResidualAndOrthonormality(
  const Shape& shape, SpectrumOperator kind, const LaplacianSpectrum& spectrum)
{
  const TriangleMesh mesh = MakeMesh(shape);
  const cartan::SparseMatrix laplacian = cartan::Laplacian(mesh,
    cartan::EdgeWeights(mesh, shape.Positions,
      kind == SpectrumOperator::Graph ? cartan::LaplacianWeights::Uniform
                                      : cartan::LaplacianWeights::Cotangent));
  const Eigen::MatrixXd weighted = spectrum.Mass.asDiagonal() * spectrum.Modes;
  const Eigen::MatrixXd residual =
    laplacian * spectrum.Modes - weighted * spectrum.Eigenvalues.asDiagonal();
  const Eigen::MatrixXd gram = spectrum.Modes.transpose() * weighted;
  // In the norm of M^-1, as residuals of the standard problem are measured.
  const Eigen::VectorXd scaled =
    (spectrum.Mass.array() > 0.0)
      .select(spectrum.Mass.cwiseMax(1e-300).cwiseSqrt().cwiseInverse(),
        Eigen::VectorXd::Zero(spectrum.Mass.size()));
  const double largest = 2.0 * laplacian.diagonal().cwiseProduct(scaled.cwiseAbs2()).maxCoeff();
  return { (scaled.asDiagonal() * residual).colwise().norm().maxCoeff() / largest,
    (gram - Eigen::MatrixXd::Identity(gram.rows(), gram.cols())).cwiseAbs().maxCoeff() };
}
}

TEST(LaplacianSpectrum, OfASphereIsThatOfSphericalHarmonics)
{
  // l (l + 1) / R^2, each 2 l + 1 times.
  const double radius = 2.0;
  const LaplacianSpectrum spectrum =
    Spectrum(shapes::Icosphere(5, radius), SpectrumOperator::Cotangent, 25);
  int k = 0;
  for (int l = 0; l < 5; ++l)
  {
    for (int m = 0; m < 2 * l + 1; ++m, ++k)
    {
      const double expected = l * (l + 1) / (radius * radius);
      EXPECT_NEAR(spectrum.Eigenvalues[k], expected, 0.01 * expected + 1e-9) << k;
    }
  }
}

class SpectrumOfAGrid : public testing::TestWithParam<std::tuple<int, int, int>>
{
};

TEST_P(SpectrumOfAGrid, IsKnownInClosedForm)
{
  // A torus grid of m x n vertices with diagonals: a circulant graph, whose eigenvalues are
  // 6 - 2 cos a - 2 cos b - 2 cos (a + b), twelve of them equal where m = n.
  const auto [m, n, few] = GetParam();
  std::vector<double> expected;
  for (int i = 0; i < m; ++i)
  {
    for (int j = 0; j < n; ++j)
    {
      const double a = 2.0 * cartan::Pi * i / m;
      const double b = 2.0 * cartan::Pi * j / n;
      expected.push_back(6.0 - 2.0 * std::cos(a) - 2.0 * std::cos(b) - 2.0 * std::cos(a + b));
    }
  }
  std::sort(expected.begin(), expected.end());
  const Shape torus = shapes::Torus(m, n);
  for (const int count : { few, n < 40 ? m * n : few + 9 })
  {
    const LaplacianSpectrum spectrum = Spectrum(torus, SpectrumOperator::Graph, count);
    for (int k = 0; k < count; ++k)
    {
      EXPECT_NEAR(spectrum.Eigenvalues[k], expected[k], 1e-10) << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(LaplacianSpectrum, SpectrumOfAGrid,
  testing::Values(std::make_tuple(20, 15, 12), std::make_tuple(44, 44, 60)));

TEST(LaplacianSpectrum, SpansTheSpaceOfADenseDecomposition)
{
  const Shape shape = shapes::Union(shapes::Noisy(shapes::Torus(26, 18), 0.03), shapes::Plane(9));
  const TriangleMesh mesh = MakeMesh(shape);
  for (const SpectrumOperator kind : { SpectrumOperator::Graph, SpectrumOperator::Cotangent })
  {
    const LaplacianSpectrum some = Spectrum(shape, kind, 40);
    const LaplacianSpectrum all = Spectrum(shape, kind, shape.NumberOfVertices());
    EXPECT_LT((some.Eigenvalues - all.Eigenvalues.head(40)).cwiseAbs().maxCoeff(),
      1e-10 * all.Eigenvalues.maxCoeff());
    // Projectors, because modes of equal eigenvalues are any basis. Cut at a gap.
    int cut = 40;
    while (all.Eigenvalues[cut] - all.Eigenvalues[cut - 1] < 1e-3 * all.Eigenvalues[cut])
    {
      --cut;
    }
    const auto projector = [cut](const LaplacianSpectrum& spectrum)
    {
      const Eigen::MatrixXd first =
        spectrum.Mass.cwiseSqrt().asDiagonal() * spectrum.Modes.leftCols(cut);
      return Eigen::MatrixXd(first * first.transpose());
    };
    EXPECT_LT((projector(some) - projector(all)).norm(), 1e-9);
    EXPECT_NEAR(some.Eigenvalues[0], 0.0, 1e-9 * all.Eigenvalues.maxCoeff());
    EXPECT_NEAR(some.Eigenvalues[1], 0.0, 1e-9 * all.Eigenvalues.maxCoeff()); // two components
    EXPECT_GT(some.Eigenvalues[2], 1e-6 * all.Eigenvalues.maxCoeff());
  }
}

TEST(LaplacianSpectrum, FindsEigenvaluesOfHighMultiplicity)
{
  // Six copies of a surface: each eigenvalue six times, more often than a block of vectors
  // has columns.
  const Shape one = shapes::Noisy(shapes::Torus(26, 18), 0.03);
  Shape copies = one;
  for (int i = 1; i < 6; ++i)
  {
    copies = shapes::Union(copies, one);
  }
  const LaplacianSpectrum single = Spectrum(one, SpectrumOperator::Graph, 20);
  const LaplacianSpectrum spectrum = Spectrum(copies, SpectrumOperator::Graph, 6 * 20);
  for (int k = 0; k < 6 * 20; ++k)
  {
    EXPECT_NEAR(spectrum.Eigenvalues[k], single.Eigenvalues[k / 6], 1e-10) << k;
  }
  const auto [residual, orthonormality] =
    ResidualAndOrthonormality(copies, SpectrumOperator::Graph, spectrum);
  EXPECT_LT(residual, 1e-10);
  EXPECT_LT(orthonormality, 1e-12);
}

TEST(LaplacianSpectrum, DoesNotDependOnTheNumberOfThreads)
{
  const Shape shape = shapes::Noisy(shapes::Torus(60, 40), 0.03);
  const cartan::ExecutionContext pieces(
    [](int n, const cartan::ExecutionContext::Range& body)
    {
      body(n / 3, n);
      body(0, n / 3);
    },
    {});
  const LaplacianSpectrum whole = Spectrum(shape, SpectrumOperator::Cotangent, 30);
  const LaplacianSpectrum split = ComputeSpectrum(MakeMesh(shape), shape.Positions,
    SpectrumOperator::Cotangent, 30, Gigabyte, cartan::SolverBackend::Automatic, pieces);
  EXPECT_EQ(whole.Modes, split.Modes);
  EXPECT_EQ(whole.Eigenvalues, split.Eigenvalues);
}

TEST(LaplacianSpectrum, OfACamelIsAccurate)
{
  const Shape camel = shapes::RealMesh("camel");
  for (const SpectrumOperator kind : { SpectrumOperator::Graph, SpectrumOperator::Cotangent })
  {
    const LaplacianSpectrum spectrum = Spectrum(camel, kind, 500);
    const auto [residual, orthonormality] = ResidualAndOrthonormality(camel, kind, spectrum);
    shapes::ShowFigure("residual", residual);
    shapes::ShowFigure("orthonormality", orthonormality);
    EXPECT_LT(residual, 1e-10);
    EXPECT_LT(orthonormality, 1e-12);
  }
}

TEST(LaplacianSpectrum, ApproximatesSurfacesAsPublished)
{
  // RMS distance of the sum of n modes of the graph, in parts of the bounding box's diagonal.
  struct Case
  {
    const char* Mesh;
    double Errors[3];
  };
  const int counts[] = { 20, 100, 500 };
  for (const Case& asked : { Case{ "elephant", { 0.0239, 0.00675, 0.00287 } },
         Case{ "camel", { 0.0311, 0.0111, 0.0033 } } })
  {
    Shape shape = shapes::RealMesh(asked.Mesh);
    shape.Positions /=
      (shape.Positions.colwise().maxCoeff() - shape.Positions.colwise().minCoeff()).norm();
    const LaplacianSpectrum spectrum = Spectrum(shape, SpectrumOperator::Graph, 500);
    const Eigen::MatrixXd coefficients = spectrum.Coefficients(shape.Positions);
    for (int i = 0; i < 3; ++i)
    {
      const double error =
        std::sqrt((spectrum.Sum(coefficients, 0, counts[i]) - shape.Positions).squaredNorm() /
          shape.NumberOfVertices());
      shapes::ShowFigure(std::string(asked.Mesh) + " " + std::to_string(counts[i]), error);
      EXPECT_LT(error, 1.01 * asked.Errors[i]);
    }
  }
}

TEST(LaplacianSpectrum, SumsAllModesToTheSurface)
{
  const Shape shape = shapes::Noisy(shapes::Icosphere(2), 0.1);
  for (const SpectrumOperator kind : { SpectrumOperator::Graph, SpectrumOperator::Cotangent })
  {
    const LaplacianSpectrum spectrum = Spectrum(shape, kind, shape.NumberOfVertices());
    const Eigen::MatrixXd coefficients = spectrum.Coefficients(shape.Positions);
    EXPECT_LT(
      (spectrum.Sum(coefficients, 0, shape.NumberOfVertices()) - shape.Positions).norm(), 1e-11);
    // Low and high frequencies are complements.
    EXPECT_LT((spectrum.Sum(coefficients, 0, 9) +
                spectrum.Sum(coefficients, 9, shape.NumberOfVertices()) - shape.Positions)
                .norm(),
      1e-11);
  }
}

TEST(LaplacianSpectrum, RefusesWhatCannotBe)
{
  const Shape shape = shapes::Icosphere(3);
  const auto messageOf = [&](int count, std::uint64_t bytes)
  {
    try
    {
      ComputeSpectrum(MakeMesh(shape), shape.Positions, SpectrumOperator::Graph, count, bytes);
    }
    catch (const cartan::Error& error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(messageOf(0, Gigabyte).find("1 to 642"), std::string::npos);
  EXPECT_NE(messageOf(643, Gigabyte).find("1 to 642"), std::string::npos);
  const std::string tooMany = messageOf(100, 1000000);
  ASSERT_NE(tooMany.find("at most 33"), std::string::npos) << tooMany;
  EXPECT_EQ(messageOf(33, 1000000), "");
}

TEST(LaplacianSpectrum, LeavesUnusedVerticesOutAndStopsOnRequest)
{
  Shape shape = shapes::Noisy(shapes::Torus(30, 20), 0.02);
  shape.Positions.conservativeResize(shape.NumberOfVertices() + 1, 3);
  shape.Positions.bottomRows<1>().setConstant(7.0);
  const LaplacianSpectrum spectrum = Spectrum(shape, SpectrumOperator::Cotangent, 10);
  EXPECT_EQ(spectrum.Mass[600], 0.0);
  EXPECT_TRUE(spectrum.Modes.row(600).isZero(0.0));
  EXPECT_GT(spectrum.Eigenvalues[1], 1e-3);
  const cartan::ExecutionContext stop({}, [](double fraction) { return fraction < 0.4; });
  EXPECT_THROW(ComputeSpectrum(MakeMesh(shape), shape.Positions, SpectrumOperator::Graph, 10,
                 Gigabyte, cartan::SolverBackend::Automatic, stop),
    cartan::Error);
}
