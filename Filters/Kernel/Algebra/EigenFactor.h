// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/SymmetricSolver.h"

namespace cartan
{
/// Eigen's simplicial factorization with an order of approximately minimum
/// degree. Right-hand sides are solved four at a time.
std::unique_ptr<SymmetricSolver> MakeEigenFactor(const FactorLimits& limits);
}
