// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/TriangleMesh.h"

#include <functional>
#include <vector>

namespace cartan
{
/// The vertices around which a computation at one vertex looks at triangles or places.
using VerticesLookedAt =
  std::function<std::vector<int>(const TriangleMesh& mesh, const Points& positions, int vertex)>;
}
