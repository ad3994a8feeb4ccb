// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/SymmetricSolver.h"
#include "Base/ExecutionContext.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace cartan
{
/// Solves A x = b for a sparse symmetric positive semidefinite A of which some
/// unknowns are fixed and others softly held:
///
///   (A_ff + diag s_f) x_f = b_f - A_fc x_c,
///
/// with f the free and c the fixed unknowns, and s the soft stiffnesses, zero
/// where nothing holds (their targets t go into b as s t). Factorize once, solve
/// many right-hand sides.
class ConstrainedSolver
{
public:
  explicit ConstrainedSolver(
    SolverBackend backend = SolverBackend::Automatic, const FactorLimits& limits = {});
  ~ConstrainedSolver();
  ConstrainedSolver(ConstrainedSolver&&) noexcept;
  ConstrainedSolver& operator=(ConstrainedSolver&&) noexcept;

  /// `matrix` is #U x #U with both triangles stored; `isFixed` has #U
  /// entries, non-zero where the value is given; `stiffness` is empty or has #U
  /// entries >= 0, added to the diagonal. The symbolic factors of the last call
  /// are kept while the free unknowns and the matrix's pattern are the same.
  ///
  /// Throws Error(SingularSystem) when free unknowns that are connected through
  /// non-zero entries reach neither a fixed unknown nor a stiffness. The message
  /// lists vertices: `vertices` names that of each unknown (#U, increasing among
  /// the free ones; empty where they are the same). Throws what RequireSolver
  /// throws when the factorization fails.
  void Factorize(const SparseMatrix& matrix, const std::vector<char>& isFixed,
    const Eigen::VectorXd& stiffness = {}, const std::vector<int>& vertices = {},
    const ExecutionContext& context = {});

  /// The same; `matrix` is released before the factorization takes its memory.
  void Factorize(SparseMatrix&& matrix, const std::vector<char>& isFixed,
    const Eigen::VectorXd& stiffness = {}, const std::vector<int>& vertices = {},
    const ExecutionContext& context = {});

  /// The free unknowns in increasing order.
  const std::vector<int>& GetFree() const { return this->Free; }

  /// x_f for the right-hand side b_f - A_fc x_c given whole: #free x k each. The
  /// result lies in the solver's memory and is valid until the next solve.
  /// Throws Error(NotPositiveDefinite) when it is not finite, and Error(NotConverged)
  /// when conjugate gradients do not reach their tolerance.
  Eigen::Map<const Eigen::MatrixXd> SolveFree(
    const Eigen::Ref<const Eigen::MatrixXd>& rightHandSide,
    const ExecutionContext& context = {}) const;

  /// The convenient form: `rightHandSide` (b, #U x k; empty for zero) and `values`
  /// (#U x k), of which the fixed rows are read and the free rows are written.
  void Solve(const Eigen::Ref<const Field>& rightHandSide, Eigen::Ref<Field> values,
    const ExecutionContext& context = {}) const;

  /// How many numeric and symbolic factorizations there have been.
  int GetNumberOfFactorizations() const { return this->Factorizations; }
  int GetNumberOfAnalyses() const { return this->Analyses; }

  /// The memory of the factors and of the matrices that are kept with them.
  std::size_t GetBytes() const;

  /// The one that is used, Automatic before it is known.
  SolverBackend GetBackend() const { return this->Backend; }

private:
  SolverStatus FactorizeAs(SolverBackend backend, const SparseMatrix& block, bool isAnalyzed,
    const ExecutionContext& context);
  void FactorizeFree(const SparseMatrix& block, const ExecutionContext& context);
  void NumberFree(const std::vector<char>& isFixed);
  SparseMatrix SplitBlocks(const SparseMatrix& matrix, const Eigen::VectorXd& stiffness);

  SolverBackend Asked;
  FactorLimits Limits;
  SolverBackend Backend; // of Solver
  std::unique_ptr<SymmetricSolver> Solver;
  std::vector<int> Free;
  std::vector<int> FreeIndex; // #U, -1 where fixed
  SparseMatrix Coupling;      // A_fc, #free x #U
  std::uint64_t Pattern = 0;  // fingerprint of that of A_ff which is analyzed, 0 for none
  int Factorizations = 0;
  int Analyses = 0;
};
}
