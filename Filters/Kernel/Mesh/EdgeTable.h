// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Types.h"

#include <vector>

namespace cartan
{
/// The edges of triangles that need not be a manifold, each with all triangles
/// that share it.
///
/// Side 3 t + c of triangle t runs from its corner c to the next corner. The
/// sides of an edge are the triangles that share it, in the order of their ids.
class EdgeTable
{
public:
  /// Vertex ids are in range and no triangle names one twice. O(#T log valence).
  /// Throws Error(BadInput) when there are more triangles than TriangleMesh takes.
  EdgeTable(int numberOfVertices, const Triangles& triangles);

  int NumberOfEdges() const { return static_cast<int>(this->Offsets.size()) - 1; }

  /// The sides of an edge.
  const int* Begin(int edge) const { return this->Sides.data() + this->Offsets[edge]; }
  const int* End(int edge) const { return this->Sides.data() + this->Offsets[edge + 1]; }
  int NumberOfSides(int edge) const { return this->Offsets[edge + 1] - this->Offsets[edge]; }

private:
  std::vector<int> Offsets; // #E + 1
  std::vector<int> Sides;   // 3 #T, grouped by edge
};

/// Where a side starts and where it ends.
inline int SideFrom(const Triangles& triangles, int side)
{
  return triangles.data()[side];
}
inline int SideTo(const Triangles& triangles, int side)
{
  return triangles.data()[side % 3 == 2 ? side - 2 : side + 1];
}

/// The vertex of the side's triangle that is not on the side.
inline int SideApex(const Triangles& triangles, int side)
{
  return triangles.data()[side % 3 == 0 ? side + 2 : side - 1];
}
}
