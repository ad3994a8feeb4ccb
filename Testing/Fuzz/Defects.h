// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh.h"

namespace fuzz
{
/// What is wrong with surfaces from files: thin triangles, tiny parts, holes, split
/// and doubled points, edges and points that are no manifold, triangles turned over,
/// points that are not finite. One to three of them.
void AddDefects(Mesh& mesh, Random& random);

/// Splits triangle `cell` near the middle of its first edge: the triangle between
/// that edge and the new point is a cap, whose height is `height` times the edge. The
/// surface stays the same up to that height.
void AddCap(Mesh& mesh, std::size_t cell, double height);

/// Indices of the polygons that are triangles of three different, existing points.
std::vector<std::size_t> Triangles(const Mesh& mesh);
}
