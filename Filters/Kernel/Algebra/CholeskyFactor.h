// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Error.h"
#include "Base/Types.h"

#include <cstdint>
#include <limits>
#include <memory>

namespace cartan
{
enum class SolverBackend
{
  Automatic, ///< CHOLMOD when built with it, else Eigen
  Eigen,     ///< Eigen's simplicial Cholesky factorization
  Cholmod    ///< SuiteSparse CHOLMOD; Error(BadInput) when not built with it
};

bool HasCholmod();

enum class FactorStatus
{
  Ok,
  NotPositiveDefinite, ///< up to rounding
  TooLarge,            ///< more entries than indices can count
  OutOfMemory,
  Failed ///< in a way that the library does not explain
};

/// Throws what a status other than Ok means for a system of so many unknowns:
/// NotPositiveDefinite where the matrix is at fault, else TooLarge, OutOfMemory or
/// SolverFailed.
void RequireFactor(FactorStatus status, Eigen::Index unknowns);

/// Where a factorization stops being attempted, or changes its indices. The
/// defaults are those of the machine; tests lower them.
struct FactorLimits
{
  /// Factors of more entries get 64-bit indices. Fewer keep 32-bit ones: they
  /// are solved from memory, of which wide ones need a third more.
  std::int64_t NarrowEntries = std::numeric_limits<int>::max();
  /// Factors of more entries than this are not begun: OutOfMemory.
  std::int64_t Entries = std::numeric_limits<std::int64_t>::max();
};

/// A Cholesky factorization L L^T of a sparse symmetric positive definite
/// matrix, of which the lower triangle is given with sorted columns. The only
/// place that names a library of decompositions is behind it.
class CholeskyFactor
{
public:
  virtual ~CholeskyFactor() = default;

  /// Orders the unknowns and finds the pattern of L.
  virtual FactorStatus Analyze(const SparseMatrix& lower) = 0;

  /// A matrix of the pattern that was analyzed last.
  virtual FactorStatus Factorize(const SparseMatrix& lower) = 0;

  /// Solves for #U x k right-hand sides. The result is kept here until the next
  /// call; see GetSolution().
  virtual FactorStatus Solve(const Eigen::Ref<const Eigen::MatrixXd>& rightHandSide) = 0;
  virtual Eigen::Map<const Eigen::MatrixXd> GetSolution() const = 0;

  /// Entries of L as analyzed, and the memory that everything takes.
  virtual std::int64_t GetNumberOfEntries() const = 0;
  virtual std::size_t GetBytes() const = 0;
};

/// Throws Error(BadInput) for CHOLMOD when not built with it.
std::unique_ptr<CholeskyFactor> MakeCholeskyFactor(
  SolverBackend backend, const FactorLimits& limits = {});
}
