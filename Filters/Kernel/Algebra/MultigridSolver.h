// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/SymmetricSolver.h"

namespace cartan
{
/// Conjugate gradients with a V-cycle of hypre's algebraic multigrid BoomerAMG
/// (Henson and Yang, BoomerAMG: A Parallel Algebraic Multigrid Solver and
/// Preconditioner, 2002) for the Laplacian of a surface, in memory and time that grow
/// with the unknowns only. They end when both the residual, |b - A x| over |b|, and the
/// error as the preconditioner sees it, in the norm of A and relative to x, are at most
/// 1e-10. Each factorization solves for a random right-hand side first: NotConverged
/// where that takes too many steps. The same input gives the same bits.
///
/// Of `limits`, Entries counts those of the whole matrix. Starts MPI when nothing else in
/// the process has, for this process alone, and leaves it running; Failed after MPI was
/// finalized. Null when not built with hypre.
std::unique_ptr<SymmetricSolver> MakeMultigridSolver(const FactorLimits& limits);
}
