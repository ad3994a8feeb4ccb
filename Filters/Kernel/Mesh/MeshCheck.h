// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Error.h"
#include "Base/Types.h"

#include <string>
#include <vector>

namespace cartan
{
/// What is wrong with a mesh: for each defect how many and the first ids.
/// Point ids are rows of Points, triangle ids are rows of Triangles.
///
/// What concerns the triangles alone is found by TriangleMesh::Build, what
/// concerns the points by CheckPositions, so that triangles which several sets of
/// points share are checked once.
struct MeshReport
{
  long long TooManyTriangles = 0; ///< their number if there are more than supported, else 0
  IdSample OutOfRange;            ///< triangles that name a vertex that is not there
  IdSample RepeatedVertex;        ///< triangles that name a vertex twice
  IdSample NonManifoldEdges;      ///< edges of more than two triangles; the smaller end point's id
  IdSample InconsistentEdges;     ///< edges that both triangles run through in the same direction
  IdSample NonManifoldVertices;   ///< vertices whose triangles do not form one fan
  IdSample NonFinite;             ///< points with a NaN or infinite coordinate
  IdSample ZeroArea;              ///< triangles without area: degenerate, but no obstacle
  IdSample Unused;                ///< points in no triangle: no obstacle

  /// Whether the triangles are an oriented manifold, as TriangleMesh needs it.
  bool IsManifold() const;

  /// Whether, besides, all coordinates are finite.
  bool IsUsable() const { return this->IsManifold() && this->NonFinite.IsEmpty(); }

  /// One sentence per obstacle with count, first ids and what to do; empty when
  /// usable. `cellIds` maps triangles to the ids the user knows (may be empty).
  std::string DescribeErrors(const std::vector<long long>& cellIds = {}) const;
};

/// Adds the points that are not finite, and the triangles without area, which
/// are those that HasArea() rejects, to `report`. Triangles that name a point
/// which is not there are skipped. O(#V + #T).
void CheckPositions(const Points& points, const Triangles& triangles, MeshReport& report);
}
