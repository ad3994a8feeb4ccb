// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/SurfaceDeformer.h"

#include "Deformation/HandleLaplacian.h"
#include "Deformation/JoinedVertices.h"

namespace cartan
{
namespace
{
/// Handles put their vertices where they are to go, riders too.
void PlaceRidersOfHandles(
  const HandleProblem& problem, const HandleTargets& targets, DeformedSurface& result)
{
  for (const Rider& rider : problem.Riders)
  {
    const int id = problem.Handle[rider.Vertex];
    if (id > 0 && problem.ConstrainPositions)
    {
      const auto found = std::lower_bound(problem.Moving.begin(), problem.Moving.end(), id);
      const bool isMoving = found != problem.Moving.end() && *found == id;
      const int handle = isMoving ? static_cast<int>(found - problem.Moving.begin()) : -1;
      result.Positions.row(rider.Vertex) =
        HandleTarget(problem, targets, rider.Vertex, handle).transpose();
    }
  }
}
}

void SurfaceDeformer::RequireWholeUnlessServed(const HandleTargets& targets) const
{
  if (this->Problem.Pieces && !this->ServesPieces())
  {
    throw Error(ErrorCode::BadInput,
      "These settings do not serve a surface in pieces: gather the surface on one process.");
  }
  if (this->Problem.Pieces && (targets.IsPerVertex() || targets.RotationVectors.rows()))
  {
    throw Error(ErrorCode::BadInput,
      "Handles of a surface in pieces move as a whole: give each handle a motion instead of arrays "
      "of targets, or gather the surface on one process.");
  }
}

HandleTargets SurfaceDeformer::Relative(const HandleTargets& targets)
{
  this->RequireWholeUnlessServed(targets);
  if (!this->Common)
  {
    this->Common = std::make_unique<CommonMotion>(this->Problem);
  }
  return this->Common->Remove(targets);
}

bool SurfaceDeformer::IsLocal(const HandleTargets& targets)
{
  return !this->Problem.Pieces || (this->Common && this->IsLocalRelative(this->Relative(targets)));
}

void SurfaceDeformer::Deform(const HandleTargets& targets, bool wantTransforms,
  DeformedSurface& result, const ExecutionContext& context)
{
  const HandleTargets relative = this->Relative(targets);
  this->RowsRelative(relative, context.Part(0.0, 0.3));
  this->DeformFrom(targets, relative, wantTransforms, result, context);
}

PositionRows SurfaceDeformer::DeformInRows(
  const HandleTargets& targets, DeformedSurface& result, const ExecutionContext& context)
{
  const HandleTargets relative = this->Relative(targets);
  PositionRows rows = this->RowsRelative(relative, context.Part(0.0, 0.3));
  // Vertices that others decide about need the whole surface.
  const bool isAlone = this->Problem.JoinedWith.empty() && this->Problem.Riders.empty() &&
    !(this->FollowsRigidHandles() && this->Common->HasRigidRegions(relative));
  if (rows && isAlone)
  {
    return [this, rows = std::move(rows)](int begin, int end, double* positions)
    {
      rows(begin, end, positions);
      this->Common->RestoreRows(begin, end, positions);
    };
  }
  this->DeformFrom(targets, relative, false, result, context);
  return {};
}

void SurfaceDeformer::DeformFrom(const HandleTargets& targets, const HandleTargets& relative,
  bool wantTransforms, DeformedSurface& result, const ExecutionContext& context)
{
  this->DeformRelative(relative, wantTransforms, result, context);
  if (this->FollowsRigidHandles())
  {
    this->Common->Follow(relative, wantTransforms, result);
  }
  this->Common->Restore(wantTransforms, result);
  FollowJoined(this->Problem.JoinedWith, result.Positions);
  FollowJoined(this->Problem.JoinedWith, result.Transforms);
  FollowJoined(this->Problem.JoinedWith, result.FrameScale);
  CarryRiders(this->Problem.Riders, *this->Problem.Rest, result);
  PlaceRidersOfHandles(this->Problem, targets, result);
}
}
