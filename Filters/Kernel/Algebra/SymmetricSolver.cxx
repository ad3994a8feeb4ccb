// SPDX-License-Identifier: BSD-3-Clause
#include "Algebra/SymmetricSolver.h"

#include "Algebra/CholmodFactor.h"
#include "Algebra/EigenFactor.h"
#include "Algebra/MultigridSolver.h"

#include <string>

namespace cartan
{
bool HasCholmod()
{
#ifdef CARTAN_HAVE_CHOLMOD
  return true;
#else
  return false;
#endif
}

SolverBackend RequireDirect(SolverBackend backend, const std::string& system)
{
  if (backend == SolverBackend::ConjugateGradients)
  {
    throw Error(ErrorCode::BadInput,
      system +
        " has a system that conjugate gradients solve too slowly or not well enough: choose "
        "another solver, such as Automatic.");
  }
  return backend;
}

void RequireSolver(SolverStatus status, Eigen::Index unknowns)
{
  const std::string system = "The system of " + std::to_string(unknowns) + " unknowns ";
  switch (status)
  {
    case SolverStatus::Ok:
      return;
    case SolverStatus::NotPositiveDefinite:
      throw Error(ErrorCode::NotPositiveDefinite,
        system + "cannot be factorized: up to rounding it is not positive definite.");
    case SolverStatus::TooLarge:
      throw Error(ErrorCode::TooLarge,
        system +
          "has factors with more entries than the solver can count. Leave fewer points free, or "
          "decimate the surface.");
    case SolverStatus::OutOfMemory:
      throw Error(ErrorCode::OutOfMemory,
        system +
          "does not fit into memory. Leave fewer points free, decimate the surface, or free "
          "memory.");
    case SolverStatus::NotConverged:
      throw Error(ErrorCode::NotConverged,
        system +
          "is not solved by conjugate gradients: their residual stays above the tolerance. Choose "
          "a direct solver, Eigen or CHOLMOD.");
    case SolverStatus::Failed:
      break;
  }
  throw Error(
    ErrorCode::SolverFailed, system + "could not be solved: the solver's library failed.");
}

std::unique_ptr<SymmetricSolver> MakeSymmetricSolver(
  SolverBackend backend, const FactorLimits& limits)
{
  if (backend == SolverBackend::ConjugateGradients)
  {
    if (!HasHypre())
    {
      throw Error(ErrorCode::BadInput,
        "Cartan was built without hypre and has no conjugate gradients: choose Eigen's solver.");
    }
    return MakeMultigridSolver(limits);
  }
  const bool useCholmod =
    backend == SolverBackend::Cholmod || (backend == SolverBackend::Automatic && HasCholmod());
  if (!useCholmod)
  {
    return MakeEigenFactor(limits);
  }
  if (!HasCholmod())
  {
    throw Error(ErrorCode::BadInput, "Cartan was built without CHOLMOD: choose Eigen's solver.");
  }
  return MakeCholmodFactor(limits);
}
}
