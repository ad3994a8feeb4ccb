// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Types.h"

#include <vector>

/// Which places of one closed curve belong to which of another. Curves are closed
/// polygons (#C x 3), their last vertex joined to the first, and run the same way.
namespace cartan
{
/// A place on a closed polygon.
struct CurvePlace
{
  int Segment = 0;       ///< from this vertex to the next
  double Fraction = 0.0; ///< of the segment, in [0, 1)
};

/// A vertex of the source's curve and its place on the target's.
struct LoopKey
{
  int Source = 0; ///< index in the curve
  CurvePlace Target;
};

/// The point at a place.
Eigen::RowVector3d PointAt(const Points& curve, const CurvePlace& place);

/// The place of each vertex of `source` on `target`: between keys, equal parts of
/// the lengths correspond (Fu, Au, Tai, Effective Derivation of Similarity
/// Transformations for Implicit Laplacian Mesh Editing, 2007, section 5.1). At least
/// one key, in any order. Throws Error(BadInput) where keys do not follow each other
/// in the same order around both curves, with indices in `keys` as ids, or where a
/// curve has no length.
std::vector<CurvePlace> MatchLoops(
  const Points& source, const Points& target, std::vector<LoopKey> keys);

/// Whether curves are compared as they lie, or after the similarity (rotation,
/// scale and shift) that takes them closest to each other.
enum class LoopAlignment
{
  AsTheyLie,
  BySimilarity
};

/// Where the first vertex of `source` is to go, so that curves matched by their
/// lengths from there on are closest: least squared distance over samples. Of
/// turns that are equally good, as around circles, that of the smallest place.
LoopKey FindFirstKey(const Points& source, const Points& target, LoopAlignment alignment);
}
