// SPDX-License-Identifier: BSD-3-Clause
#include "Merging/SurfacePlace.h"

namespace cartan
{
Field AtPlaces(const Field& values, const std::vector<SurfacePlace>& places)
{
  Field results(static_cast<Eigen::Index>(places.size()), values.cols());
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    const auto& [a, b, c] = places[i].Corners;
    const Eigen::Vector3d& w = places[i].Weights;
    // Differences, so that equal values stay what they are.
    results.row(static_cast<Eigen::Index>(i)) = values.row(a) +
      w[1] * (values.row(b) - values.row(a)) + w[2] * (values.row(c) - values.row(a));
  }
  return results;
}
}
