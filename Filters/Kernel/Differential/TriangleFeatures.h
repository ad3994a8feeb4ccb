// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/TriangleMesh.h"

namespace cartan
{
/// The corners of each triangle as the columns of a matrix, about its center:
/// #T x 9.
Matrices TriangleCorners(const TriangleMesh& mesh, const Points& positions);

/// Orthonormal frames of the triangles, the first axis along the first edge, the
/// last along the normal; the identity where there is no area: #T x 9.
Matrices TriangleFrames(const TriangleMesh& mesh, const Matrices& corners);

/// The corners (#T x 9) as their frames see them: #T x 9.
Matrices InFrames(const Matrices& frames, const Matrices& corners);

/// What of a pose's rotation from another is left out.
enum class MeanRotation
{
  OfComponents, ///< of each component its own
  OfSurface     ///< one for all
};

/// The linear map of each triangle from one pose of a surface to another, split into
/// what can be interpolated (Sumner et al., Mesh-based Inverse Kinematics, 2005, section
/// 3; Sorkine, Differential Representations for Mesh Processing, 2006, section 4.4).
struct TriangleFeatures
{
  /// Axis times angle of the rotation in radians: #T x 3. Of the vectors that mean it
  /// the nearest to that of a neighbor, the most similar neighbors first.
  Points Vectors;
  Matrices Corners; ///< the stretched corners about their center, turned back: #T x 9
};

/// Features of the pose `positions` (#V x 3) seen from that with the corners `rest`, in
/// `frames` of the latter, #T x 9 each. They do not depend on how the pose is turned.
/// Throws Error(BadInput) where a component has no triangle with area in both poses.
TriangleFeatures FeaturesOf(const TriangleMesh& mesh, const Matrices& rest, const Matrices& frames,
  const Points& positions, MeanRotation mean);
}
