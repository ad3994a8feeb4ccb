// SPDX-License-Identifier: BSD-3-Clause
#include "Algebra/MultigridSolver.h"

#ifdef CARTAN_HAVE_HYPRE
#include "Algebra/HypreMultigrid.h"
#include "Base/Bytes.h"

#include <algorithm>
#include <limits>
#endif

namespace cartan
{
#ifdef CARTAN_HAVE_HYPRE
namespace
{
using Eigen::Index;

class MultigridSolver : public SymmetricSolver
{
public:
  explicit MultigridSolver(const FactorLimits& limits)
    : Limits(limits)
  {
  }
  ~MultigridSolver() override
  {
    const std::lock_guard<std::recursive_mutex> guard(HypreMutex());
    int isFinalized = 0;
    MPI_Finalized(&isFinalized);
    if (isFinalized && this->Levels)
    {
      this->Levels->Abandon();
    }
    this->Levels.reset();
  }
  MultigridSolver(const MultigridSolver&) = delete;
  MultigridSolver& operator=(const MultigridSolver&) = delete;

  /// The entries of the whole matrix are known before.
  SolverStatus Analyze(const SparseMatrix& lower) override
  {
    const std::int64_t entries = 2 * static_cast<std::int64_t>(lower.nonZeros()) - lower.rows();
    return entries > std::numeric_limits<int>::max() ? SolverStatus::TooLarge
      : entries > this->Limits.Entries               ? SolverStatus::OutOfMemory
                                                     : SolverStatus::Ok;
  }

  SolverStatus Factorize(const SparseMatrix& lower) override
  {
    {
      const std::lock_guard<std::recursive_mutex> guard(HypreMutex());
      if (!StartHypre())
      {
        return SolverStatus::Failed;
      }
      this->Levels.reset();
      RequireHypreMemory(2 * static_cast<std::size_t>(lower.nonZeros()));
      this->Levels = std::make_unique<HypreMultigrid>(MPI_COMM_SELF, RowsOfSymmetric(lower));
      this->Entries = this->Levels->CountEntries();
      const SolverStatus status = TakeHypreStatus();
      if (status != SolverStatus::Ok)
      {
        return status;
      }
    }
    return this->Solve(ProbeVector(lower.rows()), {});
  }

  SolverStatus Solve(const Eigen::Ref<const Eigen::MatrixXd>& rightHandSide,
    const ExecutionContext& context) override
  {
    const std::lock_guard<std::recursive_mutex> guard(HypreMutex());
    if (!StartHypre())
    {
      return SolverStatus::Failed;
    }
    this->Solution.resize(rightHandSide.rows(), rightHandSide.cols());
    this->Steps = 0;
    for (Index column = 0; column < rightHandSide.cols(); ++column)
    {
      const double size = static_cast<double>(rightHandSide.cols());
      const ExecutionContext part =
        context.Part(static_cast<double>(column) / size, static_cast<double>(column + 1) / size);
      const MultigridResult result = SolveByMultigrid(*this->Levels, rightHandSide.col(column),
        this->Solution.col(column), [&part](double progress) { part.Report(progress); });
      this->Steps = std::max(this->Steps, result.Steps);
      if (result.Status != SolverStatus::Ok)
      {
        return result.Status;
      }
    }
    return SolverStatus::Ok;
  }

  Eigen::Map<const Eigen::MatrixXd> GetSolution() const override
  {
    return { this->Solution.data(), this->Solution.rows(), this->Solution.cols() };
  }
  std::int64_t GetNumberOfEntries() const override { return this->Entries; }
  int GetNumberOfSteps() const override { return this->Steps; }
  std::size_t GetBytes() const override
  {
    // A value and a column per entry; per unknown two vectors, and about four more and
    // two offsets on all levels together.
    return BytesOf(this->Solution) + 12 * static_cast<std::size_t>(this->Entries) +
      56 * static_cast<std::size_t>(this->Solution.rows());
  }

private:
  FactorLimits Limits;
  std::unique_ptr<HypreMultigrid> Levels;
  std::int64_t Entries = 0;
  int Steps = 0;
  Eigen::MatrixXd Solution;
};
}
#endif

bool HasHypre()
{
#ifdef CARTAN_HAVE_HYPRE
  return true;
#else
  return false;
#endif
}

std::unique_ptr<SymmetricSolver> MakeMultigridSolver(const FactorLimits& limits)
{
#ifdef CARTAN_HAVE_HYPRE
  return std::make_unique<MultigridSolver>(limits);
#else
  static_cast<void>(limits);
  return nullptr;
#endif
}
}
