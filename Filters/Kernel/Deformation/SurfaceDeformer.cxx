// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/SurfaceDeformer.h"

#include "Deformation/SliverRemoval.h"

#include <algorithm>

namespace cartan
{
void SurfaceDeformer::Deform(const HandleTargets& targets, bool wantTransforms,
  DeformedSurface& result, const ExecutionContext& context)
{
  if (!this->Common)
  {
    this->Common = std::make_unique<CommonMotion>(this->Problem);
  }
  const HandleTargets relative = this->Common->Remove(targets);
  this->DeformRelative(relative, wantTransforms, result, context);
  if (this->FollowsRigidHandles())
  {
    this->Common->Follow(relative, wantTransforms, result);
  }
  this->Common->Restore(wantTransforms, result);
  CarryRiders(this->Problem.Riders, *this->Problem.Rest, result);
}

bool SurfaceDeformer::Serves(const HandleProblem& problem) const
{
  const HandleProblem& own = this->Problem;
  return own.Mesh == problem.Mesh && own.Rest == problem.Rest && own.Weights == problem.Weights &&
    own.PositionWeights == problem.PositionWeights && own.ClampWeights == problem.ClampWeights &&
    own.ConstrainPositions == problem.ConstrainPositions && own.Handle == problem.Handle &&
    own.SoftWeights.size() == problem.SoftWeights.size() &&
    own.SoftWeights == problem.SoftWeights &&
    // A handle that may move need not; but without held positions it would be
    // solved for where it is pinned otherwise, and the first pinned one decides
    // from where the others are seen.
    (own.Moving == problem.Moving ||
      (own.ConstrainPositions && HasPinnedHandle(own) &&
        std::includes(
          own.Moving.begin(), own.Moving.end(), problem.Moving.begin(), problem.Moving.end())));
}
}
