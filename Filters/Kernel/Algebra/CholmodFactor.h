// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/SymmetricSolver.h"

namespace cartan
{
/// SuiteSparse CHOLMOD's supernodal factorization; null when not built with it.
std::unique_ptr<SymmetricSolver> MakeCholmodFactor(const FactorLimits& limits);
}
