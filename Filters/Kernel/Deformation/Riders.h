// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Types.h"

#include <array>
#include <vector>

namespace cartan
{
struct DeformedSurface;

/// A vertex that is in no triangle of a deformer's mesh, but goes with one.
struct Rider
{
  int Vertex;
  std::array<int, 3> Corners; ///< vertices of the mesh, or riders after this one
  Eigen::Vector3d Weights;    ///< barycentric coordinates of its foot
  double Height;              ///< over the triangle, in parts of the root of twice its area
};

/// The rider on a triangle that has an area.
Rider MakeRider(const Points& points, int vertex, const std::array<int, 3>& corners);

/// Puts the riders where the triangles that carry them went: from `rest`, in the
/// barycentric coordinates and at the height that they have there; exactly where
/// they are when the triangle did not move. Writes Positions, and Transforms and
/// FrameScale where those are filled.
void CarryRiders(const std::vector<Rider>& riders, const Points& rest, DeformedSurface& result);

/// Gives riders the weighted means of the values, a row per vertex, at their corners.
/// Nothing where there are no values.
template <typename Values>
void MeansForRiders(const std::vector<Rider>& riders, Values& values)
{
  if (values.rows() == 0)
  {
    return;
  }
  for (auto rider = riders.rbegin(); rider != riders.rend(); ++rider)
  {
    const auto& [a, b, c] = rider->Corners;
    const Eigen::Vector3d& weights = rider->Weights;
    values.row(rider->Vertex) =
      (weights[0] * values.row(a) + weights[1] * values.row(b) + weights[2] * values.row(c)).eval();
  }
}
}
