// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh.h"

namespace fuzz
{
/// A surface from a formula: closed or open, of one component or several, of
/// regular or random triangles, mostly with 20 to 800 points and a size near 1.
Mesh MakeShape(Random& random);

/// Turns pairs of triangles into quads and strips, and adds vertices and lines.
void MixCells(Mesh& mesh, Random& random);
}
