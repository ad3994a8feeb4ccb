// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/ConstrainedSolver.h"

namespace cartan
{
/// What holds the unknowns of a system.
struct Anchors
{
  std::vector<char> IsHard;  ///< #U, non-zero where the value is given
  Eigen::VectorXd Stiffness; ///< empty or #U: s > 0 adds s |x - t|^2, see AnchoredSystem
  std::vector<int> Vertices; ///< empty or #U: the vertex that a message names for an unknown

  /// Hard where `isHard` (#U) is non-zero.
  static Anchors Hard(std::vector<char> isHard);

  /// The first `free` of the unknowns are free, the others hard.
  static Anchors After(int free, int size);

  /// For `count` unknowns side by side where this has one, such as three
  /// coordinates.
  Anchors Repeated(int count) const;
};

/// How an anchor acts on a least-squares fit of equations.
enum class AnchorMode
{
  Soft,       ///< as one more equation: its place is missed by a little
  Hard,       ///< held exactly; its own equation stays among those that are fitted
  Substituted ///< held exactly, and its own equation is left out: noise is fitted less well
};

/// Solves (A + diag s) x = b + s t for a symmetric positive semidefinite A, with
/// x = t at hard anchors: the minimum of x^T A x / 2 - b^T x + sum s |x - t|^2 / 2
/// under them. Factorizes once, solves for many b and t.
class AnchoredSystem
{
public:
  explicit AnchoredSystem(
    SolverBackend backend = SolverBackend::Automatic, const FactorLimits& limits = {})
    : Solver(backend, limits)
  {
  }

  /// `matrix` has both triangles stored. Throws what ConstrainedSolver throws:
  /// Error(SingularSystem) naming vertices where a connected part has no anchor.
  void Factorize(
    const SparseMatrix& matrix, const Anchors& anchors, const ExecutionContext& context = {});

  /// The same; `matrix` is released before the factorization takes its memory.
  void Factorize(
    SparseMatrix&& matrix, const Anchors& anchors, const ExecutionContext& context = {});

  /// The same for a fit of differential coordinates: equations L x = M d, in the
  /// weight of M^-1 (`inverseMass`, #U),
  ///
  ///   min sum over equations of m_i |(M^-1 L x)_i - d_i|^2 + sum s |x - t|^2,
  ///
  /// that is A = L^T M^-1 L and b = L^T d; with AnchorMode::Substituted the
  /// equations of free unknowns alone, for a symmetric L as A = L and b = M d.
  /// Stiffness needs Soft.
  void FactorizeFit(const SparseMatrix& laplacian, const Eigen::VectorXd& inverseMass,
    const Anchors& anchors, AnchorMode mode, const ExecutionContext& context = {});

  /// `rightHandSide` is b (#U x k), the d of FactorizeFit; `values` (#U x k) has the
  /// t of hard and soft anchors and gets x.
  void Solve(const Eigen::Ref<const Field>& rightHandSide, Eigen::Ref<Field> values,
    const ExecutionContext& context = {}) const;

  /// The same with b = 0: free unknowns get the values between the anchors'.
  void Interpolate(Eigen::Ref<Field> values, const ExecutionContext& context = {}) const
  {
    this->Solve(Field(), values, context);
  }

  /// The free unknowns' x for a right-hand side to which all anchors' shares are
  /// added already: #free x k each. Valid until the next solve.
  Eigen::Map<const Eigen::MatrixXd> SolveFree(
    const Eigen::Ref<const Eigen::MatrixXd>& rightHandSide,
    const ExecutionContext& context = {}) const
  {
    return this->Solver.SolveFree(rightHandSide, context);
  }

  /// In increasing order.
  const std::vector<int>& GetFree() const { return this->Solver.GetFree(); }
  int GetNumberOfFactorizations() const { return this->Solver.GetNumberOfFactorizations(); }
  SolverBackend GetBackend() const { return this->Solver.GetBackend(); }
  std::size_t GetBytes() const;

private:
  void Hold(const Anchors& anchors);

  ConstrainedSolver Solver;
  Eigen::VectorXd Stiffness;  // empty where nothing is soft
  SparseMatrix RightHandSide; // from d to b; empty where they are the same
};
}
