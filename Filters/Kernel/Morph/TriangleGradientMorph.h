// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Differential/TriangleStitching.h"
#include "Morph/KeyInterpolation.h"
#include "Morph/SurfaceMorph.h"

namespace cartan
{
/// Surfaces between key frames by the linear map that takes each triangle from
/// one to the next, split into a rotation and a stretch (Sumner et al.,
/// Mesh-based Inverse Kinematics, 2005; Sorkine, Differential Representations for
/// Mesh Processing, 2006, section 4.4): axis times angle of the rotation and the
/// stretched triangle are interpolated, and the triangles stitched together.
///
/// Of the many vectors that mean one rotation each triangle takes the one nearest
/// to that of its neighbor, the most alike neighbors first. That is consistent
/// where no part of the surface turns by nearly a whole lap against the mean of
/// all; there every axis is as good as any other, and the surface tears or
/// creases. DiscreteFormsMorph has no such limit.
class TriangleGradientMorph : public SurfaceMorph
{
public:
  /// Factorizes. Throws Error(BadInput) where a component has no triangle with
  /// area in one of the key frames.
  explicit TriangleGradientMorph(const KeyFrames& keys, const ExecutionContext& context = {});

  Points Evaluate(double t, const ExecutionContext& context) override;

private:
  std::shared_ptr<const TriangleMesh> Mesh;
  Matrices Frames;                  // #T x 9, of the triangles in the first key frame
  KeyInterpolation RotationVectors; // 3 #T rows, from the first key frame, in Frames
  KeyInterpolation Corners;         // 9 #T rows, turned back to the first key frame, in Frames
  TriangleStitching Stitching;
};
}
