// SPDX-License-Identifier: BSD-3-Clause
#include "Merging/MeshMerge.h"

#include "Deformation/SliverRemoval.h"
#include "Merging/BoundaryFrames.h"

namespace cartan
{
namespace
{
enum : int
{
  Seam = 1,
  Held = 2
};

BoundaryCurve CurveOf(const MergeInput& surface, const std::vector<int>& loop)
{
  return { (*surface.Positions)(loop, Eigen::all),
    AngleWeightedNormals(*surface.Mesh, *surface.Positions, loop) };
}

/// Throws where a part of the source is neither sewn on nor held: it has no place.
void RequireReached(const HandleProblem& problem)
{
  const TriangleMesh& mesh = *problem.GetWhole();
  std::vector<char> isReached(mesh.NumberOfComponents(), 0);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v) && problem.Handle[v] != 0)
    {
      isReached[mesh.Component(v)] = 1;
    }
  }
  IdSample loose;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v) && !isReached[mesh.Component(v)])
    {
      loose.Add(v);
      isReached[mesh.Component(v)] = 1;
    }
  }
  if (!loose.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "Parts of the source are not sewn on, those of " + loose.Describe("point", "points") +
        ". Give their boundaries keys, hold them (DEPENDENT), or remove them (Connectivity).");
  }
}

/// Where the vertices of a loop go: to their places, or to the vertex that they become
/// one with.
Points SeamPositions(const SeamLoop& loop, const Points& target)
{
  const std::vector<int> snapped = SnappedVertices(loop);
  Points positions(static_cast<Eigen::Index>(loop.Places.size()), 3);
  for (std::size_t i = 0; i < loop.Places.size(); ++i)
  {
    positions.row(static_cast<Eigen::Index>(i)) = snapped[i] >= 0
      ? Eigen::RowVector3d(target.row(snapped[i]))
      : PointAt(target, loop.Places[i]);
  }
  return positions;
}
}

MeshMerge::MeshMerge(MergeInput source, const std::vector<std::vector<int>>& sourceLoops,
  const std::vector<char>& isHeld, SolverBackend backend, const ExecutionContext& context)
  : Source(std::move(source))
{
  HandleProblem problem;
  problem.Mesh = this->Source.Mesh;
  problem.Rest = this->Source.Positions;
  problem.Handle.assign(this->Source.Mesh->NumberOfVertices(), 0);
  for (std::size_t v = 0; v < isHeld.size(); ++v)
  {
    problem.Handle[v] = isHeld[v] ? Held : 0;
  }
  IdSample held;
  for (const std::vector<int>& loop : sourceLoops)
  {
    for (const int v : loop)
    {
      if (problem.Handle[v] == Held)
      {
        held.Add(v);
      }
      problem.Handle[v] = Seam;
    }
  }
  if (!held.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      held.Describe("point", "points") +
        " of the source's boundary cannot be held and sewn on: unmark the boundary.");
  }
  problem.Moving = { Seam };
  problem = WithoutSlivers(std::move(problem), context.Part(0.0, 0.1));
  RequireReached(problem);
  this->Deformer = std::make_unique<SimilarityDeformer>(
    std::move(problem), SimilarityDeformer::Options{}, backend, context.Part(0.1, 0.7));
  this->Deformer->SetReconstruction(SimilarityReconstruction::LeastSquares);
  this->Deformer->SetScaleFeatures(true);
  this->Deformer->Prepare(context.Part(0.7, 1.0));
}

FittedSource MeshMerge::Fit(const MergeInput& target, const std::vector<LoopPair>& pairs,
  const std::vector<std::vector<LoopKey>>& keys, const ExecutionContext& context) const
{
  FittedSource fitted;
  const int numberOfVertices = this->Source.Mesh->NumberOfVertices();
  Points positions = Points::Zero(numberOfVertices, 3);
  Matrices transforms = Identities(numberOfVertices);
  for (std::size_t p = 0; p < pairs.size(); ++p)
  {
    const LoopPair& pair = pairs[p];
    const BoundaryCurve from = CurveOf(this->Source, pair.Source);
    const BoundaryCurve to = CurveOf(target, pair.Target);
    SeamLoop loop{ pair.Source, pair.Target, MatchLoops(from.Positions, to.Positions, keys[p]) };
    const Matrices similarities = LoopSimilarities(from, to, loop.Places, pair.Source);
    positions(pair.Source, Eigen::all) = SeamPositions(loop, to.Positions);
    transforms(pair.Source, Eigen::all) = similarities;
    fitted.Loops.push_back(std::move(loop));
  }
  HandleTargets targets;
  targets.Motions.resize(1);
  for (int v = 0; v < numberOfVertices; ++v)
  {
    if (this->Deformer->GetProblem().Handle[v] == Seam)
    {
      targets.Vertices.push_back(v);
    }
  }
  targets.Positions = positions(targets.Vertices, Eigen::all);
  targets.Transforms = transforms(targets.Vertices, Eigen::all);
  DeformedSurface deformed;
  this->Deformer->Deform(targets, false, deformed, context);
  fitted.Positions = std::move(deformed.Positions);
  fitted.Warning = this->Deformer->GetWarning();
  return fitted;
}

Points JoinedPositions(
  const JoinedSurface& joined, const Points& target, const Points& fittedSource)
{
  Points positions(joined.NumberOfVertices(), 3);
  for (int v = 0; v < joined.NumberOfVertices(); ++v)
  {
    const int ofTarget = joined.TargetVertices[v];
    positions.row(v) =
      ofTarget >= 0 ? target.row(ofTarget) : fittedSource.row(joined.SourceVertices[v]);
  }
  return positions;
}
}
