// SPDX-License-Identifier: BSD-3-Clause
#include "Algebra/EigenFactor.h"

#include "Base/Bytes.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <vector>

namespace cartan
{
namespace
{
/// Forward and backward substitution for Count right-hand sides side by side:
/// the factor, which no cache holds, passes by once instead of Count times.
template <int Count, typename Lower, typename Permutation>
void SolveColumns(const Lower& lower, const Permutation& permutation,
  const Eigen::Ref<const Eigen::MatrixXd>& rightHandSide, Eigen::Index column,
  Eigen::MatrixXd& solution)
{
  using Index = typename Lower::StorageIndex;
  using Values =
    Eigen::Matrix<double, Eigen::Dynamic, Count, Count == 1 ? Eigen::ColMajor : Eigen::RowMajor>;
  const auto size = static_cast<Index>(lower.cols());
  Values values(size, Count);
  for (Index i = 0; i < size; ++i)
  {
    values.row(permutation[i]) = rightHandSide.template block<1, Count>(i, column);
  }
  const Index* begin = lower.outerIndexPtr();
  const Index* row = lower.innerIndexPtr();
  const double* entry = lower.valuePtr();
  for (Index j = 0; j < size; ++j)
  {
    const Eigen::Matrix<double, 1, Count> value = values.row(j) / entry[begin[j]];
    values.row(j) = value;
    for (Index k = begin[j] + 1; k < begin[j + 1]; ++k)
    {
      values.row(row[k]) -= entry[k] * value;
    }
  }
  for (Index j = size - 1; j >= 0; --j)
  {
    Eigen::Matrix<double, 1, Count> value = values.row(j);
    for (Index k = begin[j] + 1; k < begin[j + 1]; ++k)
    {
      value -= entry[k] * values.row(row[k]);
    }
    values.row(j) = value / entry[begin[j]];
  }
  for (Index i = 0; i < size; ++i)
  {
    solution.template block<1, Count>(i, column) = values.row(permutation[i]);
  }
}

/// The entries of L for the upper triangle of a symmetric matrix. Row k of L has an
/// entry at i for each i on the paths of the elimination tree from the entries of
/// column k to k (Davis, Direct Methods for Sparse Linear Systems, 2006, 4.2).
template <typename Matrix>
std::int64_t CountEntries(const Matrix& upper)
{
  using Index = typename Matrix::StorageIndex;
  const auto size = static_cast<Index>(upper.cols());
  std::vector<Index> parent(size, -1);
  std::vector<Index> lastRow(size, -1);
  std::int64_t entries = size; // the diagonal
  for (Index k = 0; k < size; ++k)
  {
    lastRow[k] = k;
    for (typename Matrix::InnerIterator entry(upper, k); entry; ++entry)
    {
      for (auto i = static_cast<Index>(entry.index()); i < k && lastRow[i] != k; i = parent[i])
      {
        parent[i] = parent[i] < 0 ? k : parent[i];
        lastRow[i] = k;
        ++entries;
      }
    }
  }
  return entries;
}

/// With indices of one width.
template <typename Index>
class Llt : public Eigen::SimplicialLLT<Eigen::SparseMatrix<double, Eigen::ColMajor, Index>>
{
public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;

  /// Orders the unknowns, counts the entries of L, and finds its pattern if it has
  /// no more than `limit`, which an Index must be able to count. Returns the count.
  std::int64_t Analyze(const Matrix& lower, std::int64_t limit)
  {
    Matrix ordered(lower.rows(), lower.cols());
    const Matrix* upper = nullptr; // of the lower triangle in the new order
    this->ordering(lower, upper, ordered);
    const std::int64_t entries = CountEntries(*upper);
    if (entries <= limit)
    {
      this->analyzePattern_preordered(*upper, false);
    }
    return entries;
  }

  SolverStatus Factorize(const Matrix& lower)
  {
    this->factorize(lower);
    return this->info() == Eigen::Success ? SolverStatus::Ok : SolverStatus::NotPositiveDefinite;
  }

  void SolveAll(
    const Eigen::Ref<const Eigen::MatrixXd>& rightHandSide, Eigen::MatrixXd& solution) const
  {
    const Matrix& lower = this->matrixL().nestedExpression();
    const auto& permutation = this->permutationP().indices();
    Eigen::Index column = 0;
    for (; column + 4 <= rightHandSide.cols(); column += 4)
    {
      SolveColumns<4>(lower, permutation, rightHandSide, column, solution);
    }
    switch (rightHandSide.cols() - column)
    {
      case 3:
        SolveColumns<3>(lower, permutation, rightHandSide, column, solution);
        break;
      case 2:
        SolveColumns<2>(lower, permutation, rightHandSide, column, solution);
        break;
      case 1:
        SolveColumns<1>(lower, permutation, rightHandSide, column, solution);
        break;
      default:
        break;
    }
  }

  std::size_t GetBytes() const
  {
    // Beside L: the permutation both ways, the elimination tree, the counts.
    return this->rows() > 0
      ? BytesOf(this->m_matrix) + 4 * static_cast<std::size_t>(this->rows()) * sizeof(Index)
      : 0;
  }
};

class EigenFactor : public SymmetricSolver
{
public:
  explicit EigenFactor(const FactorLimits& limits)
    : Limits(limits)
  {
  }

  SolverStatus Analyze(const SparseMatrix& lower) override
  {
    this->Wide.reset();
    this->Narrow.reset();
    // The ordering works on both triangles, a fifth more and two numbers per column.
    const std::int64_t ordering = 2 * lower.nonZeros() / 5 * 6 + 2 * lower.cols();
    bool isNarrow = ordering <= this->Limits.NarrowEntries;
    if (isNarrow)
    {
      this->Narrow = std::make_unique<Llt<int>>();
      this->Entries =
        this->Narrow->Analyze(lower, std::min(this->Limits.NarrowEntries, this->Limits.Entries));
      isNarrow = this->Entries <= this->Limits.NarrowEntries;
    }
    if (!isNarrow)
    {
      this->Narrow.reset();
      this->Wide = std::make_unique<Llt<std::int64_t>>();
      this->Entries = this->Wide->Analyze(WideMatrix(lower), this->Limits.Entries);
    }
    return this->Entries <= this->Limits.Entries ? SolverStatus::Ok : SolverStatus::OutOfMemory;
  }

  SolverStatus Factorize(const SparseMatrix& lower) override
  {
    return this->Wide ? this->Wide->Factorize(lower) : this->Narrow->Factorize(lower);
  }

  SolverStatus Solve(const Eigen::Ref<const Eigen::MatrixXd>& rightHandSide,
    const ExecutionContext& /*context*/) override
  {
    this->Solution.resize(rightHandSide.rows(), rightHandSide.cols());
    this->Wide ? this->Wide->SolveAll(rightHandSide, this->Solution)
               : this->Narrow->SolveAll(rightHandSide, this->Solution);
    return SolverStatus::Ok;
  }

  Eigen::Map<const Eigen::MatrixXd> GetSolution() const override
  {
    return { this->Solution.data(), this->Solution.rows(), this->Solution.cols() };
  }
  std::int64_t GetNumberOfEntries() const override { return this->Entries; }
  std::size_t GetBytes() const override
  {
    return BytesOf(this->Solution) + (this->Narrow ? this->Narrow->GetBytes() : 0) +
      (this->Wide ? this->Wide->GetBytes() : 0);
  }

private:
  using WideMatrix = Llt<std::int64_t>::Matrix;

  FactorLimits Limits;
  std::int64_t Entries = 0;
  std::unique_ptr<Llt<int>> Narrow; // one of both, from Analyze on
  std::unique_ptr<Llt<std::int64_t>> Wide;
  Eigen::MatrixXd Solution;
};
}

std::unique_ptr<SymmetricSolver> MakeEigenFactor(const FactorLimits& limits)
{
  return std::make_unique<EigenFactor>(limits);
}
}
