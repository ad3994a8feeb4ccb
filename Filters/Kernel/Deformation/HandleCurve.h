// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/HandleProblem.h"

namespace cartan
{
/// The share of each vertex in the curve of its handle: #V, with the sum 1 over
/// every handle, 0 at free vertices. `handle` (#V) is 0 at free vertices.
///
/// The curve consists of the edges between vertices of one handle that do not
/// have the handle on both sides. It is the handle itself if that is a line,
/// and its border if it is a region, whose inner vertices have no share. A
/// vertex without a neighbor in its handle counts with the mean length of its
/// edges. If a handle is a whole closed component, it has no curve, and all its
/// vertices have equal shares.
///
/// Soft weights w scaled to w sqrt(share) have the same effect on every mesh of
/// a surface and in every unit of length. The effect of w alone increases with
/// the number of vertices of the handle.
Eigen::VectorXd HandleCurveShares(
  const TriangleMesh& mesh, const Points& points, const std::vector<int>& handle);

/// Multiplies the finite soft weights of a problem, if it has some, by the root of these shares;
/// what stands for joined vertices has the shares of all of them.
void ScaleSoftWeights(HandleProblem& problem);
}
