// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/TriangleMesh.h"

namespace cartan
{
/// The share that each vertex has in the curve of its handle: #V, adding up to 1
/// over every handle, 0 at free vertices. `handle` (#V) is 0 at free vertices.
///
/// The curve are the edges between vertices of one handle that do not have the
/// handle on both sides: the handle itself where it is a line, its border where
/// it is a region, whose inner vertices have no share. A vertex without a
/// neighbor in its handle counts with the mean length of its edges. Where a
/// handle has no curve, as it is a whole closed component, all its vertices have
/// equal shares.
///
/// Soft weights w scaled to w sqrt(share) mean the same on every mesh of a
/// surface and in every unit of length, while w alone holds a handle the more
/// firmly the more vertices it has.
Eigen::VectorXd HandleCurveShares(
  const TriangleMesh& mesh, const Points& points, const std::vector<int>& handle);
}
