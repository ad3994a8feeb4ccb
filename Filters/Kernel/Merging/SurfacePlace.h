// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Types.h"

#include <array>
#include <vector>

namespace cartan
{
/// A place on a triangle surface.
struct SurfacePlace
{
  std::array<int, 3> Corners = { 0, 0, 0 };           ///< vertices
  Eigen::Vector3d Weights = Eigen::Vector3d::UnitX(); ///< barycentric coordinates

  static SurfacePlace AtVertex(int v) { return { { v, v, v }, Eigen::Vector3d::UnitX() }; }
};

/// Values (a row per vertex) at places: #places x columns.
Field AtPlaces(const Field& values, const std::vector<SurfacePlace>& places);
}
