// SPDX-License-Identifier: BSD-3-Clause
#include "Algebra/MultigridSolver.h"

#ifdef CARTAN_HAVE_HYPRE
#include "Algebra/ConjugateGradients.h"
#include "Base/Bytes.h"

#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_parcsr_ls.h>
#include <_hypre_parcsr_ls.h>
#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <new>
#include <numeric>
#include <random>
#include <vector>
#endif

namespace cartan
{
#ifdef CARTAN_HAVE_HYPRE
namespace
{
using Eigen::Index;
using Eigen::VectorXd;

/// Of the residual and of the error.
constexpr double Tolerance = 1e-10;

/// Laplacians of surfaces take 8 to 20 steps. What takes more than this is no such
/// matrix, and a factorization is faster.
constexpr int MaximumSteps = 100;

/// hypre's coarsening HMIS, its interpolation extended+i, and the most entries of a row
/// of that: on surfaces the number of steps does not grow with the unknowns, and the
/// levels together have about twice the entries of the finest.
constexpr HYPRE_Int Hmis = 10;
constexpr HYPRE_Int ExtendedPlusI = 6;
constexpr HYPRE_Int InterpolationEntries = 4;

/// What making the levels takes at most on surfaces, per entry of the whole matrix: 420
/// bytes per unknown.
constexpr std::size_t BytesPerEntry = 60;

/// hypre's errors and MPI's state belong to the process. A progress callback that runs
/// another solver between two steps comes back on the same thread.
std::recursive_mutex& HypreMutex()
{
  static std::recursive_mutex mutex;
  return mutex;
}

/// Whether MPI and hypre are running, after an attempt to start them.
bool StartHypre()
{
  int isFinalized = 0;
  MPI_Finalized(&isFinalized);
  if (isFinalized)
  {
    return false;
  }
  int isInitialized = 0;
  MPI_Initialized(&isInitialized);
  if (!isInitialized)
  {
    int provided = 0;
    if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided) != MPI_SUCCESS)
    {
      return false;
    }
  }
  static const bool isStarted = HYPRE_Init() == 0;
  return isStarted;
}

/// Where memory is missing, hypre ends the process. So what it will take is asked for
/// before: throws std::bad_alloc.
void RequireMemory(std::size_t bytes)
{
  ::operator delete(::operator new(bytes));
}

/// What hypre's calls since the last status came to.
SolverStatus TakeStatus()
{
  const HYPRE_Int errors = HYPRE_GetError();
  HYPRE_ClearAllErrors();
  return errors == 0              ? SolverStatus::Ok
    : errors & HYPRE_ERROR_MEMORY ? SolverStatus::OutOfMemory
                                  : SolverStatus::Failed;
}

/// A vector of hypre's that is written and read as a whole.
class HypreVector
{
public:
  explicit HypreVector(Index size)
    : Size(static_cast<HYPRE_Int>(size))
  {
    HYPRE_IJVectorCreate(MPI_COMM_SELF, 0, this->Size - 1, &this->Vector);
    HYPRE_IJVectorSetObjectType(this->Vector, HYPRE_PARCSR);
    HYPRE_IJVectorInitialize(this->Vector);
    HYPRE_IJVectorAssemble(this->Vector);
  }
  ~HypreVector() { HYPRE_IJVectorDestroy(this->Vector); }
  HypreVector(const HypreVector&) = delete;
  HypreVector& operator=(const HypreVector&) = delete;

  void Set(const VectorXd& values)
  {
    HYPRE_IJVectorSetValues(this->Vector, this->Size, nullptr, values.data());
  }
  VectorXd Get() const
  {
    VectorXd values(this->Size);
    HYPRE_IJVectorGetValues(this->Vector, this->Size, nullptr, values.data());
    return values;
  }
  HYPRE_ParVector Object() const
  {
    void* object = nullptr;
    HYPRE_IJVectorGetObject(this->Vector, &object);
    return static_cast<HYPRE_ParVector>(object);
  }

private:
  HYPRE_Int Size;
  HYPRE_IJVector Vector = nullptr;
};

/// The whole of a symmetric matrix of which the lower triangle is given.
class HypreMatrix
{
public:
  explicit HypreMatrix(const SparseMatrix& lower)
  {
    const SparseMatrix whole = lower.selfadjointView<Eigen::Lower>();
    const auto size = static_cast<HYPRE_Int>(whole.rows());
    HYPRE_IJMatrixCreate(MPI_COMM_SELF, 0, size - 1, 0, size - 1, &this->Matrix);
    HYPRE_IJMatrixSetObjectType(this->Matrix, HYPRE_PARCSR);
    std::vector<HYPRE_Int> counts(size);
    std::adjacent_difference(
      whole.outerIndexPtr() + 1, whole.outerIndexPtr() + size + 1, counts.begin());
    HYPRE_IJMatrixSetRowSizes(this->Matrix, counts.data());
    HYPRE_IJMatrixInitialize(this->Matrix);
    std::vector<HYPRE_BigInt> rows(size);
    std::iota(rows.begin(), rows.end(), 0);
    HYPRE_IJMatrixSetValues(
      this->Matrix, size, counts.data(), rows.data(), whole.innerIndexPtr(), whole.valuePtr());
    HYPRE_IJMatrixAssemble(this->Matrix);
  }
  ~HypreMatrix() { HYPRE_IJMatrixDestroy(this->Matrix); }
  HypreMatrix(const HypreMatrix&) = delete;
  HypreMatrix& operator=(const HypreMatrix&) = delete;

  HYPRE_ParCSRMatrix Object() const
  {
    void* object = nullptr;
    HYPRE_IJMatrixGetObject(this->Matrix, &object);
    return static_cast<HYPRE_ParCSRMatrix>(object);
  }

private:
  HYPRE_IJMatrix Matrix = nullptr;
};

/// A matrix with its coarser levels.
class Multigrid
{
public:
  explicit Multigrid(const SparseMatrix& lower)
    : Matrix(lower)
    , In(lower.rows())
    , Out(lower.rows())
  {
    HYPRE_BoomerAMGCreate(&this->Levels);
    HYPRE_BoomerAMGSetCoarsenType(this->Levels, Hmis);
    HYPRE_BoomerAMGSetInterpType(this->Levels, ExtendedPlusI);
    HYPRE_BoomerAMGSetPMaxElmts(this->Levels, InterpolationEntries);
    // One V-cycle from zero: with hypre's smoothing, forward before the coarser levels
    // and backward after them, it is a symmetric preconditioner.
    HYPRE_BoomerAMGSetMaxIter(this->Levels, 1);
    HYPRE_BoomerAMGSetTol(this->Levels, 0.0);
    HYPRE_BoomerAMGSetPrintLevel(this->Levels, 0);
    HYPRE_BoomerAMGSetup(
      this->Levels, this->Matrix.Object(), this->In.Object(), this->Out.Object());
  }
  ~Multigrid() { HYPRE_BoomerAMGDestroy(this->Levels); }
  Multigrid(const Multigrid&) = delete;
  Multigrid& operator=(const Multigrid&) = delete;

  /// A v.
  VectorXd Apply(const VectorXd& vector)
  {
    this->In.Set(vector);
    HYPRE_ParCSRMatrixMatvec(
      1.0, this->Matrix.Object(), this->In.Object(), 0.0, this->Out.Object());
    return this->Out.Get();
  }

  /// A V-cycle for A x = r from x = 0.
  VectorXd Precondition(const VectorXd& residual)
  {
    this->In.Set(residual);
    HYPRE_ParVectorSetConstantValues(this->Out.Object(), 0.0);
    HYPRE_BoomerAMGSolve(
      this->Levels, this->Matrix.Object(), this->In.Object(), this->Out.Object());
    return this->Out.Get();
  }

  /// Of the matrices and the interpolations on all levels.
  std::int64_t CountEntries() const
  {
    auto* levels = reinterpret_cast<hypre_ParAMGData*>(this->Levels);
    std::int64_t entries = 0;
    for (HYPRE_Int i = 0; i < hypre_ParAMGDataNumLevels(levels); ++i)
    {
      entries += hypre_ParCSRMatrixNumNonzeros(hypre_ParAMGDataAArray(levels)[i]);
      if (i + 1 < hypre_ParAMGDataNumLevels(levels))
      {
        const auto* local = hypre_ParCSRMatrixDiag(hypre_ParAMGDataPArray(levels)[i]);
        entries += hypre_CSRMatrixNumNonzeros(local);
      }
    }
    return entries;
  }

private:
  HypreMatrix Matrix;
  HypreVector In;
  HypreVector Out;
  HYPRE_Solver Levels = nullptr;
};

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
    if (isFinalized)
    {
      static_cast<void>(this->Levels.release()); // whose communicators are gone
    }
    this->Levels.reset();
  }
  MultigridSolver(const MultigridSolver&) = delete;
  MultigridSolver& operator=(const MultigridSolver&) = delete;

  /// The entries of the whole matrix are known before.
  SolverStatus Analyze(const SparseMatrix& lower) override
  {
    const std::int64_t entries = 2 * static_cast<std::int64_t>(lower.nonZeros()) - lower.rows();
    return entries > std::numeric_limits<HYPRE_Int>::max() ? SolverStatus::TooLarge
      : entries > this->Limits.Entries                     ? SolverStatus::OutOfMemory
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
      RequireMemory(BytesPerEntry * 2 * static_cast<std::size_t>(lower.nonZeros()));
      this->Levels = std::make_unique<Multigrid>(lower);
      this->Entries = this->Levels->CountEntries();
      const SolverStatus status = TakeStatus();
      if (status != SolverStatus::Ok)
      {
        return status;
      }
    }
    // A random right-hand side has a part of each eigenvector. mt19937's numbers are
    // the same everywhere.
    std::mt19937 random(1);
    VectorXd probe(lower.rows());
    std::generate(probe.begin(), probe.end(),
      [&random]() { return static_cast<double>(random()) / std::mt19937::max() - 0.5; });
    return this->Solve(probe, {});
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
    for (Index column = 0; column < rightHandSide.cols(); ++column)
    {
      const double size = static_cast<double>(rightHandSide.cols());
      const SolverStatus status = this->SolveColumn(rightHandSide.col(column), column,
        context.Part(static_cast<double>(column) / size, static_cast<double>(column + 1) / size));
      if (status != SolverStatus::Ok)
      {
        return status;
      }
    }
    return SolverStatus::Ok;
  }

  Eigen::Map<const Eigen::MatrixXd> GetSolution() const override
  {
    return { this->Solution.data(), this->Solution.rows(), this->Solution.cols() };
  }
  std::int64_t GetNumberOfEntries() const override { return this->Entries; }
  std::size_t GetBytes() const override
  {
    // A value and a column per entry; per unknown two vectors, and about four more and
    // two offsets on all levels together.
    return BytesOf(this->Solution) + 12 * static_cast<std::size_t>(this->Entries) +
      56 * static_cast<std::size_t>(this->Solution.rows());
  }

private:
  /// Conjugate gradients measure the norm of A, and their residual drifts from b - A x by
  /// rounding. So they start again from the true one until that is small too.
  SolverStatus SolveColumn(const VectorXd& given, Index column, const ExecutionContext& context)
  {
    // Squares of the largest and smallest numbers are none.
    const double scale = given.cwiseAbs().maxCoeff();
    if (!(scale > 0.0) || !std::isfinite(scale))
    {
      this->Solution.col(column).setConstant(scale);
      return SolverStatus::Ok;
    }
    const VectorXd rightHandSide = given / scale;
    const double size = rightHandSide.norm();
    VectorXd solution = VectorXd::Zero(rightHandSide.size());
    VectorXd residual = rightHandSide;
    bool isIndefinite = false;
    bool hasConverged = true;
    double reduction = Tolerance;
    double progress = 0.0;
    int steps = 0;
    SolverStatus status = SolverStatus::Ok;
    // Written so that NaN is not small.
    while (!(residual.norm() <= Tolerance * size) && hasConverged && steps < MaximumSteps &&
      !isIndefinite && status == SolverStatus::Ok)
    {
      const auto apply = [&](const VectorXd& vector)
      {
        VectorXd image = this->Levels->Apply(vector);
        isIndefinite = isIndefinite || !(vector.dot(image) > 0.0);
        return image;
      };
      const auto report = [&](int /*steps*/, double left)
      {
        // The residual falls on the whole, not in each step.
        progress = std::clamp(0.5 * std::log(left) / std::log(Tolerance), progress, 1.0);
        context.Report(progress);
      };
      const auto precondition = [this](const VectorXd& vector)
      { return this->Levels->Precondition(vector); };
      const ConjugateGradientsGoal goal{ reduction, MaximumSteps - steps };
      const ConjugateGradientsResult result =
        ConjugateGradients(solution, residual, apply, precondition, goal, report);
      hasConverged = result.HasConverged;
      steps += std::max(1, result.Steps); // so that it ends
      residual = rightHandSide - this->Levels->Apply(solution);
      reduction = 0.1 * Tolerance * size / residual.norm();
      status = TakeStatus();
    }
    this->Solution.col(column) = scale * solution;
    if (status != SolverStatus::Ok || isIndefinite)
    {
      return isIndefinite ? SolverStatus::NotPositiveDefinite : status;
    }
    return hasConverged && residual.norm() <= Tolerance * size ? SolverStatus::Ok
                                                               : SolverStatus::NotConverged;
  }

  FactorLimits Limits;
  std::unique_ptr<Multigrid> Levels;
  std::int64_t Entries = 0;
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
