// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Types.h"

#include <vector>

namespace cartan
{
/// Polygons as their triangles: `polygons` (#T) says which polygon each triangle is
/// of, from 0 on.

/// Unit normals of polygons, flat or not: the direction of the sum of the
/// triangles' area vectors, which only depends on the border. Zero where that is
/// zero, and for polygons without triangles: count x 3.
Points PolygonNormals(const Points& points, const Triangles& triangles,
  const std::vector<long long>& polygons, Eigen::Index count);

/// Gives polygons on the same points the same triangles, those of the first: front
/// and back of a square may have been split along different diagonals, and would
/// not be found as doubled (FindDoubledTriangles). The triangles of a polygon
/// follow one another.
void SplitDoubledPolygonsAlike(Triangles& triangles, const std::vector<long long>& polygons);
}
