// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/CholeskyFactor.h"

namespace cartan
{
/// SuiteSparse CHOLMOD's supernodal factorization; null when not built with it.
std::unique_ptr<CholeskyFactor> MakeCholmodFactor(const FactorLimits& limits);
}
