// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Types.h"
#include "Mesh/MeshCheck.h"

#include <limits>
#include <vector>

namespace cartan
{
/// The connectivity of an oriented triangle mesh that is a 2-manifold, possibly
/// with boundary, in several components, and with unused vertices.
///
/// Everything hangs on *directed edges*: the one-ring of vertex v are the
/// directed edges RingBegin(v) ... RingEnd(v) - 1, counter-clockwise seen from
/// outside. The ring of a boundary vertex starts at the boundary edge that has
/// a triangle on its left and ends at the one that has none; the ring of an
/// interior vertex starts at an arbitrary neighbor that depends on the
/// triangles' order only. Where vertices are joined (see Joined), a ring may be
/// several such fans, one after the other, the open ones last.
class TriangleMesh
{
public:
  TriangleMesh() = default;

  /// A triangle has three edges of two directions each when none is shared, and
  /// directed edges are numbered with int.
  static constexpr int MostTriangles = std::numeric_limits<int>::max() / 6;

  /// Makes the mesh and adds all that is wrong with the triangles to `report`,
  /// in one sort of the corners and one walk around each vertex. Where
  /// report.IsManifold() is false afterwards the mesh is empty and `triangles`
  /// are still there. O(#V + #T).
  static TriangleMesh Build(int numberOfVertices, Triangles&& triangles, MeshReport& report);

  /// The same, but throws Error(BadInput) with MeshReport::DescribeErrors().
  TriangleMesh(int numberOfVertices, Triangles triangles);

  /// All that is wrong with triangles and points together.
  static MeshReport Check(const Points& points, Triangles triangles);

  /// The same triangles on fewer vertices: vertex v becomes joinedWith[v] (#V), which
  /// is itself where it stands for others, or alone. Two sides of the border that run
  /// in opposite directions and come to lie on each other, with no third, are one edge
  /// again; all others, and the interior, stay as they are. So fans may meet in a vertex,
  /// and several edges may run between two vertices, each with its own twin: what sums
  /// over rings or triangles sums over all of them. Other vertices' rings keep their
  /// order. No triangle may have two vertices that are joined. O(#V + #T).
  TriangleMesh Joined(const std::vector<int>& joinedWith) const;

  int NumberOfVertices() const { return static_cast<int>(this->RingOffsets.size()) - 1; }
  int NumberOfTriangles() const { return static_cast<int>(this->Corners.rows()); }
  int NumberOfDirectedEdges() const { return static_cast<int>(this->Neighbors.size()); }
  int NumberOfEdges() const { return this->NumberOfDirectedEdges() / 2; }
  int NumberOfComponents() const { return this->ComponentCount; }
  const Triangles& GetTriangles() const { return this->Corners; }

  int RingBegin(int v) const { return this->RingOffsets[v]; }
  int RingEnd(int v) const { return this->RingOffsets[v + 1]; }
  int Valence(int v) const { return this->RingEnd(v) - this->RingBegin(v); }

  /// Whether v is in a triangle.
  bool IsUsed(int v) const { return this->RingEnd(v) > this->RingBegin(v); }

  /// Whether v is on the boundary; false for unused vertices.
  bool IsBoundary(int v) const
  {
    return this->IsUsed(v) && this->RingTriangles[this->RingEnd(v) - 1] < 0;
  }

  /// The memory that it holds.
  std::size_t GetBytes() const;

  /// The component of v, numbered from 0 in the order of their first vertices;
  /// -1 for unused vertices.
  int Component(int v) const { return this->Components[v]; }

  /// The vertices to fix so that nothing floats: non-zero at the first vertex of
  /// each component and at unused ones. #V.
  std::vector<char> Grounded() const;

  /// Where the directed edge d starts and ends.
  int Origin(int d) const { return this->Neighbors[this->Twins[d]]; }
  int Neighbor(int d) const { return this->Neighbors[d]; }

  /// The same edge in the other direction.
  int Twin(int d) const { return this->Twins[d]; }

  /// The triangle on the left of d; -1 at the boundary.
  int LeftTriangle(int d) const { return this->RingTriangles[d]; }

  /// The next directed edge counter-clockwise around the origin of d, so that
  /// (Origin(d), Neighbor(d), Neighbor(Next(d))) is LeftTriangle(d); -1 where
  /// there is no triangle.
  int Next(int d) const { return this->NextAround(this->Origin(d), d); }
  int NextAround(int origin, int d) const
  {
    if (this->RingTriangles[d] < 0)
    {
      return -1;
    }
    if (!this->NextInFan.empty())
    {
      return this->NextInFan[d];
    }
    return d + 1 < this->RingEnd(origin) ? d + 1 : this->RingBegin(origin);
  }

  /// The vertex opposite to d in the triangle on its left; -1 at the boundary.
  int Opposite(int d) const
  {
    const int next = this->Next(d);
    return next < 0 ? -1 : this->Neighbors[next];
  }

private:
  void MakeRings(std::vector<int>& corners, const std::vector<int>& lastCorners,
    const Triangles& triangles, MeshReport& report);
  void MakeTwins(const std::vector<int>& edgeOfCorner);
  void AddFans(const int* begin, const int* end, const std::vector<int>& mates,
    std::vector<int>& edgeOfCorner);
  void AddFan(int start, const std::vector<int>& mates, std::vector<int>& edgeOfCorner);
  void FindComponents();

  Triangles Corners;
  std::vector<int> RingOffsets = { 0 }; // #V + 1
  std::vector<int> Neighbors;           // #D
  std::vector<int> RingTriangles;       // #D
  std::vector<int> Twins;               // #D
  std::vector<int> NextInFan;           // #D where a ring may be several fans, else empty
  std::vector<int> Components;          // #V
  int ComponentCount = 0;
};
}
