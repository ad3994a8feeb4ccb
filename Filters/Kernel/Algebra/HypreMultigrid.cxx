// SPDX-License-Identifier: BSD-3-Clause
#ifdef CARTAN_HAVE_HYPRE
#include "Algebra/HypreMultigrid.h"

#include "Algebra/ConjugateGradients.h"

#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_parcsr_ls.h>
#include <_hypre_parcsr_ls.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <numeric>
#include <random>
#include <utility>

namespace cartan
{
namespace
{
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

/// Of smoothing, before and after the coarser levels: with two there are a third fewer steps, and
/// messages, than with one, in the same time altogether.
constexpr HYPRE_Int Sweeps = 2;

/// What making the levels takes at most on surfaces, per entry of the whole matrix: 420
/// bytes per unknown.
constexpr std::size_t BytesPerEntry = 60;

/// The rows that this process has.
struct RowRange
{
  HYPRE_BigInt First;
  HYPRE_BigInt Last;
  HYPRE_Int Size() const { return static_cast<HYPRE_Int>(this->Last - this->First + 1); }
};

/// A vector of hypre's that is written and read as a whole.
class HypreVector
{
public:
  HypreVector(MPI_Comm communicator, const RowRange& range)
    : Size(range.Size())
  {
    HYPRE_IJVectorCreate(communicator, range.First, range.Last, &this->Vector);
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

class HypreMatrix
{
public:
  HypreMatrix(MPI_Comm communicator, const RowRange& range, const MatrixRows& rows)
  {
    HYPRE_IJMatrixCreate(
      communicator, range.First, range.Last, range.First, range.Last, &this->Matrix);
    HYPRE_IJMatrixSetObjectType(this->Matrix, HYPRE_PARCSR);
    std::vector<HYPRE_Int> counts(rows.Counts.begin(), rows.Counts.end());
    HYPRE_IJMatrixSetRowSizes(this->Matrix, counts.data());
    HYPRE_IJMatrixInitialize(this->Matrix);
    std::vector<HYPRE_BigInt> ids(counts.size());
    std::iota(ids.begin(), ids.end(), range.First);
    HYPRE_IJMatrixSetValues(this->Matrix, range.Size(), counts.data(), ids.data(),
      rows.Columns.data(), rows.Values.data());
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

RowRange RangeOf(const MatrixRows& rows)
{
  return { static_cast<HYPRE_BigInt>(rows.First),
    static_cast<HYPRE_BigInt>(rows.First + static_cast<std::int64_t>(rows.Counts.size()) - 1) };
}

double NormOf(const VectorXd& vector, const Reductions& reductions)
{
  return std::sqrt(reductions.Sum(vector.squaredNorm()));
}
}

void RequireHypreMemory(std::size_t entries)
{
  ::operator delete(::operator new(BytesPerEntry* entries));
}

std::recursive_mutex& HypreMutex()
{
  static std::recursive_mutex mutex;
  return mutex;
}

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

SolverStatus TakeHypreStatus()
{
  const HYPRE_Int errors = HYPRE_GetError();
  HYPRE_ClearAllErrors();
  return errors == 0              ? SolverStatus::Ok
    : errors & HYPRE_ERROR_MEMORY ? SolverStatus::OutOfMemory
                                  : SolverStatus::Failed;
}

MatrixRows RowsOfSymmetric(const SparseMatrix& lower)
{
  const SparseMatrix whole = lower.selfadjointView<Eigen::Lower>();
  const Eigen::Index size = whole.rows();
  MatrixRows rows;
  rows.Counts.resize(static_cast<std::size_t>(size));
  std::adjacent_difference(
    whole.outerIndexPtr() + 1, whole.outerIndexPtr() + size + 1, rows.Counts.begin());
  rows.Columns.assign(whole.innerIndexPtr(), whole.innerIndexPtr() + whole.nonZeros());
  rows.Values.assign(whole.valuePtr(), whole.valuePtr() + whole.nonZeros());
  return rows;
}

class HypreMultigrid::Objects
{
public:
  Objects(MPI_Comm communicator, MatrixRows&& rows)
    : Range(RangeOf(rows))
    , Matrix(communicator, this->Range, rows)
    , In(communicator, this->Range)
    , Out(communicator, this->Range)
  {
    rows = {};
    HYPRE_BoomerAMGCreate(&this->Levels);
    HYPRE_BoomerAMGSetCoarsenType(this->Levels, Hmis);
    HYPRE_BoomerAMGSetInterpType(this->Levels, ExtendedPlusI);
    HYPRE_BoomerAMGSetPMaxElmts(this->Levels, InterpolationEntries);
    // One V-cycle from zero: with hypre's smoothing, forward before the coarser levels
    // and backward after them, it is a symmetric preconditioner.
    HYPRE_BoomerAMGSetNumSweeps(this->Levels, Sweeps);
    HYPRE_BoomerAMGSetMaxIter(this->Levels, 1);
    HYPRE_BoomerAMGSetTol(this->Levels, 0.0);
    HYPRE_BoomerAMGSetPrintLevel(this->Levels, 0);
    HYPRE_BoomerAMGSetup(
      this->Levels, this->Matrix.Object(), this->In.Object(), this->Out.Object());
  }
  ~Objects() { HYPRE_BoomerAMGDestroy(this->Levels); }
  Objects(const Objects&) = delete;
  Objects& operator=(const Objects&) = delete;

  RowRange Range;
  HypreMatrix Matrix;
  HypreVector In;
  HypreVector Out;
  HYPRE_Solver Levels = nullptr;
};

HypreMultigrid::HypreMultigrid(MPI_Comm communicator, MatrixRows&& rows)
  : Levels(std::make_unique<Objects>(communicator, std::move(rows)))
{
}

HypreMultigrid::~HypreMultigrid() = default;

VectorXd HypreMultigrid::Apply(const VectorXd& vector)
{
  this->Levels->In.Set(vector);
  HYPRE_ParCSRMatrixMatvec(
    1.0, this->Levels->Matrix.Object(), this->Levels->In.Object(), 0.0, this->Levels->Out.Object());
  return this->Levels->Out.Get();
}

VectorXd HypreMultigrid::Precondition(const VectorXd& residual)
{
  this->Levels->In.Set(residual);
  HYPRE_ParVectorSetConstantValues(this->Levels->Out.Object(), 0.0);
  HYPRE_BoomerAMGSolve(this->Levels->Levels, this->Levels->Matrix.Object(),
    this->Levels->In.Object(), this->Levels->Out.Object());
  return this->Levels->Out.Get();
}

std::int64_t HypreMultigrid::CountEntries() const
{
  auto* levels = reinterpret_cast<hypre_ParAMGData*>(this->Levels->Levels);
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

void HypreMultigrid::Abandon()
{
  static_cast<void>(this->Levels.release());
}

VectorXd ProbeVector(Eigen::Index size)
{
  // mt19937's numbers are the same everywhere.
  std::mt19937 random(1);
  VectorXd probe(size);
  std::generate(probe.begin(), probe.end(),
    [&random]() { return static_cast<double>(random()) / std::mt19937::max() - 0.5; });
  return probe;
}

/// Conjugate gradients measure the norm of A, and their residual drifts from b - A x by
/// rounding. So they start again from the true one until that is small too.
MultigridResult SolveByMultigrid(HypreMultigrid& matrix, const VectorXd& rightHandSide,
  Eigen::Ref<VectorXd> solution, const std::function<void(double)>& report,
  const Reductions& reductions)
{
  // Squares of the largest and smallest numbers are none.
  const double scale = reductions.Max(rightHandSide.cwiseAbs().maxCoeff());
  if (!(scale > 0.0) || !std::isfinite(scale))
  {
    solution.setConstant(scale);
    return { SolverStatus::Ok, 0 };
  }
  const VectorXd scaled = rightHandSide / scale;
  const double size = NormOf(scaled, reductions);
  VectorXd iterate = VectorXd::Zero(scaled.size());
  VectorXd residual = scaled;
  double left = size;
  bool isIndefinite = false;
  bool hasConverged = true;
  double reduction = Tolerance;
  double progress = 0.0;
  int steps = 0;
  SolverStatus status = SolverStatus::Ok;
  // Written so that NaN is not small.
  while (!(left <= Tolerance * size) && hasConverged && steps < MaximumSteps && !isIndefinite &&
    status == SolverStatus::Ok)
  {
    const auto apply = [&](const VectorXd& vector)
    {
      VectorXd image = matrix.Apply(vector);
      isIndefinite = isIndefinite || !(reductions.Sum(vector.dot(image)) > 0.0);
      return image;
    };
    const auto reportStep = [&](int /*steps*/, double part)
    {
      // The residual falls on the whole, not in each step.
      progress = std::clamp(0.5 * std::log(part) / std::log(Tolerance), progress, 1.0);
      report(progress);
    };
    const auto precondition = [&matrix](const VectorXd& vector)
    { return matrix.Precondition(vector); };
    const ConjugateGradientsResult run = ConjugateGradients(iterate, residual, apply, precondition,
      { reduction, MaximumSteps - steps }, reportStep, reductions.Sum);
    hasConverged = run.HasConverged;
    steps += std::max(1, run.Steps); // so that it ends
    residual = scaled - matrix.Apply(iterate);
    left = NormOf(residual, reductions);
    reduction = 0.1 * Tolerance * size / left;
    status = static_cast<SolverStatus>(
      static_cast<int>(reductions.Max(static_cast<double>(TakeHypreStatus()))));
  }
  solution = scale * iterate;
  if (status != SolverStatus::Ok || isIndefinite)
  {
    return { isIndefinite ? SolverStatus::NotPositiveDefinite : status, steps };
  }
  return { hasConverged && left <= Tolerance * size ? SolverStatus::Ok : SolverStatus::NotConverged,
    steps };
}
}
#endif
