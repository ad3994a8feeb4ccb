// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Differential/TriangleStitching.h"
#include "Morph/KeyInterpolation.h"
#include "Morph/SurfaceMorph.h"

namespace cartan
{
/// Interpolates between key frames the linear map of each triangle from one key
/// frame to the next, split into a rotation and a stretch (Sumner et al.,
/// Mesh-based Inverse Kinematics, 2005; Sorkine, Differential Representations
/// for Mesh Processing, 2006, section 4.4): axis times angle of the rotation
/// and the stretched triangle are interpolated, and the triangles are stitched
/// together.
///
/// Many rotation vectors give the same rotation. Each triangle takes the one
/// nearest to that of its neighbor, the most similar neighbors first. This is
/// consistent unless a part of the surface turns by nearly a full turn relative
/// to the mean of the surface. There the axis is ambiguous, and the surface
/// tears or creases. DiscreteFormsMorph has no such limit.
class TriangleGradientMorph : public SurfaceMorph
{
public:
  /// Factorizes. Throws Error(BadInput) where a component has no triangle with
  /// area in one of the key frames.
  explicit TriangleGradientMorph(const KeyFrames& keys, const ExecutionContext& context = {});

  Points Evaluate(const MorphPlace& place, const ExecutionContext& context) override;
  std::size_t GetBytes() const override
  {
    return this->RotationVectors.GetBytes() + this->Corners.GetBytes() +
      this->Stitching.GetBytes() + BytesOf(this->Frames);
  }

private:
  std::shared_ptr<const TriangleMesh> Mesh;
  Matrices Frames;                  // #T x 9, of the triangles in the first key frame
  KeyInterpolation RotationVectors; // 3 #T rows, from the first key frame, in Frames
  KeyInterpolation Corners;         // 9 #T rows, turned back to the first key frame, in Frames
  TriangleStitching Stitching;
};
}
