// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

namespace cartan
{
/// The area of each triangle: #T.
Eigen::VectorXd TriangleAreas(
  const TriangleMesh& mesh, const Points& points, const ExecutionContext& context = {});

/// A third of the adjacent triangles' area for each vertex: #V. The sum is the
/// surface's area.
Eigen::VectorXd BarycentricAreas(const TriangleMesh& mesh, const Eigen::VectorXd& triangleAreas);

/// current / reference, entry by entry; 1 where both are zero (nothing there
/// and nothing changed), NaN where only the reference is, or is negative: there
/// is no ratio.
Eigen::VectorXd Ratios(const Eigen::VectorXd& reference, const Eigen::VectorXd& current);
}
