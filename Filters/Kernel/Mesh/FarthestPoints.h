// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// `count` vertices spread over the surface: the first is that farthest from the center
/// of all, each next one has the largest geodesic distance to those before it (Gonzalez,
/// Clustering to minimize the maximum intercluster distance, 1985; ties go to the smaller
/// id). Each component gets its first vertex before any gets a second one. Fewer where
/// there are fewer used vertices in different places.
std::vector<int> FarthestPoints(
  const TriangleMesh& mesh, const Points& points, int count, const ExecutionContext& context = {});
}
