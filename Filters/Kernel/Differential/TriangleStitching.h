// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/AnchoredSystem.h"
#include "Base/Bytes.h"

namespace cartan
{
/// Reconstructs a surface from separate triangles: positions x that minimize
///
///   sum over triangles and their edges of w |x_b - x_a - (p_b - p_a)|^2,
///
/// where p are the triangle's own corners and w is a weight for each of its
/// edges. With half the cotangents of the opposite angles (CornerWeights) this
/// is the fit of the triangles' gradients weighted by area (Yu et al., Mesh
/// Editing with Poisson-based Gradient Field Manipulation, 2004). Factorized
/// once for all p.
class TriangleStitching
{
public:
  TriangleStitching() = default;

  /// `cornerWeights` (#T x 3) are those of the edges opposite to corners. The
  /// vertices of `isHeld` (#V) keep their places: one in each component at least,
  /// and those in no triangle.
  TriangleStitching(Triangles triangles, Points cornerWeights, const std::vector<char>& isHeld,
    const ExecutionContext& context = {});

  /// `corners` is #T x 9, the three corners of each triangle one after the
  /// other; where the triangle lies does not matter. Writes `positions` (#V x 3)
  /// but for those held.
  void Stitch(const Matrices& corners, Points& positions) const;

  std::size_t GetBytes() const
  {
    return this->System.GetBytes() + TotalBytes(this->Corners, this->Weights);
  }

private:
  Triangles Corners;
  Points Weights;
  AnchoredSystem System;
};
}
