// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Merging/SurfacePlace.h"
#include "Mesh/TriangleMesh.h"

#include <memory>
#include <vector>

namespace cartan
{
/// A surface of which a part was cut off along an isoline. Vertices of the whole keep
/// their numbers, and are in no triangle where they were cut off; those where the isoline
/// crosses edges come after them.
struct CutSurface
{
  std::shared_ptr<const TriangleMesh> Mesh;
  std::shared_ptr<const Points> Positions;
  std::vector<SurfacePlace> Places; ///< #V: where each vertex is on the whole surface
  std::vector<int> OriginalFaces;   ///< #T: the triangle of the whole that it is part of
  std::vector<char> IsOnIsoline;    ///< #V
};

/// Keeps the part of a surface where a function, linear in each triangle (`values`, #V),
/// is at least `level`. Where the isoline passes a vertex within a fifth of an edge it
/// goes through it, so that no slivers arise, unless the surface would touch itself
/// there. Values of vertices beside smaller ones than the level must be finite.
CutSurface CutBelow(
  const TriangleMesh& mesh, const Points& points, const Eigen::VectorXd& values, double level);
}
