// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Base/Types.h"
#include "Mesh/EdgeFlips.h"
#include "Mesh/HoleFilling.h"

#include <string>
#include <utility>
#include <vector>

namespace cartan
{
/// The steps of RepairSurface, in their order. Those that are on by default make
/// any triangles an oriented manifold, and change nothing where they are one
/// whose borders are apart and whose closed components face outward.
struct RepairOptions
{
  /// Merges points on borders and edges of more than two triangles, and ends of
  /// edges not longer than the tolerance. Others are in nobody's way.
  bool MergesPoints = true;
  bool MergesInnerPoints = false; ///< all points: bodies in contact become one
  double MergeTolerance = 0.0;    ///< length units; 0: equal coordinates
  bool DropsDoubled = true;       ///< triangles on the same three points
  bool Orients = true;            ///< neighbors alike
  bool CutsNonManifold = true;
  bool OrientsOutwards = true;    ///< closed components
  bool AlternatesNested = true;   ///< walls of cavities inward, see OrientOutwards
  double SmallestComponent = 0.0; ///< components below this part of the area are removed
  HoleOptions Holes;              ///< none filled by default
  bool FlipsEdges = false;
  FlipOptions Flips;
};

/// What RepairSurface did and found, in numbers.
struct RepairCounts
{
  int MergedPoints = 0;       ///< points that went to another
  int CollapsedTriangles = 0; ///< dropped: they name a point twice, perhaps only once merged
  int DoubledTriangles = 0;   ///< dropped
  int TurnedTriangles = 0;    ///< turned over to agree with their neighbors
  int OneSidedEdges = 0;      ///< edges cut because a part has one side only, as a Moebius strip
  int NonManifoldEdges = 0;   ///< edges of more than two triangles
  int CutPoints = 0;          ///< points that got copies
  int CopiedPoints = 0;       ///< their copies
  int ReversedComponents = 0; ///< closed ones turned over as a whole
  int RemovedComponents = 0;
  int FilledHoles = 0;
  int OpenHoles = 0; ///< loops of border edges that are left; counted only when filling
  int FillTriangles = 0;
  int FlippedEdges = 0;

  /// All of them with their names, in this order.
  std::vector<std::pair<std::string, int>> List() const;

  /// One sentence per kind that is not 0; "Nothing was to repair." if all are.
  std::string Describe() const;
};

/// The repaired surface, and which of its points and triangles come from which.
/// The `input` has #V points and #T triangles, the result #V' and #T'.
struct RepairedSurface
{
  Points Positions;                   ///< #V' x 3, each the place of its original point
  Triangles Faces;                    ///< #T' x 3
  std::vector<int> OriginalPoints;    ///< #V': the input's point; of merged ones the first
  std::vector<int> OriginalTriangles; ///< #T': the input's triangle; -1 in a filled hole
  /// #V: the point of the result that an input point has become, in the first of
  /// its triangles where it was cut; -1 when it has gone with all its triangles.
  std::vector<int> PreparedPoints;
  /// #V': the first of the copies that a cut made of one point; itself elsewhere.
  std::vector<int> CopyOf;
  RepairCounts Counts;
};

/// Repairs triangles that need not be a manifold, nor consistently oriented, nor
/// joined. Points in no triangle stay as they are. With MergesPoints and
/// CutsNonManifold, and with neighbors that agree or Orients, TriangleMesh takes
/// the result.
///
/// Throws Error(BadInput) when a vertex id is out of range, a used point is not
/// finite, or no triangle is left; Error(Aborted).
RepairedSurface RepairSurface(const Points& points, const Triangles& triangles,
  const RepairOptions& options = {}, const ExecutionContext& context = {});
}
