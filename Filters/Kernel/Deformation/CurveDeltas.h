// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// How the differential coordinates beside a curve change.
struct CurveDeltas
{
  double Scale = 1.0;   ///< 1: as they are, 0: flat, above 1: a ridge where the surface is convex
  double Turn = 0.0;    ///< about the tangents of the curve, in radians
  double Width = 0.0;   ///< how far from the curve, in length units, > 0
  bool IsSharp = false; ///< on the curve alone, which makes a crease; else in all of the width
};

/// Ridges, ravines and suggestive contours (Nealen, Sorkine, Alexa, Cohen-Or, A
/// Sketch-Based Interface for Detail-Preserving Mesh Editing, 2005): at the part t of the width
/// the differential coordinates d = L x (cotangents of `points`) become
///
///   (1 + p (Scale - 1)) R(p Turn) d,  p = (1 - t^2)^2, or 1 on the curve and 0 beside it,
///
/// with R about the tangent of the curve nearby. Solved for all vertices nearer
/// than Width; the others stay. `path` are the vertices of the curve in their order, a ring
/// with `isClosed`; `distances` (#V) are those from it. Returns the new positions.
///
/// Throws Error(BadInput) where a connected part is nearer as a whole, so that nothing would
/// hold it.
Points DeformByCurveDeltas(const TriangleMesh& mesh, const Points& points,
  const std::vector<int>& path, bool isClosed, const Eigen::VectorXd& distances,
  const CurveDeltas& deltas, const ExecutionContext& context = {});
}
