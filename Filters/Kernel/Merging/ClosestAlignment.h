// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

namespace cartan
{
/// The rigid motion, or with `scales` the similarity, that takes points closest to a surface
/// (4 x 4), by iterated closest points (Besl and McKay, A Method for Registration of 3-D
/// Shapes, 1992) from where the means of both meet, and with `scales` their extents are equal;
/// it finds the nearest of several possible fits. Of more than 1000 points every n-th takes part.
/// Scales are ratios of extents, so that points do not shrink onto what is near. At least one point
/// and one triangle.
Eigen::Matrix4d AlignToSurface(const Points& from, const TriangleMesh& mesh, const Points& points,
  bool scales, const ExecutionContext& context = {});
}
