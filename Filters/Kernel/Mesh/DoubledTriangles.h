// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Types.h"

#include <vector>

namespace cartan
{
/// Which triangles to drop so that no two have the same three vertices, in
/// whatever order: non-zero for those, #T.
///
/// Of an odd number of such triangles the first is kept, and of an even number
/// too, unless the surface closes without them: a connected part of doubled
/// triangles whose edges each have two other triangles or none, and at least one
/// edge two. That is a wall between two bodies in contact, or the corner of a
/// plate whose front and back share their rim. Both copies of the whole part are
/// dropped then, which keeps closed surfaces closed; to keep one would put three
/// triangles on an edge. No triangle names a vertex twice. O(#T log #T).
std::vector<char> FindDoubledTriangles(int numberOfVertices, const Triangles& triangles);
}
