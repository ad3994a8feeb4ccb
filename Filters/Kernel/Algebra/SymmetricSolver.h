// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Error.h"
#include "Base/ExecutionContext.h"
#include "Base/Types.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <string>

namespace cartan
{
enum class SolverBackend
{
  Automatic, ///< CHOLMOD when built with it, else Eigen; see FactorLimits::DirectUnknowns
  Eigen,     ///< Eigen's simplicial Cholesky factorization
  Cholmod,   ///< SuiteSparse CHOLMOD; Error(BadInput) when not built with it
  /// Conjugate gradients with hypre's multigrid, for Laplacians; Error(BadInput) when
  /// not built with it.
  ConjugateGradients
};

bool HasCholmod();
bool HasHypre();

/// The backend for a system that conjugate gradients do not serve: throws
/// Error(BadInput) for them, naming it: "Similarity deformation".
SolverBackend RequireDirect(SolverBackend backend, const std::string& system);

enum class SolverStatus
{
  Ok,
  NotPositiveDefinite, ///< up to rounding
  TooLarge,            ///< more entries than indices can count
  OutOfMemory,
  NotConverged, ///< an iteration did not reach its tolerance
  Failed        ///< in a way that the library does not explain
};

/// Throws what a status other than Ok means for a system of so many unknowns:
/// NotPositiveDefinite where the matrix is at fault, else TooLarge, OutOfMemory,
/// NotConverged or SolverFailed.
void RequireSolver(SolverStatus status, Eigen::Index unknowns);

/// What a factor is for, which decides how a library keeps it.
enum class FactorUse
{
  ManySolves, ///< of few right-hand sides each, as fast as can be
  FewSolves,  ///< in two thirds of the memory where the factor is large
  OneSolve    ///< the same, and released by it; another needs another factorization
};

/// Where a factorization stops being attempted, or changes its indices or its kind.
/// The defaults are those of the machine; tests lower them.
struct FactorLimits
{
  /// Factors of more entries get 64-bit indices. Fewer keep 32-bit ones: they
  /// are solved from memory, of which wide ones need a third more.
  std::int64_t NarrowEntries = std::numeric_limits<int>::max();
  /// Factors of more entries than this are not begun: OutOfMemory.
  std::int64_t Entries = std::numeric_limits<std::int64_t>::max();
  /// Automatic solves more unknowns than this by conjugate gradients, when built with
  /// them and where they reach their tolerance. Whose matrix is a Laplacian lowers it.
  Eigen::Index DirectUnknowns = std::numeric_limits<Eigen::Index>::max();
  FactorUse Use = FactorUse::ManySolves;
  /// So many unknowns side by side have the same neighbors, as the coordinates of a point
  /// have: the groups are ordered instead, which is cheap enough to do well.
  int GroupSize = 1;
};

/// Solves A x = b for a sparse symmetric positive definite matrix, of which the lower
/// triangle is given with sorted columns: by a Cholesky factorization A = L L^T, or
/// by conjugate gradients, which keep matrices on coarser and coarser levels instead.
/// The only place that names a library of solvers is behind it.
class SymmetricSolver
{
public:
  virtual ~SymmetricSolver() = default;

  /// Orders the unknowns and finds the pattern of L, where there is one.
  virtual SolverStatus Analyze(const SparseMatrix& lower) = 0;

  /// A matrix of the pattern that was analyzed last. NotConverged tells that the
  /// iteration does not solve such a matrix.
  virtual SolverStatus Factorize(const SparseMatrix& lower) = 0;

  /// Solves for #U x k right-hand sides. The result is kept here until the next
  /// call; see GetSolution(). An iteration reports to `context` after each step.
  virtual SolverStatus Solve(const Eigen::Ref<const Eigen::MatrixXd>& rightHandSide,
    const ExecutionContext& context = {}) = 0;
  virtual Eigen::Map<const Eigen::MatrixXd> GetSolution() const = 0;

  /// Entries of L as analyzed, or of the matrices of all levels, and the memory that
  /// everything takes.
  virtual std::int64_t GetNumberOfEntries() const = 0;
  virtual std::size_t GetBytes() const = 0;

  /// The most steps that an iteration took for a column of the last solve; 0 where there is
  /// a factor.
  virtual int GetNumberOfSteps() const { return 0; }
};

/// Throws Error(BadInput) for CHOLMOD and conjugate gradients when not built with them.
std::unique_ptr<SymmetricSolver> MakeSymmetricSolver(
  SolverBackend backend, const FactorLimits& limits = {});
}
