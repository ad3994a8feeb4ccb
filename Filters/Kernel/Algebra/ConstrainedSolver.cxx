// SPDX-License-Identifier: BSD-3-Clause
#include "Algebra/ConstrainedSolver.h"

#include "Base/Bytes.h"

#include <Eigen/SparseCholesky>

#ifdef CARTAN_HAVE_CHOLMOD
#include <cholmod.h>
#ifdef CARTAN_HAVE_OPENMP
#include <omp.h>
#endif
#endif

#include <algorithm>

namespace cartan
{
/// A factorization of a symmetric positive definite matrix, lower triangle.
class ConstrainedSolver::Factor
{
public:
  virtual ~Factor() = default;
  virtual void Analyze(const SparseMatrix& lower) = 0;
  /// Returns false when the matrix is not positive definite.
  virtual bool Factorize(const SparseMatrix& lower) = 0;
  virtual Eigen::MatrixXd Solve(const Eigen::MatrixXd& rightHandSide) = 0;
  virtual std::size_t GetBytes() const = 0;
};

class ConstrainedSolver::EigenFactor : public ConstrainedSolver::Factor
{
public:
  void Analyze(const SparseMatrix& lower) override { this->Cholesky.analyzePattern(lower); }
  bool Factorize(const SparseMatrix& lower) override
  {
    this->Cholesky.factorize(lower);
    return this->Cholesky.info() == Eigen::Success;
  }
  Eigen::MatrixXd Solve(const Eigen::MatrixXd& rightHandSide) override
  {
    Eigen::MatrixXd solution(rightHandSide.rows(), rightHandSide.cols());
    Eigen::Index column = 0;
    for (; column + 3 <= rightHandSide.cols(); column += 3)
    {
      this->SolveColumns<3>(rightHandSide, column, solution);
    }
    for (; column < rightHandSide.cols(); ++column)
    {
      this->SolveColumns<1>(rightHandSide, column, solution);
    }
    return solution;
  }
  std::size_t GetBytes() const override
  {
    return this->Cholesky.rows() > 0 ? BytesOf(this->Cholesky.matrixL().nestedExpression()) +
        2 * static_cast<std::size_t>(this->Cholesky.rows()) * sizeof(int)
                                     : 0;
  }

private:
  /// Forward and backward substitution for Count right-hand sides side by side:
  /// the factor, which no cache holds, passes by once instead of Count times.
  template <int Count>
  void SolveColumns(
    const Eigen::MatrixXd& rightHandSide, Eigen::Index column, Eigen::MatrixXd& solution) const
  {
    using Values =
      Eigen::Matrix<double, Eigen::Dynamic, Count, Count == 1 ? Eigen::ColMajor : Eigen::RowMajor>;
    const SparseMatrix& lower = this->Cholesky.matrixL().nestedExpression();
    const auto& permutation = this->Cholesky.permutationP().indices();
    const int size = static_cast<int>(lower.cols());
    Values values(size, Count);
    for (int i = 0; i < size; ++i)
    {
      values.row(permutation[i]) = rightHandSide.template block<1, Count>(i, column);
    }
    const int* begin = lower.outerIndexPtr();
    const int* row = lower.innerIndexPtr();
    const double* entry = lower.valuePtr();
    for (int j = 0; j < size; ++j)
    {
      const Eigen::Matrix<double, 1, Count> value = values.row(j) / entry[begin[j]];
      values.row(j) = value;
      for (int k = begin[j] + 1; k < begin[j + 1]; ++k)
      {
        values.row(row[k]) -= entry[k] * value;
      }
    }
    for (int j = size - 1; j >= 0; --j)
    {
      Eigen::Matrix<double, 1, Count> value = values.row(j);
      for (int k = begin[j] + 1; k < begin[j + 1]; ++k)
      {
        value -= entry[k] * values.row(row[k]);
      }
      values.row(j) = value / entry[begin[j]];
    }
    for (int i = 0; i < size; ++i)
    {
      solution.template block<1, Count>(i, column) = values.row(permutation[i]);
    }
  }

  Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower> Cholesky;
};

#ifdef CARTAN_HAVE_CHOLMOD
class ConstrainedSolver::CholmodFactor : public ConstrainedSolver::Factor
{
public:
  CholmodFactor()
  {
    cholmod_start(&this->Common);
    // Errors are reported through return values and become exceptions.
    this->Common.print = 0;
    this->Common.error_handler = nullptr;
    this->Common.quick_return_if_not_posdef = 1;
    // The other orderings it would try save little fill on surfaces and take
    // longer than the factorization.
    this->Common.nmethods = 1;
    this->Common.method[0].ordering = CHOLMOD_AMD;
    // Small systems too as L L^T: L D L^T would accept matrices that are not
    // positive.
    this->Common.final_asis = 0;
    this->Common.final_ll = 1;
  }
  ~CholmodFactor() override
  {
    cholmod_free_dense(&this->Solution, &this->Common);
    cholmod_free_dense(&this->Work, &this->Common);
    cholmod_free_dense(&this->WorkE, &this->Common);
    cholmod_free_factor(&this->Factors, &this->Common);
    cholmod_free_factor(&this->Symbolic, &this->Common);
    cholmod_finish(&this->Common);
  }
  CholmodFactor(const CholmodFactor&) = delete;
  CholmodFactor& operator=(const CholmodFactor&) = delete;

  void Analyze(const SparseMatrix& lower) override
  {
    cholmod_free_factor(&this->Symbolic, &this->Common);
    cholmod_sparse view = View(lower);
    this->Symbolic = cholmod_analyze(&view, &this->Common);
  }
  bool Factorize(const SparseMatrix& lower) override
  {
    cholmod_free_factor(&this->Factors, &this->Common);
    cholmod_sparse view = View(lower);
    this->Factors = cholmod_copy_factor(this->Symbolic, &this->Common);
    const SerialOpenMp serial;
    if (!this->Factors || !cholmod_factorize(&view, this->Factors, &this->Common) ||
      this->Common.status != CHOLMOD_OK)
    {
      return false;
    }
    // Supernodes make the factorization fast, but the few right-hand sides of a
    // motion are solved twice as fast by the simplicial factor, which takes four
    // at a time through memory once. It is smaller, too.
    return cholmod_change_factor(CHOLMOD_REAL, 1, 0, 1, 1, this->Factors, &this->Common) != 0;
  }
  Eigen::MatrixXd Solve(const Eigen::MatrixXd& rightHandSide) override
  {
    cholmod_dense view = {};
    view.nrow = rightHandSide.rows();
    view.ncol = rightHandSide.cols();
    view.nzmax = rightHandSide.size();
    view.d = rightHandSide.rows();
    view.x = const_cast<double*>(rightHandSide.data());
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    // The work space is kept: a drag solves the same size again and again.
    if (!cholmod_solve2(CHOLMOD_A, this->Factors, &view, nullptr, &this->Solution, nullptr,
          &this->Work, &this->WorkE, &this->Common))
    {
      throw Error(ErrorCode::SingularSystem, "CHOLMOD could not solve: out of memory.");
    }
    return Eigen::Map<const Eigen::MatrixXd>(
      static_cast<const double*>(this->Solution->x), rightHandSide.rows(), rightHandSide.cols());
  }

  std::size_t GetBytes() const override { return this->Common.memory_inuse; }

private:
  /// CHOLMOD starts OpenMP's threads for the little work around each product of
  /// matrices, which has threads of its own. On few cores they wait for each
  /// other, and the factorization takes up to twice as long, or many times as
  /// long beside other programs.
  class SerialOpenMp
  {
  public:
#ifdef CARTAN_HAVE_OPENMP
    SerialOpenMp()
      : Levels(omp_get_max_active_levels())
    {
      omp_set_max_active_levels(0);
    }
    ~SerialOpenMp()
    {
      omp_set_max_active_levels(this->Levels);
    }
    SerialOpenMp(const SerialOpenMp&) = delete;
    SerialOpenMp& operator=(const SerialOpenMp&) = delete;

  private:
    int Levels;
#else
    SerialOpenMp() {}
#endif
  };

  static cholmod_sparse View(const SparseMatrix& lower)
  {
    cholmod_sparse view = {};
    view.nrow = lower.rows();
    view.ncol = lower.cols();
    view.nzmax = lower.nonZeros();
    view.p = const_cast<int*>(lower.outerIndexPtr());
    view.i = const_cast<int*>(lower.innerIndexPtr());
    view.x = const_cast<double*>(lower.valuePtr());
    view.stype = -1;
    view.itype = CHOLMOD_INT;
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    view.sorted = 1;
    view.packed = 1;
    return view;
  }

  cholmod_common Common;
  cholmod_factor* Symbolic = nullptr;
  cholmod_factor* Factors = nullptr;
  cholmod_dense* Solution = nullptr;
  cholmod_dense* Work = nullptr;
  cholmod_dense* WorkE = nullptr;
};
#endif

namespace
{
/// Refuses parts of the free unknowns that nothing determines.
void RequireConstraints(const SparseMatrix& matrix, const std::vector<char>& isFixed,
  const Eigen::VectorXd& stiffness, const std::vector<int>& vertices)
{
  const int size = static_cast<int>(matrix.rows());
  std::vector<char> visited(size, 0);
  std::vector<int> stack;
  std::vector<int> part;
  IdSample unconstrained;
  int parts = 0;
  for (int seed = 0; seed < size; ++seed)
  {
    if (isFixed[seed] || visited[seed])
    {
      continue;
    }
    bool isConstrained = false;
    part.clear();
    visited[seed] = 1;
    stack.push_back(seed);
    while (!stack.empty())
    {
      const int unknown = stack.back();
      stack.pop_back();
      part.push_back(unknown);
      isConstrained = isConstrained || (stiffness.size() && stiffness[unknown] > 0.0);
      for (SparseMatrix::InnerIterator entry(matrix, unknown); entry; ++entry)
      {
        const int other = static_cast<int>(entry.index());
        if (entry.value() == 0.0 || other == unknown)
        {
          continue;
        }
        if (isFixed[other])
        {
          isConstrained = true;
        }
        else if (!visited[other])
        {
          visited[other] = 1;
          stack.push_back(other);
        }
      }
    }
    if (!isConstrained)
    {
      ++parts;
      std::sort(part.begin(), part.end());
      int lastVertex = -1;
      for (const int unknown : part)
      {
        const int vertex = vertices.empty() ? unknown : vertices[unknown];
        if (vertex != lastVertex)
        {
          lastVertex = vertex;
          unconstrained.Add(vertex);
        }
      }
    }
  }
  if (parts > 0)
  {
    throw Error(ErrorCode::SingularSystem,
      "The system is singular: " + unconstrained.Describe("point", "points") + " in " +
        std::to_string(parts) +
        (parts == 1 ? " connected part have no constraint. Hold"
                    : " connected parts have no constraint. In each part, hold") +
        " at least one point.");
  }
}

bool SamePattern(const SparseMatrix& a, const SparseMatrix& b)
{
  return a.rows() == b.rows() && a.nonZeros() == b.nonZeros() &&
    std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.outerSize() + 1, b.outerIndexPtr()) &&
    std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr());
}
}

bool HasCholmod()
{
#ifdef CARTAN_HAVE_CHOLMOD
  return true;
#else
  return false;
#endif
}

ConstrainedSolver::ConstrainedSolver(SolverBackend backend)
  : Backend(backend)
{
  if (backend == SolverBackend::Automatic)
  {
    this->Backend = HasCholmod() ? SolverBackend::Cholmod : SolverBackend::Eigen;
  }
  if (this->Backend == SolverBackend::Cholmod)
  {
#ifdef CARTAN_HAVE_CHOLMOD
    this->Factors = std::make_unique<CholmodFactor>();
#else
    throw Error(ErrorCode::BadInput, "Cartan was built without CHOLMOD: choose Eigen's solver.");
#endif
  }
  else
  {
    this->Factors = std::make_unique<EigenFactor>();
  }
}

ConstrainedSolver::~ConstrainedSolver() = default;
ConstrainedSolver::ConstrainedSolver(ConstrainedSolver&&) noexcept = default;
ConstrainedSolver& ConstrainedSolver::operator=(ConstrainedSolver&&) noexcept = default;

void ConstrainedSolver::Factorize(const SparseMatrix& matrix, const std::vector<char>& isFixed,
  const Eigen::VectorXd& stiffness, const std::vector<int>& vertices,
  const ExecutionContext& context)
{
  RequireConstraints(matrix, isFixed, stiffness, vertices);
  context.Report(0.1);

  const int size = static_cast<int>(matrix.rows());
  std::vector<int> free;
  this->FreeIndex.assign(size, -1);
  for (int unknown = 0; unknown < size; ++unknown)
  {
    if (!isFixed[unknown])
    {
      this->FreeIndex[unknown] = static_cast<int>(free.size());
      free.push_back(unknown);
    }
  }
  const bool sameFree = free == this->Free;
  this->Free = std::move(free);

  // Both blocks come out column by column with sorted rows, ready to use.
  const int numberOfFree = static_cast<int>(this->Free.size());
  SparseMatrix block(numberOfFree, numberOfFree);
  block.reserve(matrix.nonZeros() / 2 + numberOfFree);
  this->Coupling = SparseMatrix(numberOfFree, size);
  for (int column = 0; column < size; ++column)
  {
    const int freeColumn = this->FreeIndex[column];
    if (freeColumn >= 0)
    {
      block.startVec(freeColumn);
    }
    this->Coupling.startVec(column);
    for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry)
    {
      const int freeRow = this->FreeIndex[entry.index()];
      if (freeRow < 0)
      {
        continue;
      }
      if (freeColumn < 0)
      {
        this->Coupling.insertBack(freeRow, column) = entry.value();
      }
      else if (entry.index() >= column)
      {
        const bool onDiagonal = entry.index() == column;
        block.insertBack(freeRow, freeColumn) =
          entry.value() + (onDiagonal && stiffness.size() ? stiffness[column] : 0.0);
      }
    }
  }
  block.finalize();
  this->Coupling.finalize();

  if (!sameFree || !SamePattern(block, this->FreeBlock))
  {
    this->Factors->Analyze(block);
    ++this->Analyses;
  }
  this->FreeBlock = std::move(block);
  context.Report(0.4);
  ++this->Factorizations;
  if (numberOfFree > 0 && !this->Factors->Factorize(this->FreeBlock))
  {
    // The next call must not reuse what a failure left behind.
    this->FreeBlock = SparseMatrix();
    throw Error(ErrorCode::SingularSystem,
      "The system of " + std::to_string(numberOfFree) +
        " unknowns cannot be factorized: it is singular up to rounding. Repair triangles without "
        "area, or use uniform weights.");
  }
  context.Report(1.0);
}

std::size_t ConstrainedSolver::GetBytes() const
{
  return (this->Factors ? this->Factors->GetBytes() : 0) +
    TotalBytes(this->Free, this->FreeIndex, this->FreeBlock, this->Coupling);
}

Eigen::MatrixXd ConstrainedSolver::SolveFree(const Eigen::MatrixXd& rightHandSide) const
{
  if (this->Free.empty())
  {
    return rightHandSide;
  }
  Eigen::MatrixXd solution = this->Factors->Solve(rightHandSide);
  if (!solution.allFinite())
  {
    throw Error(ErrorCode::SingularSystem,
      "The system of " + std::to_string(this->Free.size()) +
        " unknowns has no finite solution: it is singular up to rounding.");
  }
  return solution;
}

void ConstrainedSolver::Solve(const Eigen::Ref<const Field>& rightHandSide, Field& values) const
{
  Eigen::MatrixXd reduced = -(this->Coupling * values);
  for (std::size_t i = 0; i < this->Free.size(); ++i)
  {
    reduced.row(i) += rightHandSide.row(this->Free[i]);
  }
  const Eigen::MatrixXd solution = this->SolveFree(reduced);
  for (std::size_t i = 0; i < this->Free.size(); ++i)
  {
    values.row(this->Free[i]) = solution.row(i);
  }
}
}
