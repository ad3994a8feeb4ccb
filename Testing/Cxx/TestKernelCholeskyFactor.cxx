// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Algebra/ConstrainedSolver.h"
#include "Kernel/Algebra/SparseProduct.h"
#include "Kernel/Algebra/SymmetricSolver.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <set>
#include <vector>

namespace
{
using cartan::Error;
using cartan::ErrorCode;
using cartan::FactorLimits;
using cartan::SolverBackend;
using cartan::SolverStatus;
using cartan::SparseMatrix;
using cartan::SymmetricSolver;

/// The Laplacian of a grid of count x count nodes, `shift` added to its diagonal,
/// whole or its lower triangle.
SparseMatrix Grid(int count, double shift, bool isWhole = false)
{
  std::vector<Eigen::Triplet<double>> entries;
  const auto connect = [&](int i, int j)
  {
    entries.emplace_back(i, i, 1.0);
    entries.emplace_back(j, j, 1.0);
    entries.emplace_back(std::max(i, j), std::min(i, j), -1.0);
    if (isWhole)
    {
      entries.emplace_back(std::min(i, j), std::max(i, j), -1.0);
    }
  };
  for (int y = 0; y < count; ++y)
  {
    for (int x = 0; x < count; ++x)
    {
      const int i = y * count + x;
      entries.emplace_back(i, i, shift);
      if (x + 1 < count)
      {
        connect(i, i + 1);
      }
      if (y + 1 < count)
      {
        connect(i, i + count);
      }
    }
  }
  SparseMatrix matrix(count * count, count * count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

std::vector<SolverBackend> Backends()
{
  std::vector<SolverBackend> backends{ SolverBackend::Eigen };
  if (cartan::HasCholmod())
  {
    backends.push_back(SolverBackend::Cholmod);
  }
  return backends;
}

/// Ranges in parts, the last one first.
cartan::ExecutionContext Parts(int count)
{
  return { [count](int n, const cartan::ExecutionContext::Range& body)
    {
      for (int part = count - 1; part >= 0; --part)
      {
        const auto bound = [&](int i)
        { return static_cast<int>(static_cast<long long>(n) * i / count); };
        if (bound(part) < bound(part + 1))
        {
          body(bound(part), bound(part + 1));
        }
      }
    },
    nullptr };
}

TEST(CholeskyFactor, SolvesSubtreesSideBySideWithTheSameBitsForAnyThreads)
{
  // Large enough to be split. The second matrix is in two parts, one of them a single unknown.
  SparseMatrix whole = Grid(160, 0.1, true);
  for (const bool isInParts : { false, true })
  {
    for (int i = 0; isInParts && i < whole.rows(); ++i)
    {
      whole.coeffRef(i, 0) = whole.coeffRef(0, i) = i == 0 ? 2.0 : 0.0;
    }
    const SparseMatrix lower = SparseMatrix(whole.triangularView<Eigen::Lower>()).pruned();
    for (const SolverBackend backend : Backends())
    {
      for (const bool isWide : { false, true })
      {
        FactorLimits limits;
        limits.NarrowEntries = isWide ? 10 : limits.NarrowEntries;
        const auto factor = cartan::MakeSymmetricSolver(backend, limits);
        ASSERT_EQ(factor->Analyze(lower), SolverStatus::Ok);
        ASSERT_EQ(factor->Factorize(lower), SolverStatus::Ok);
        EXPECT_GT(factor->GetNumberOfEntries(), 400000);
        for (const int columns : { 1, 2, 3, 4, 7 })
        {
          const Eigen::MatrixXd rightHandSide = Eigen::MatrixXd::Random(lower.rows(), columns);
          ASSERT_EQ(factor->Solve(rightHandSide), SolverStatus::Ok);
          const Eigen::MatrixXd solution = factor->GetSolution();
          EXPECT_LT((whole * solution - rightHandSide).cwiseAbs().maxCoeff(), 1e-12);
          for (const int threads : { 2, 3, 8 })
          {
            ASSERT_EQ(factor->Solve(rightHandSide, Parts(threads)), SolverStatus::Ok);
            EXPECT_EQ(factor->GetSolution(), solution) << threads;
          }
        }
      }
    }
  }
}

TEST(CholeskyFactor, SolvesWithNarrowAndWideIndicesForAnyNumberOfColumns)
{
  const SparseMatrix lower = Grid(12, 0.1);
  const Eigen::MatrixXd dense = Grid(12, 0.1, true);
  for (const SolverBackend backend : Backends())
  {
    for (const bool isWide : { false, true })
    {
      FactorLimits limits;
      limits.NarrowEntries = isWide ? 10 : limits.NarrowEntries;
      const auto factor = cartan::MakeSymmetricSolver(backend, limits);
      ASSERT_EQ(factor->Analyze(lower), SolverStatus::Ok);
      ASSERT_EQ(factor->Factorize(lower), SolverStatus::Ok);
      EXPECT_GE(factor->GetNumberOfEntries(), lower.nonZeros());
      EXPECT_GE(factor->GetBytes(), 12 * static_cast<std::size_t>(factor->GetNumberOfEntries()));
      for (int columns = 1; columns <= 9; ++columns)
      {
        const Eigen::MatrixXd rightHandSide = Eigen::MatrixXd::Random(lower.rows(), columns);
        ASSERT_EQ(factor->Solve(rightHandSide), SolverStatus::Ok);
        EXPECT_LT((dense * factor->GetSolution() - rightHandSide).cwiseAbs().maxCoeff(), 1e-12);
      }
      // Some columns of a larger matrix, whose columns lie farther apart.
      const Eigen::MatrixXd larger = Eigen::MatrixXd::Random(lower.rows() + 3, 4);
      ASSERT_EQ(factor->Solve(larger.topRows(lower.rows())), SolverStatus::Ok);
      EXPECT_LT((dense * factor->GetSolution() - larger.topRows(lower.rows())).norm(), 1e-12);
    }
  }
}

TEST(CholeskyFactor, WideFactorsTakeMoreMemoryForTheSameSolution)
{
  const SparseMatrix lower = Grid(30, 0.1);
  const Eigen::MatrixXd rightHandSide = Eigen::MatrixXd::Random(lower.rows(), 3);
  for (const SolverBackend backend : Backends())
  {
    FactorLimits limits;
    const auto narrow = cartan::MakeSymmetricSolver(backend, limits);
    limits.NarrowEntries = 1;
    const auto wide = cartan::MakeSymmetricSolver(backend, limits);
    for (SymmetricSolver* factor : { narrow.get(), wide.get() })
    {
      ASSERT_EQ(factor->Analyze(lower), SolverStatus::Ok);
      ASSERT_EQ(factor->Factorize(lower), SolverStatus::Ok);
      ASSERT_EQ(factor->Solve(rightHandSide), SolverStatus::Ok);
    }
    EXPECT_GT(wide->GetBytes(), narrow->GetBytes());
    EXPECT_EQ(wide->GetNumberOfEntries(), narrow->GetNumberOfEntries());
    EXPECT_LT((wide->GetSolution() - narrow->GetSolution()).norm(), 1e-12);
  }
}

/// The lower triangle of the Kronecker product of Grid with a full 3 x 3 matrix: three
/// unknowns for each node, with the same neighbors.
SparseMatrix GridOfGroups(int count, double shift)
{
  Eigen::Matrix3d coupling;
  coupling << 2.0, 0.5, -0.3, 0.5, 1.5, 0.2, -0.3, 0.2, 1.0;
  const SparseMatrix grid = Grid(count, shift, true);
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index column = 0; column < grid.cols(); ++column)
  {
    for (SparseMatrix::InnerIterator entry(grid, column); entry; ++entry)
    {
      for (int r = 0; r < 3; ++r)
      {
        for (int c = 0; c < 3; ++c)
        {
          if (3 * entry.row() + r >= 3 * column + c)
          {
            entries.emplace_back(3 * static_cast<int>(entry.row()) + r,
              3 * static_cast<int>(column) + c, coupling(r, c) * entry.value());
          }
        }
      }
    }
  }
  SparseMatrix lower(3 * grid.rows(), 3 * grid.cols());
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

TEST(CholeskyFactor, GivesTheSameSolutionWhateverItIsFor)
{
  const SparseMatrix lower = GridOfGroups(30, 0.1);
  const Eigen::MatrixXd rightHandSide = Eigen::MatrixXd::Random(lower.rows(), 3);
  const auto residual = [&](const SymmetricSolver& factor)
  {
    const Eigen::MatrixXd image = lower.selfadjointView<Eigen::Lower>() * factor.GetSolution();
    return (image - rightHandSide).cwiseAbs().maxCoeff();
  };
  for (const SolverBackend backend : Backends())
  {
    for (const int groupSize : { 1, 3, 7 }) // 7 does not divide the number of unknowns
    {
      for (const bool isWide : { false, true })
      {
        std::vector<std::size_t> bytes;
        for (const auto use : { cartan::FactorUse::ManySolves, cartan::FactorUse::FewSolves,
               cartan::FactorUse::OneSolve })
        {
          FactorLimits limits;
          limits.NarrowEntries = isWide ? 10 : limits.NarrowEntries;
          limits.Use = use;
          limits.GroupSize = groupSize;
          const auto factor = cartan::MakeSymmetricSolver(backend, limits);
          ASSERT_EQ(factor->Analyze(lower), SolverStatus::Ok);
          for (int round = 0; round < 2; ++round) // the analysis serves again
          {
            ASSERT_EQ(factor->Factorize(lower), SolverStatus::Ok);
            ASSERT_EQ(factor->Solve(rightHandSide), SolverStatus::Ok);
            EXPECT_LT(residual(*factor), 1e-12);
          }
          bytes.push_back(factor->GetBytes());
        }
        if (backend == SolverBackend::Cholmod)
        {
          EXPECT_LT(bytes[1], bytes[0]);
          EXPECT_LT(bytes[2], bytes[1] / 2);
        }
      }
    }
  }
}

TEST(CholeskyFactor, TellsWhatWentWrong)
{
  for (const SolverBackend backend : Backends())
  {
    const SparseMatrix indefinite = Grid(12, -0.5);
    const auto factor = cartan::MakeSymmetricSolver(backend);
    ASSERT_EQ(factor->Analyze(indefinite), SolverStatus::Ok);
    EXPECT_EQ(factor->Factorize(indefinite), SolverStatus::NotPositiveDefinite);
    // And goes on with a better one of the same pattern.
    EXPECT_EQ(factor->Factorize(Grid(12, 0.5)), SolverStatus::Ok);

    for (const bool isWide : { false, true })
    {
      FactorLimits limits;
      limits.NarrowEntries = isWide ? 10 : limits.NarrowEntries;
      limits.Entries = 200;
      const auto limited = cartan::MakeSymmetricSolver(backend, limits);
      EXPECT_EQ(limited->Analyze(Grid(12, 0.5)), SolverStatus::OutOfMemory);
      EXPECT_EQ(limited->Analyze(Grid(4, 0.5)), SolverStatus::Ok);
      EXPECT_EQ(limited->Factorize(Grid(4, 0.5)), SolverStatus::Ok);
    }
  }
}

TEST(CholeskyFactor, EachStatusHasAMessageOfItsOwn)
{
  EXPECT_NO_THROW(cartan::RequireSolver(SolverStatus::Ok, 7));
  std::set<std::string> messages;
  const std::vector<std::pair<SolverStatus, ErrorCode>> codes = {
    { SolverStatus::NotPositiveDefinite, ErrorCode::NotPositiveDefinite },
    { SolverStatus::TooLarge, ErrorCode::TooLarge },
    { SolverStatus::OutOfMemory, ErrorCode::OutOfMemory },
    { SolverStatus::Failed, ErrorCode::SolverFailed }
  };
  for (const auto& [status, code] : codes)
  {
    try
    {
      cartan::RequireSolver(status, 77);
      FAIL() << "accepted";
    }
    catch (const Error& error)
    {
      EXPECT_EQ(error.GetCode(), code);
      EXPECT_NE(std::string(error.what()).find("77 unknowns"), std::string::npos);
      messages.insert(error.what());
    }
  }
  EXPECT_EQ(messages.size(), codes.size());
}

TEST(CholeskyFactor, ASolverWithoutMemorySaysSoAndWorksAfterwards)
{
  for (const SolverBackend backend : Backends())
  {
    FactorLimits limits;
    limits.Entries = 200;
    cartan::ConstrainedSolver solver(backend, limits);
    const std::vector<char> none(12 * 12, 0);
    try
    {
      solver.Factorize(Grid(12, 0.0, true), none, Eigen::VectorXd::Ones(12 * 12));
      FAIL() << "accepted";
    }
    catch (const Error& error)
    {
      EXPECT_EQ(error.GetCode(), ErrorCode::OutOfMemory);
      EXPECT_NE(std::string(error.what()).find("memory"), std::string::npos);
    }
    const SparseMatrix small = Grid(4, 0.0, true);
    solver.Factorize(small, std::vector<char>(16, 0), Eigen::VectorXd::Ones(16));
    cartan::Field values = cartan::Field::Zero(16, 2);
    solver.Solve(cartan::Field::Ones(16, 2), values);
    EXPECT_LT((values.array() - 1.0).abs().maxCoeff(), 1e-12);
  }
}

TEST(SparseProduct, CountsTheEntriesOfAProduct)
{
  const SparseMatrix matrix = Grid(9, 0.1, true);
  const SparseMatrix product = matrix * matrix;
  EXPECT_EQ(cartan::CountProductEntries(matrix, matrix), product.nonZeros());
  EXPECT_EQ((cartan::CheckedProduct(matrix, matrix, "The system") - product).norm(), 0.0);
}

TEST(SparseProduct, RefusesMoreEntriesThanIndicesCount)
{
  EXPECT_NO_THROW(cartan::RequireIndexable(2147483647, "The system"));
  try
  {
    cartan::RequireIndexable(2147483648, "The system of the frames");
    FAIL() << "accepted";
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.GetCode(), ErrorCode::TooLarge);
    EXPECT_NE(std::string(error.what()).find("The system of the frames has 2147483648 entries"),
      std::string::npos);
  }
}
}
