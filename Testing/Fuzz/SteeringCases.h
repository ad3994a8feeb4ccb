// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Case.h"

namespace fuzz
{
/// What Carry Along, Curve Deformation, Example Based Deformation and Landmark Handles are
/// steered by: the surface at rest and after a bend, a path along edges and where it goes,
/// example poses, landmarks. Nothing for other filters.
void AddSteering(Case& made, Random& random);
}
