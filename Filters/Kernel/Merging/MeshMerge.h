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
/// Without held vertices the result does not depend on where, how large and how turned
/// the source is: it is configuration-independent, and a source that fits after a
/// similarity goes through just that. With some, they keep their place, and the source
/// is deformed between them and the seam (section 5.2; the boundary turns there too, s_i
/// R_i instead of the paper's s_i, which leaves a fold where the surfaces meet at an
/// angle).
class MeshMerge
{
public:
  /// `isHeld` is empty or #V of the source, non-zero where a vertex keeps its place.
  /// Factorizes once for all keys. Throws Error(BadInput) where a vertex of the loops is
  /// held, and what SimilarityDeformer throws.
  MeshMerge(MergeInput source, const std::vector<std::vector<int>>& sourceLoops,
    const std::vector<char>& isHeld, SolverBackend backend = SolverBackend::Automatic,
    const ExecutionContext& context = {});

  /// A set of keys for each pair of loops, which are those given to the constructor;
  /// see MatchLoops and LoopSimilarities for what it throws.
  FittedSource Fit(const MergeInput& target, const std::vector<LoopPair>& pairs,
    const std::vector<std::vector<LoopKey>>& keys, const ExecutionContext& context = {}) const;

  int GetNumberOfFactorizations() const { return this->Deformer->GetNumberOfFactorizations(); }
  std::size_t GetBytes() const { return this->Deformer->GetBytes(); }

private:
  MergeInput Source;
  std::unique_ptr<SimilarityDeformer> Deformer;
};

/// The points of surfaces that are sewn together: the target's and the fitted
/// source's; where both have one, the target's. #V of the joined surface x 3.
Points JoinedPositions(
  const JoinedSurface& joined, const Points& target, const Points& fittedSource);
}
