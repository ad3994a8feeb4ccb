// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Invariants.h"

namespace fuzz
{
/// What holds for the filters of the Laplacian framework alone.
std::vector<Invariant> LaplacianLaws();
}
