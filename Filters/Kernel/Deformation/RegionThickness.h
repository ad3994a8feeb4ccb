// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// How thick the body is that a region of a surface bounds, in length units: 4 V / A, with
/// the area A of the triangles at vertices that are in it and the volume V between them and
/// fans that close their openings, from the mean of an opening's points. The diameter of a
/// tube, or the side of a square bar, however long. Components count with the sizes of their
/// volumes, whichever side they show.
///
/// At least six edges, root mean square: what is thinner is a sheet, which bounds nothing
/// that this mesh shows. 0 where the region has no triangle. `isInside`: #V.
double RegionThickness(
  const TriangleMesh& mesh, const Points& points, const std::vector<char>& isInside);
}
