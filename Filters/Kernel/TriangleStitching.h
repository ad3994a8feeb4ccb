// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ConstrainedSolver.h"
#include "TriangleMesh.h"

namespace cartan
{
/// Puts a surface together from triangles that lie each for itself: positions x
/// that minimize
///
///   sum over triangles and their edges of w |x_b - x_a - (p_b - p_a)|^2,
///
/// p a triangle's own corners and w what it adds to the weight of the edge
/// (CornerWeights). With cotangent weights this is the fit of the triangles'
/// gradients weighted by area (Yu et al., Mesh Editing with Poisson-based
/// Gradient Field Manipulation, 2004). Factorized once for all p.
class TriangleStitching
{
public:
  /// `cornerWeights` is #T x 3. One vertex of each component is fixed at the
  /// origin.
  TriangleStitching(const TriangleMesh& mesh, Points cornerWeights,
    const ExecutionContext& context = {});

  /// `corners` is #T x 9, the three corners of each triangle one after the
  /// other; where the triangle lies does not matter. #V x 3; unused vertices are
  /// at the origin.
  Points Stitch(const TriangleMesh& mesh, const Matrices& corners) const;

private:
  Points CornerWeights;
  ConstrainedSolver Solver;
};
}
