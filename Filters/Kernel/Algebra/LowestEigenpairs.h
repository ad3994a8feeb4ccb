// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/SymmetricSolver.h"
#include "Base/ExecutionContext.h"
#include "Base/Types.h"

namespace cartan
{
struct Eigenpairs
{
  Eigen::VectorXd Values;  ///< #pairs, increasing
  Eigen::MatrixXd Vectors; ///< #U x #pairs, orthonormal
};

/// The `count` smallest eigenvalues of a sparse symmetric positive semidefinite matrix S
/// (#U x #U, both triangles stored) whose null space is known, with their eigenvectors.
/// `nullSpace` is an orthonormal basis of it, or `count` vectors of one: #U x m with
/// m <= count <= #U. It makes the first m pairs.
///
/// A dense decomposition where #U is small or `count` is much of it. Else the block Lanczos
/// method for (S + s I)^-1 with a small shift s, by one factorization (Grimes, Lewis, Simon,
/// A Shifted Block Lanczos Algorithm for Solving Sparse Symmetric Generalized Eigenproblems,
/// 1994), restarted with the Ritz vectors that are wanted (Wu, Simon, Thick-restart Lanczos
/// Method for Large Symmetric Eigenvalue Problems, 2000). Residuals |S x - lambda x| are
/// below 1e-11 of the largest eigenvalue. Eigenvalues of any multiplicity are found.
///
/// Throws Error(NotConverged) when restarts do not help, what ConstrainedSolver::Factorize
/// throws, and Error(Aborted).
Eigenpairs LowestEigenpairs(const SparseMatrix& matrix, const Eigen::MatrixXd& nullSpace, int count,
  SolverBackend backend = SolverBackend::Automatic, const ExecutionContext& context = {});

/// How many vectors of `size` numbers LowestEigenpairs holds at once, its result and two
/// copies of it included.
std::uint64_t VectorsOfEigenpairs(int count, Eigen::Index size);
}
