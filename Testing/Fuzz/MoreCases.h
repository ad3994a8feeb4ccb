// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Case.h"

namespace fuzz
{
/// What some cases have besides: conjugate gradients; the morph of pyramid coordinates; source
/// curves that a filter finds itself, and keys on the target curve; landmarks by name in
/// another order; a mesh of tetrahedra between the surface and a point inside.
void AddChoices(Case& made, Random& random);
}
