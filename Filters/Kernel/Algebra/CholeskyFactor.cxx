// SPDX-License-Identifier: BSD-3-Clause
#include "Algebra/CholeskyFactor.h"

#include "Algebra/CholmodFactor.h"
#include "Algebra/EigenFactor.h"

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

void RequireFactor(FactorStatus status, Eigen::Index unknowns)
{
  const std::string system = "The system of " + std::to_string(unknowns) + " unknowns ";
  switch (status)
  {
    case FactorStatus::Ok:
      return;
    case FactorStatus::NotPositiveDefinite:
      throw Error(ErrorCode::NotPositiveDefinite,
        system + "cannot be factorized: up to rounding it is not positive definite.");
    case FactorStatus::TooLarge:
      throw Error(ErrorCode::TooLarge,
        system +
          "has factors with more entries than the solver can count. Leave fewer points free, or "
          "decimate the surface.");
    case FactorStatus::OutOfMemory:
      throw Error(ErrorCode::OutOfMemory,
        system +
          "does not fit into memory. Leave fewer points free, decimate the surface, or free "
          "memory.");
    case FactorStatus::Failed:
      break;
  }
  throw Error(
    ErrorCode::SolverFailed, system + "could not be solved: the solver's library failed.");
}

std::unique_ptr<CholeskyFactor> MakeCholeskyFactor(
  SolverBackend backend, const FactorLimits& limits)
{
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
