// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// The rotation of each vertex that carries its one-ring from one surface to
/// another of the same connectivity best (Kabsch, A solution for the best
/// rotation to relate two sets of vectors, 1976): #V x 9, the S that maximizes
///
///   sum over edges of <v, S u> + sum over triangles of <n, S m>,
///
/// u and v the unit vectors along an edge of the ring in both surfaces, m and n
/// the unit normals of a triangle. Directions rather than lengths, so that a long
/// edge does not decide for all; normals, so that a ring on one line does not
/// spin. Edges without length and triangles without area do not count. The
/// identity for unused vertices.
Matrices RingRotations(const TriangleMesh& mesh, const Points& from, const Points& to,
  const ExecutionContext& context = {});

/// Frames that follow the one-rings from key frame to key frame: one #V x 9 per
/// entry of `keys`, right-handed and orthonormal, turned by RingRotations from
/// each key frame to the next. Seen from them a one-ring changes only its shape,
/// also where the normal is of no use: where edges are nearly parallel to it, or
/// where triangles fold back on each other.
///
/// They depend only on the shape of the one-rings: those of key frames that are
/// moved rigidly are moved alike, and those of the key frames in reverse order are
/// the same.
std::vector<Matrices> RingFrames(
  const TriangleMesh& mesh, const std::vector<Points>& keys, const ExecutionContext& context = {});
}
