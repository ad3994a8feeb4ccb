// SPDX-License-Identifier: BSD-3-Clause
#include "Merging/MeshMerge.h"

#include "Algebra/SimilarityFit.h"
#include "Deformation/SliverRemoval.h"
#include "Merging/BoundaryFrames.h"

#include <algorithm>
#include <iterator>
#include <map>

namespace cartan
{
namespace
{
enum : int
{
  Seam = 1,
  Kept = 2,
  Moving = 3
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
  const std::vector<SourceHold>& holds, SolverBackend backend, const ExecutionContext& context)
  : Source(std::move(source))
{
  HandleProblem problem;
  problem.Mesh = this->Source.Mesh;
  problem.Rest = this->Source.Positions;
  problem.Handle.assign(this->Source.Mesh->NumberOfVertices(), 0);
  problem.Moving = { Seam };
  for (std::size_t v = 0; v < holds.size(); ++v)
  {
    problem.Handle[v] = holds[v] == SourceHold::Kept ? Kept
      : holds[v] == SourceHold::Moved                ? Moving
                                                     : 0;
    if (holds[v] == SourceHold::Moved)
    {
      problem.Moving = { Seam, Moving };
    }
  }
  IdSample held;
  for (const std::vector<int>& loop : sourceLoops)
  {
    for (const int v : loop)
    {
      if (problem.Handle[v] == Kept || problem.Handle[v] == Moving)
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
  problem = WithoutSlivers(std::move(problem), context.Part(0.0, 0.1));
  RequireReached(problem);
  this->Deformer = std::make_unique<SimilarityDeformer>(
    std::move(problem), SimilarityDeformer::Options{}, backend, context.Part(0.1, 0.7));
  this->Deformer->SetReconstruction(SimilarityReconstruction::LeastSquares);
  this->Deformer->SetScaleFeatures(true);
  this->Deformer->Prepare(context.Part(0.7, 1.0));
}

FittedSource MeshMerge::Fit(const MergeInput& target, const std::vector<LoopPair>& pairs,
  const std::vector<std::vector<LoopKey>>& keys, const HandleTargets& moved,
  const ExecutionContext& context) const
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
  for (std::size_t i = 0; i < moved.Vertices.size(); ++i)
  {
    const auto row = static_cast<Eigen::Index>(i);
    positions.row(moved.Vertices[i]) = moved.Positions.row(row);
    transforms.row(moved.Vertices[i]) = moved.Transforms.row(row);
  }
  HandleTargets targets;
  targets.Motions.resize(this->Deformer->GetProblem().Moving.size());
  for (int v = 0; v < numberOfVertices; ++v)
  {
    const int handle = this->Deformer->GetProblem().Handle[v];
    if (handle == Seam || handle == Moving)
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

HandleTargets MotionTargets(const Points& rest, const std::vector<int>& handles,
  const std::vector<int>& moving, const std::vector<HandleMotion>& motions)
{
  HandleTargets targets;
  std::vector<const HandleMotion*> motionOf;
  for (std::size_t v = 0; v < handles.size(); ++v)
  {
    const auto found = std::lower_bound(moving.begin(), moving.end(), handles[v]);
    if (found != moving.end() && *found == handles[v])
    {
      targets.Vertices.push_back(static_cast<int>(v));
      motionOf.push_back(&motions[found - moving.begin()]);
    }
  }
  const auto count = static_cast<Eigen::Index>(targets.Vertices.size());
  targets.Positions.resize(count, 3);
  targets.Transforms.resize(count, 9);
  for (Eigen::Index row = 0; row < count; ++row)
  {
    const HandleMotion& motion = *motionOf[row];
    const Eigen::Vector3d point = rest.row(targets.Vertices[row]).transpose();
    targets.Positions.row(row) = (motion.Linear * point + motion.Translation).transpose();
    MatrixAt(targets.Transforms, row) = motion.Linear;
  }
  return targets;
}

HandleTargets FeatureTargets(
  const Points& rest, const Points& fitted, const std::vector<int>& features)
{
  std::map<int, std::vector<int>> members;
  for (std::size_t v = 0; v < features.size(); ++v)
  {
    if (features[v] > 0)
    {
      members[features[v]].push_back(static_cast<int>(v));
    }
  }
  std::vector<int> ids;
  std::vector<HandleMotion> motions;
  for (const auto& [feature, vertices] : members)
  {
    const Points from = rest(vertices, Eigen::all);
    if (!SpanPlane(from))
    {
      throw Error(ErrorCode::BadInput,
        "The points of feature " + std::to_string(feature) +
          " are fewer than three, or on one line, so nothing says how it turns: mark more points.");
    }
    const Eigen::Matrix4d similarity = FitSimilarity(from, fitted(vertices, Eigen::all));
    HandleMotion motion;
    motion.Linear = similarity.topLeftCorner<3, 3>();
    motion.Translation = similarity.topRightCorner<3, 1>();
    ids.push_back(feature);
    motions.push_back(motion);
  }
  return MotionTargets(rest, features, ids, motions);
}

void AddTargets(const HandleTargets& more, HandleTargets& all)
{
  const HandleTargets before = std::move(all);
  all = {};
  std::merge(before.Vertices.begin(), before.Vertices.end(), more.Vertices.begin(),
    more.Vertices.end(), std::back_inserter(all.Vertices));
  const auto count = static_cast<Eigen::Index>(all.Vertices.size());
  all.Positions.resize(count, 3);
  all.Transforms.resize(count, 9);
  for (const HandleTargets* part : { &before, &more })
  {
    for (std::size_t i = 0; i < part->Vertices.size(); ++i)
    {
      const Eigen::Index row = all.Row(part->Vertices[i]);
      all.Positions.row(row) = part->Positions.row(static_cast<Eigen::Index>(i));
      all.Transforms.row(row) = part->Transforms.row(static_cast<Eigen::Index>(i));
    }
  }
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
