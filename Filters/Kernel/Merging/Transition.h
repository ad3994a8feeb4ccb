// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Merging/IsolineCut.h"
#include "Merging/MeshMerge.h"
#include "Merging/TransitionBand.h"

#include <cstddef>
#include <vector>

namespace cartan
{
/// Renames the triangles of the target that a joined surface has (OriginalFaces) as those of
/// the target before it was cut.
void NameWholeFaces(const CutSurface& cut, JoinedSurface& joined);

/// How wide both bands are, over the target and over the source as it is fitted; > 0, in the
/// target's length units. Details fade by the part of the source's width.
struct TransitionWidths
{
  double Target;
  double Source;
};

/// How the vertices of a joined surface fade from the target into the source.
struct Fading
{
  /// #V: 0 where details are the target's, 1 where they are the source's.
  Eigen::VectorXd SourceParts;
  /// #V: the place on the target, before it was cut; meaningless where SourceParts is 1.
  std::vector<SurfacePlace> TargetPlaces;
};

/// Merging with overlapping transition regions (Fu, Au, Tai 2007, section 5.3): bands of
/// given widths along the loops of both surfaces come to lie on each other, and details fade
/// from the target's into the source's across them. The target is cut off at its band's
/// end, so that the source's loop is sewn on there, and the source's band takes the
/// place of the target's, with the source's triangles. Places belong together by
/// cylinder coordinates (FindCoordinates) instead of by a map of bands that are cut open.
class Transition
{
public:
  /// `pairs` are those of both surfaces' loops. Throws Error(BadInput) where it is too wide
  /// for the target (FindBands).
  Transition(const MergeInput& target, const std::vector<LoopPair>& pairs,
    const TransitionWidths& widths, const ExecutionContext& context = {});

  /// The target without its bands.
  const CutSurface& GetCut() const { return this->Cut; }

  /// The pairs with the target's loops at its bands' ends.
  const std::vector<LoopPair>& GetPairs() const { return this->Pairs; }

  /// The keys at the same angles there.
  std::vector<std::vector<LoopKey>> MoveKeys(const std::vector<std::vector<LoopKey>>& keys) const;

  /// Blends the details where the joined surface (`joined` of GetCut().Mesh and the
  /// source, `mesh` its triangles, `positions` its points) is in the source's band:
  ///
  ///   min |M^-1 L x - (1 - t) M^-1 L x_T - t M^-1 L x_S|^2
  ///
  /// with the points outside the band given, x_S the fitted source, x_T the target's
  /// points at the same angles and parts of the widths, and t rising smoothly from 0 at the
  /// seam to 1 at the band's end. All with one operator, that of the joined surface:
  /// so where both agree, nothing changes. `holds` (empty or #V of the source) must be Free in
  /// the band, or Error(BadInput) is thrown, as where the band is too wide for the source.
  Fading Fade(const TriangleMesh& source, const FittedSource& fitted,
    const std::vector<SourceHold>& holds, const JoinedSurface& joined, const TriangleMesh& mesh,
    Points& positions, const ExecutionContext& context = {}) const;

  /// The memory that it holds by itself, without the target's.
  std::size_t GetBytes() const;

private:
  Eigen::VectorXd IsolineAngles(std::size_t pair) const;
  Eigen::VectorXd LoopAngles(std::size_t pair, const SeamLoop& loop) const; // of the source's
  Fading FindFading(const TriangleMesh& source, const FittedSource& fitted,
    const TransitionBands& bands, const JoinedSurface& joined) const;
  std::vector<SurfacePlace> TargetPlaces(
    std::size_t pair, const BandCoordinates& band, const Eigen::VectorXd& distances) const;

  MergeInput Target;
  std::vector<LoopPair> OldPairs;
  std::vector<LoopPair> Pairs;
  TransitionWidths Widths;
  TransitionBands Bands;
  std::vector<BandCoordinates> Coordinates; // of each pair's band on the target
  CutSurface Cut;
};
}
