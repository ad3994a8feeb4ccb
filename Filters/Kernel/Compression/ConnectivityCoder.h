// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/TriangleMesh.h"

#include <cstddef>
#include <vector>

namespace cartan
{
/// Triangles and vertices in the order in which EncodeTriangles() meets them.
struct TraversalOrder
{
  Triangles Faces;           ///< #T x 3, by new numbers
  std::vector<int> Vertices; ///< the old number of each new one: #V
  int NumberOfUsed = 0;      ///< vertices in triangles, which come first

  /// Rows of `values`, which are in the old order, in the new one.
  Points Reordered(const Points& values) const;
};

TraversalOrder OrderByTraversal(const TriangleMesh& mesh);

/// Codes the triangles of a mesh in 1 to 3 bits per vertex. The surface is conquered triangle by
/// triangle (Gumhold, Strasser, Real Time Compression of Triangle Mesh Connectivity, SIGGRAPH
/// 1998): the front is the boundary of what is conquered; at an open edge of it, the gate, the
/// code says whether the next triangle has a new vertex or which of the front. Gates go around
/// one vertex after the other (Touma, Gotsman, Triangle Mesh Compression, Graphics Interface
/// 1998), and how many triangles the two ends of a gate have says what probably comes: on a
/// regular surface that is almost certain. Throws Error(BadInput) unless the mesh has the
/// order of OrderByTraversal().
std::vector<unsigned char> EncodeTriangles(const TriangleMesh& mesh);

/// Decoded triangles need not be a manifold's. Throws Error(BadInput) when the bytes are no code
/// of so many triangles, or when these have more than `mostVertices` vertices. Takes memory
/// and time in proportion to `numberOfTriangles`.
Triangles DecodeTriangles(
  const unsigned char* bytes, std::size_t size, int numberOfTriangles, std::size_t mostVertices);
}
