// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/SimilarityDeformer.h"
#include "Merging/LoopMatching.h"
#include "Merging/Seam.h"

#include <memory>
#include <vector>

namespace cartan
{
/// A mesh with its points, which others share.
struct MergeInput
{
  std::shared_ptr<const TriangleMesh> Mesh;
  std::shared_ptr<const Points> Positions; ///< #V x 3, best centered on the origin
};

/// Boundary loops that are sewn together: vertices that run the same way. So the
/// source's are in the order of BoundaryLoop, the target's against it.
struct LoopPair
{
  std::vector<int> Source;
  std::vector<int> Target;
};

/// What holds a vertex of the source.
enum class SourceHold : char
{
  Free,
  Kept, ///< its place
  Moved ///< its target, which changes from one fit to the next
};

/// The source so deformed that its boundaries lie on the target's.
struct FittedSource
{
  Points Positions; ///< #V of the source x 3, in the target's coordinates
  std::vector<SeamLoop> Loops;
  std::string Warning; ///< in sentences; empty if nothing is odd
};

/// Mesh merging by implicit similarities (Fu, Au, Tai, Effective Derivation of
/// Similarity Transformations for Implicit Laplacian Mesh Editing, Computer Graphics
/// Forum 26(1), 2007, section 5). The boundary vertices of the source are handles whose
/// positions are on the target's boundary, and whose deformation gradients are the
/// similarities that take the surroundings of one boundary to those of the other
/// (LoopSimilarities). The rest of the source follows with details that turn and scale
/// (Eq. 10).
///
/// Without vertices that are held the result does not depend on where, how large and how turned
/// the source is: it is configuration-independent, and a source that fits after a
/// similarity goes through just that. With some, they keep their place, and the source
/// is deformed between them and the seam (section 5.2; the boundary turns there too, s_i
/// R_i instead of the paper's s_i, which leaves a fold where the surfaces meet at an
/// angle).
class MeshMerge
{
public:
  /// `holds` is empty or #V of the source.
  /// Factorizes once for all keys. Throws Error(BadInput) where a vertex of the loops is
  /// held, and what SimilarityDeformer throws.
  MeshMerge(MergeInput source, const std::vector<std::vector<int>>& sourceLoops,
    const std::vector<SourceHold>& holds, SolverBackend backend = SolverBackend::Automatic,
    const ExecutionContext& context = {});

  /// A set of keys for each pair of loops, which are those given to the constructor, and
  /// positions and transforms (the linear part of a motion, such as s R) of all vertices that
  /// are Moved; see MatchLoops and LoopSimilarities for what it throws.
  FittedSource Fit(const MergeInput& target, const std::vector<LoopPair>& pairs,
    const std::vector<std::vector<LoopKey>>& keys, const HandleTargets& moved = {},
    const ExecutionContext& context = {}) const;

  int GetNumberOfFactorizations() const { return this->Deformer->GetNumberOfFactorizations(); }
  std::size_t GetBytes() const { return this->Deformer->GetBytes(); }

private:
  MergeInput Source;
  std::unique_ptr<SimilarityDeformer> Deformer;
};

/// Gives `all` the rows of `more`, whose vertices it does not have.
void AddTargets(const HandleTargets& more, HandleTargets& all);

/// Targets of the vertices of handles that go through motions: one for each of `moving`, which
/// are in increasing order; `handles` are those of the vertices (#V).
HandleTargets MotionTargets(const Points& rest, const std::vector<int>& handles,
  const std::vector<int>& moving, const std::vector<HandleMotion>& motions);

/// Targets of fixed features, regions that move as one similarity: of each, the
/// similarity that takes it closest to where it came when it was free. `features` (#V): k >=
/// 1 for a vertex of feature k, 0 for others. Throws Error(BadInput) for features whose points
/// determine no similarity.
HandleTargets FeatureTargets(
  const Points& rest, const Points& fitted, const std::vector<int>& features);

/// The points of surfaces that are sewn together: the target's and the fitted
/// source's; where both have one, the target's. #V of the joined surface x 3.
Points JoinedPositions(
  const JoinedSurface& joined, const Points& target, const Points& fittedSource);
}
