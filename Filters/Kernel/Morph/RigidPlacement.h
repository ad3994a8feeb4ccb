// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Bytes.h"
#include "Morph/KeyInterpolation.h"
#include "Morph/SurfaceMorph.h"

namespace cartan
{
/// Weights of RigidPlacement by area: a third of the area of the adjacent
/// triangles, summed over all key frames. #V.
Eigen::VectorXd AreaWeights(const KeyFrames& keys, const ExecutionContext& context = {});

/// Weights of RigidPlacement that fix the vertices of `isPinned` (#V): 1 there,
/// 0 elsewhere. Throws Error(BadInput) if those of a component lie on a line in
/// the first key frame, because the component could turn about it. #V.
Eigen::VectorXd PinWeights(const KeyFrames& keys, const std::vector<char>& isPinned);

/// Moves surfaces between key frames, known up to a rigid motion of each
/// component, to a rigid interpolation of the key frames. KeyInterpolation
/// gives the centers of the components. One rotation best aligns a component
/// with the key frame before, another with the key frame after; between them it
/// turns at an even rate about one axis, by less than half a turn.
class RigidPlacement
{
public:
  /// `weights` (#V, >= 0) are the weights of vertices. If all vertices of a
  /// component have the weight 0, they count equally.
  RigidPlacement(const KeyFrames& keys, Eigen::VectorXd weights);

  /// A component of a surface with a parameter for each vertex is placed at their mean, by the
  /// weights of vertices; one of a blend shape at the mean of the key frames' centers and
  /// rotations.
  void Place(const MorphPlace& place, Points& positions) const;

  std::size_t GetBytes() const
  {
    return BytesOf(this->Keys.Positions) + this->CenterPaths.GetBytes() +
      TotalBytes(this->Weights, this->Centers, this->Turns);
  }

private:
  Eigen::VectorXd ComponentParameters(const MorphPlace& place) const;

  KeyFrames Keys;
  Eigen::VectorXd Weights;      // #V, adding up to 1 over each component
  std::vector<Points> Centers;  // per key frame, #components x 3
  KeyInterpolation CenterPaths; // 3 #components rows
  std::vector<Points> Turns;    // per key frame but the last, to the next: #components x 3
};
}
