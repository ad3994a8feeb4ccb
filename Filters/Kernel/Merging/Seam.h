// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Merging/LoopMatching.h"
#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// A pair of boundary loops that are sewn together: vertices of the source and of the
/// target, running the same way, so against the order of BoundaryLoop on one side, and
/// the place of each source vertex on the target's.
struct SeamLoop
{
  std::vector<int> Source;
  std::vector<int> Target;
  std::vector<CurvePlace> Places; ///< of each of Source
};

/// The closest target vertex takes a source vertex whose place is within this part of
/// a segment: no slivers, and no vertices in one place.
constexpr double SnapPart = 0.3;

/// For each of loop.Source the index in loop.Target of the vertex that it becomes one
/// with, or -1. No vertex takes two.
std::vector<int> SnappedVertices(const SeamLoop& loop);

/// Two surfaces that are sewn together.
struct JoinedSurface
{
  Triangles Faces; ///< those of the target first, then the source's
  /// Whether a face is the source's, and the triangle it is, or is a part of.
  std::vector<char> IsSourceFace;
  std::vector<int> OriginalFaces;
  /// The vertex in the target and in the source: -1 where there is none. Vertices of
  /// the target keep their numbers; those of both are on the seam.
  std::vector<int> TargetVertices;
  std::vector<int> SourceVertices;
  std::vector<char> IsSeam;

  int NumberOfVertices() const { return static_cast<int>(this->TargetVertices.size()); }
};

/// Sews the boundaries together without removing a triangle: each boundary polygon gets
/// the vertices of the other one, which split its triangles (their common refinement).
/// Throws Error(BadInput) when an edge would get more than two triangles.
JoinedSurface JoinSurfaces(
  const TriangleMesh& target, const TriangleMesh& source, const std::vector<SeamLoop>& loops);

/// The vertices with IsSeam, in increasing order.
std::vector<int> SeamVertices(const JoinedSurface& joined);

/// By how much the surface is folded along the seam: the angles, in radians, between the
/// normals of triangles of the target and of the source that have an edge in common.
struct SeamAngles
{
  double Mean = 0.0;
  double Maximum = 0.0;
};

/// `mesh` has joined.Faces, `points` its vertices.
SeamAngles MeasureSeam(const JoinedSurface& joined, const TriangleMesh& mesh, const Points& points);
}
