// SPDX-License-Identifier: BSD-3-Clause
#include "Morph/LinearMorph.h"

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

Points LinearMorph::Evaluate(double t, const ExecutionContext& context)
{
  const Eigen::VectorXd coordinates = this->Coordinates.Evaluate(t, context);
  return Eigen::Map<const Points>(coordinates.data(), coordinates.size() / 3, 3);
}
}
