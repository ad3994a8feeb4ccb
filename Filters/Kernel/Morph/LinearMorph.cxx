// SPDX-License-Identifier: BSD-3-Clause
#include "Morph/LinearMorph.h"

#include <array>

namespace cartan
{
LinearMorph::LinearMorph(const KeyFrames& keys)
{
  Field coordinates(keys.Positions[0].size(), keys.Positions.size());
  for (std::size_t k = 0; k < keys.Positions.size(); ++k)
  {
    coordinates.col(static_cast<Eigen::Index>(k)) =
      Eigen::Map<const Eigen::VectorXd>(keys.Positions[k].data(), keys.Positions[k].size());
  }
  this->Coordinates = KeyInterpolation(keys.Parameters, std::move(coordinates), 3);
}

Points LinearMorph::Evaluate(const MorphPlace& place, const ExecutionContext& context)
{
  const auto size = static_cast<int>(this->Coordinates.GetValues().rows() / 3);
  Points points(size, 3);
  Eigen::Map<Eigen::VectorXd> coordinates(points.data(), points.size());
  if (place.IsUniform())
  {
    this->Coordinates.Evaluate(place.GetParameter(), coordinates, context);
  }
  else
  {
    coordinates = place.Sample(
      this->Coordinates, size, [](int v) { return std::array{ v }; }, context);
  }
  return points;
}
}
