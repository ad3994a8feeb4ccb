// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/SurfacePiece.h"

#include <vector>

namespace cartan
{
/// The triangles of a piece as TriangleMesh takes them.
struct PieceMesh
{
  Triangles Corners;
  /// The ghost that each vertex beyond the piece's points repeats. A piece may have several
  /// fans of triangles around a ghost, whose others are elsewhere: each gets a vertex.
  std::vector<int> CopyOf;
};

/// Collective. Throws Error(BadInput) with the texts of MeshReport, and global ids of
/// points, when the whole surface is no oriented manifold, or has coordinates that are no
/// numbers. Of each edge and point it is the owner, of an edge that of the end with the
/// smaller id, who tells: it sees all of its triangles.
PieceMesh MakePieceMesh(const SurfacePiece& piece);
}
