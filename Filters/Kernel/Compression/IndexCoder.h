// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Types.h"

#include <cstddef>
#include <vector>

namespace cartan
{
/// Codes triangles by meshoptimizer's index coder, a byte and more per triangle, and these
/// bytes by their probabilities after the byte before. With triangles in TraversalOrder the
/// two take 2 to 5 bits per vertex. The order of triangles stays; the three corners of a
/// triangle may turn. Throws Error(BadInput) in a build without meshoptimizer.
std::vector<unsigned char> EncodeTriangles(const Triangles& triangles, int numberOfVertices);

/// Ids of decoded triangles may be anything. Throws Error(BadInput) when the bytes are no
/// code of so many triangles. Takes memory in proportion to `numberOfTriangles`.
Triangles DecodeTriangles(const unsigned char* bytes, std::size_t size, int numberOfTriangles);
}
