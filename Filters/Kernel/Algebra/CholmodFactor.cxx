// SPDX-License-Identifier: BSD-3-Clause
#include "Algebra/CholmodFactor.h"

#ifdef CARTAN_HAVE_CHOLMOD
#include "Algebra/TreeSubstitution.h"

#include <cholmod.h>
#ifdef CARTAN_HAVE_OPENMP
#include <omp.h>
#endif

#include <type_traits>
#include <vector>
#endif

namespace cartan
{
#ifdef CARTAN_HAVE_CHOLMOD
namespace
{
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

/// CHOLMOD's functions for indices of 32 bits, and of 64.
struct Narrow
{
  using Index = int;
  static constexpr int Type = CHOLMOD_INT;
  static constexpr auto Start = cholmod_start;
  static constexpr auto Finish = cholmod_finish;
  static constexpr auto Analyze = cholmod_analyze;
  static constexpr auto AnalyzeOrdered = cholmod_analyze_p;
  static constexpr auto CopyFactor = cholmod_copy_factor;
  static constexpr auto Factorize = cholmod_factorize;
  static constexpr auto ChangeFactor = cholmod_change_factor;
  static constexpr auto Solve = cholmod_solve2;
  static constexpr auto FreeFactor = cholmod_free_factor;
  static constexpr auto FreeDense = cholmod_free_dense;
};
struct Wide
{
  using Index = SuiteSparse_long;
  static constexpr int Type = CHOLMOD_LONG;
  static constexpr auto Start = cholmod_l_start;
  static constexpr auto Finish = cholmod_l_finish;
  static constexpr auto Analyze = cholmod_l_analyze;
  static constexpr auto AnalyzeOrdered = cholmod_l_analyze_p;
  static constexpr auto CopyFactor = cholmod_l_copy_factor;
  static constexpr auto Factorize = cholmod_l_factorize;
  static constexpr auto ChangeFactor = cholmod_l_change_factor;
  static constexpr auto Solve = cholmod_l_solve2;
  static constexpr auto FreeFactor = cholmod_l_free_factor;
  static constexpr auto FreeDense = cholmod_l_free_dense;
};

/// A matrix as CHOLMOD sees it; wide indices are a copy.
template <typename Index>
class View
{
public:
  explicit View(const SparseMatrix& lower)
  {
    this->Matrix.nrow = lower.rows();
    this->Matrix.ncol = lower.cols();
    this->Matrix.nzmax = lower.nonZeros();
    if constexpr (std::is_same_v<Index, int>)
    {
      this->Matrix.p = const_cast<int*>(lower.outerIndexPtr());
      this->Matrix.i = const_cast<int*>(lower.innerIndexPtr());
    }
    else
    {
      this->Outer.assign(lower.outerIndexPtr(), lower.outerIndexPtr() + lower.outerSize() + 1);
      this->Inner.assign(lower.innerIndexPtr(), lower.innerIndexPtr() + lower.nonZeros());
      this->Matrix.p = this->Outer.data();
      this->Matrix.i = this->Inner.data();
    }
    this->Matrix.x = const_cast<double*>(lower.valuePtr());
    this->Matrix.stype = -1;
    this->Matrix.itype = std::is_same_v<Index, int> ? CHOLMOD_INT : CHOLMOD_LONG;
    this->Matrix.xtype = CHOLMOD_REAL;
    this->Matrix.dtype = CHOLMOD_DOUBLE;
    this->Matrix.sorted = 1;
    this->Matrix.packed = 1;
  }
  cholmod_sparse* Get() { return &this->Matrix; }

private:
  cholmod_sparse Matrix = {};
  std::vector<Index> Outer;
  std::vector<Index> Inner;
};

/// The pattern of the groups of `size` unknowns of a lower triangle, each of which is full:
/// what the first of each is coupled with. Its values are of no use.
SparseMatrix GroupPattern(const SparseMatrix& lower, int size)
{
  SparseMatrix pattern(lower.rows() / size, lower.cols() / size);
  pattern.reserve(lower.nonZeros() / size / size + pattern.cols());
  for (int group = 0; group < static_cast<int>(pattern.cols()); ++group)
  {
    pattern.startVec(group);
    int last = -1;
    for (SparseMatrix::InnerIterator entry(lower, size * group); entry; ++entry)
    {
      const int row = static_cast<int>(entry.index()) / size;
      if (row != last)
      {
        pattern.insertBack(row, group) = 1.0;
        last = row;
      }
    }
  }
  pattern.finalize();
  return pattern;
}

template <typename Api>
class Factorization : public SymmetricSolver
{
public:
  explicit Factorization(const FactorLimits& limits)
    : Limits(limits)
  {
    Api::Start(&this->Common);
    // Errors are reported through return values and become statuses.
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
  ~Factorization() override
  {
    Api::FreeDense(&this->Solution, &this->Common);
    Api::FreeDense(&this->Work, &this->Common);
    Api::FreeDense(&this->WorkE, &this->Common);
    Api::FreeFactor(&this->Factors, &this->Common);
    Api::FreeFactor(&this->Symbolic, &this->Common);
    Api::Finish(&this->Common);
  }
  Factorization(const Factorization&) = delete;
  Factorization& operator=(const Factorization&) = delete;

  SolverStatus Analyze(const SparseMatrix& lower) override
  {
    Api::FreeFactor(&this->Symbolic, &this->Common);
    std::vector<typename Api::Index> order = this->OrderOfGroups(lower);
    View<typename Api::Index> view(lower);
    this->Common.method[0].ordering = order.empty() ? CHOLMOD_AMD : CHOLMOD_GIVEN;
    this->Symbolic = Api::AnalyzeOrdered(
      view.Get(), order.empty() ? nullptr : order.data(), nullptr, 0, &this->Common);
    if (!this->Symbolic || this->Common.status != CHOLMOD_OK)
    {
      return this->Status();
    }
    this->Entries = static_cast<std::int64_t>(this->Common.lnz);
    if (this->Entries > this->Limits.Entries)
    {
      return SolverStatus::OutOfMemory;
    }
    const bool isWide = Api::Type == CHOLMOD_LONG;
    return !isWide && this->Entries > this->Limits.NarrowEntries ? SolverStatus::TooLarge
                                                                 : SolverStatus::Ok;
  }

  SolverStatus Factorize(const SparseMatrix& lower) override
  {
    Api::FreeFactor(&this->Factors, &this->Common);
    View<typename Api::Index> view(lower);
    this->Factors = Api::CopyFactor(this->Symbolic, &this->Common);
    const SerialOpenMp serial;
    if (!this->Factors || !Api::Factorize(view.Get(), this->Factors, &this->Common) ||
      this->Common.status != CHOLMOD_OK)
    {
      return this->Status();
    }
    if (this->Limits.Use != FactorUse::ManySolves)
    {
      return SolverStatus::Ok;
    }
    // Supernodes make the factorization fast, but the few right-hand sides of a
    // motion are solved twice as fast by the simplicial factor, which takes four
    // at a time through memory once. It is smaller, too.
    if (!Api::ChangeFactor(CHOLMOD_REAL, 1, 0, 1, 1, this->Factors, &this->Common))
    {
      return this->Status();
    }
    this->Substitution.Analyze(this->Columns());
    return SolverStatus::Ok;
  }

  SolverStatus Solve(const Eigen::Ref<const Eigen::MatrixXd>& rightHandSide,
    const ExecutionContext& context) override
  {
    if (this->Limits.Use == FactorUse::ManySolves)
    {
      this->Substitution.Solve(this->Columns(), rightHandSide, this->Solved, context);
      return SolverStatus::Ok;
    }
    cholmod_dense view = {};
    view.nrow = rightHandSide.rows();
    view.ncol = rightHandSide.cols();
    view.nzmax = rightHandSide.outerStride() * rightHandSide.cols();
    view.d = rightHandSide.outerStride();
    view.x = const_cast<double*>(rightHandSide.data());
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    // The work space is kept for the next solve.
    const bool isSolved = Api::Solve(CHOLMOD_A, this->Factors, &view, nullptr, &this->Solution,
      nullptr, &this->Work, &this->WorkE, &this->Common);
    if (this->Limits.Use == FactorUse::OneSolve)
    {
      Api::FreeFactor(&this->Factors, &this->Common);
      Api::FreeDense(&this->Work, &this->Common);
      Api::FreeDense(&this->WorkE, &this->Common);
    }
    return isSolved ? SolverStatus::Ok : this->Status();
  }

  Eigen::Map<const Eigen::MatrixXd> GetSolution() const override
  {
    if (this->Limits.Use == FactorUse::ManySolves)
    {
      return { this->Solved.data(), this->Solved.rows(), this->Solved.cols() };
    }
    return { static_cast<const double*>(this->Solution->x),
      static_cast<Eigen::Index>(this->Solution->nrow),
      static_cast<Eigen::Index>(this->Solution->ncol) };
  }
  std::int64_t GetNumberOfEntries() const override { return this->Entries; }
  std::size_t GetBytes() const override
  {
    return this->Common.memory_inuse + TotalBytes(this->Solved) + this->Substitution.GetBytes();
  }

private:
  /// The simplicial factor.
  FactorColumns<typename Api::Index> Columns() const
  {
    using Index = typename Api::Index;
    return { static_cast<Index>(this->Factors->n), static_cast<const Index*>(this->Factors->p),
      static_cast<const Index*>(this->Factors->i), static_cast<const double*>(this->Factors->x),
      static_cast<const Index*>(this->Factors->Perm) };
  }

  /// The order of the unknowns by that of their groups: nested dissection (METIS), with half
  /// of the operations of AMD's order and four fifths of its entries, where that saves more
  /// than it takes. Of unknowns one by one it never does. Empty where there are no groups or
  /// CHOLMOD was built without METIS.
  std::vector<typename Api::Index> OrderOfGroups(const SparseMatrix& lower)
  {
    const int size = this->Limits.GroupSize;
    if (size <= 1 || lower.rows() % size != 0)
    {
      return {};
    }
    const SparseMatrix pattern = GroupPattern(lower, size);
    View<typename Api::Index> groups(pattern);
    constexpr Eigen::Index fewest = 50000; // on surfaces
    this->Common.method[0].ordering = pattern.rows() < fewest ? CHOLMOD_AMD : CHOLMOD_METIS;
    cholmod_factor* ordered = Api::Analyze(groups.Get(), &this->Common);
    std::vector<typename Api::Index> order;
    for (std::size_t i = 0; ordered && i < ordered->n; ++i)
    {
      const auto group = static_cast<const typename Api::Index*>(ordered->Perm)[i];
      for (int k = 0; k < size; ++k)
      {
        order.push_back(size * group + k);
      }
    }
    Api::FreeFactor(&ordered, &this->Common);
    return order;
  }

  SolverStatus Status() const
  {
    switch (this->Common.status)
    {
      case CHOLMOD_NOT_POSDEF:
      case CHOLMOD_DSMALL:
        return SolverStatus::NotPositiveDefinite;
      case CHOLMOD_TOO_LARGE:
        return SolverStatus::TooLarge;
      case CHOLMOD_OUT_OF_MEMORY:
        return SolverStatus::OutOfMemory;
      default:
        return SolverStatus::Failed;
    }
  }

  FactorLimits Limits;
  std::int64_t Entries = 0;
  cholmod_common Common;
  cholmod_factor* Symbolic = nullptr;
  cholmod_factor* Factors = nullptr;
  TreeSubstitution<typename Api::Index> Substitution;
  Eigen::MatrixXd Solved;
  cholmod_dense* Solution = nullptr;
  cholmod_dense* Work = nullptr;
  cholmod_dense* WorkE = nullptr;
};

/// Begins with narrow indices and goes on with wide ones where these do not
/// suffice.
class CholmodFactor : public SymmetricSolver
{
public:
  explicit CholmodFactor(const FactorLimits& limits)
    : Limits(limits)
    , Current(std::make_unique<Factorization<Narrow>>(limits))
  {
  }

  SolverStatus Analyze(const SparseMatrix& lower) override
  {
    if (this->IsWide)
    {
      this->Current = std::make_unique<Factorization<Narrow>>(this->Limits);
      this->IsWide = false;
    }
    const SolverStatus status = this->Current->Analyze(lower);
    return status == SolverStatus::TooLarge ? this->Widen(lower) : status;
  }

  SolverStatus Factorize(const SparseMatrix& lower) override
  {
    SolverStatus status = this->Current->Factorize(lower);
    // Supernodes take more entries than L has, which the analysis counts.
    if (status == SolverStatus::TooLarge && !this->IsWide)
    {
      status = this->Widen(lower);
      status = status == SolverStatus::Ok ? this->Current->Factorize(lower) : status;
    }
    return status;
  }

  SolverStatus Solve(const Eigen::Ref<const Eigen::MatrixXd>& rightHandSide,
    const ExecutionContext& context) override
  {
    return this->Current->Solve(rightHandSide, context);
  }
  Eigen::Map<const Eigen::MatrixXd> GetSolution() const override
  {
    return this->Current->GetSolution();
  }
  std::int64_t GetNumberOfEntries() const override { return this->Current->GetNumberOfEntries(); }
  std::size_t GetBytes() const override { return this->Current->GetBytes(); }

private:
  SolverStatus Widen(const SparseMatrix& lower)
  {
    this->IsWide = true;
    this->Current = std::make_unique<Factorization<Wide>>(this->Limits);
    return this->Current->Analyze(lower);
  }

  FactorLimits Limits;
  bool IsWide = false;
  std::unique_ptr<SymmetricSolver> Current;
};
}
#endif

std::unique_ptr<SymmetricSolver> MakeCholmodFactor(const FactorLimits& limits)
{
#ifdef CARTAN_HAVE_CHOLMOD
  return std::make_unique<CholmodFactor>(limits);
#else
  static_cast<void>(limits);
  return nullptr;
#endif
}
}
