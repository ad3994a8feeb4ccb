// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/SurfaceDeformer.h"

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
}
