// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// Grows sets of vertices, one after the other. O(#V) for the marks, once.
class RingGrowth
{
public:
  explicit RingGrowth(const TriangleMesh& mesh)
    : Mesh(mesh)
    , LastGrowth(mesh.NumberOfVertices(), 0)
  {
  }

  /// The vertices within `rings` edges of the seeds, nearest first and the seeds
  /// before all. None is there twice. Valid until the next call. O(their number).
  const std::vector<int>& Grow(const std::vector<int>& seeds, int rings);

private:
  void Reach(int v);

  const TriangleMesh& Mesh;
  std::vector<int> LastGrowth; // #V, the last one that reached the vertex
  std::vector<int> Reached;
  int Growth = 0; // counts from 1
};

/// The same for a single set.
std::vector<int> GrowByRings(const TriangleMesh& mesh, const std::vector<int>& seeds, int rings);
}
