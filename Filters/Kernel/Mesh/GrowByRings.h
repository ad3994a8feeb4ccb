// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// The vertices within `rings` edges of the seeds, nearest first and the seeds
/// before all. None is there twice. O(#V) for the marks, else of their number.
std::vector<int> GrowByRings(const TriangleMesh& mesh, const std::vector<int>& seeds, int rings);
}
