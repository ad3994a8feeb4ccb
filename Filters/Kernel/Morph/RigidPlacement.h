// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morph/KeyInterpolation.h"
#include "Morph/SurfaceMorph.h"

namespace cartan
{
/// Weights of RigidPlacement by area: a third of the adjacent triangles' in all key
/// frames together. #V.
Eigen::VectorXd AreaWeights(const KeyFrames& keys, const ExecutionContext& context = {});

/// Weights of RigidPlacement that hold `isPinned` (#V) in place: 1 there, 0
/// elsewhere. Throws Error(BadInput) where those of a component, in the first key
/// frame, lie on a line, about which the component could turn. #V.
Eigen::VectorXd PinWeights(const KeyFrames& keys, const std::vector<char>& isPinned);

/// Puts surfaces between key frames, known up to a rigid motion of each
/// component, where a rigid interpolation of the key frames has them: the
/// centers of the components move as KeyInterpolation says, and the turn that
/// best aligns one with the key frame before goes over into the turn that best
/// aligns it with the key frame after at an even rate about one axis, by less
/// than half a turn from one key frame to the next.
class RigidPlacement
{
public:
  /// `weights` (#V, >= 0) say how much each vertex counts. A component whose
  /// vertices have no weight at all is placed by all of them alike.
  RigidPlacement(const KeyFrames& keys, Eigen::VectorXd weights);

  void Place(double t, Points& positions) const;

private:
  KeyFrames Keys;
  Eigen::VectorXd Weights;      // #V, adding up to 1 over each component
  std::vector<Points> Centers;  // per key frame, #components x 3
  KeyInterpolation CenterPaths; // 3 #components rows
  std::vector<Points> Turns;    // per key frame but the last, to the next: #components x 3
};
}
