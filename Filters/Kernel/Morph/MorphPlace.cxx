// SPDX-License-Identifier: BSD-3-Clause
#include "Morph/MorphPlace.h"

#include <algorithm>

namespace cartan
{
MorphPlace MorphPlace::Local(Eigen::VectorXd parameters, double mean)
{
  MorphPlace place(mean);
  place.Parameters = std::move(parameters);
  return place;
}

MorphPlace MorphPlace::Blend(Eigen::VectorXd weights, const std::vector<double>& keyParameters)
{
  Eigen::Index largest = 0;
  weights.maxCoeff(&largest);
  MorphPlace place(keyParameters[largest]);
  place.Weights = std::move(weights);
  place.KeyParameters = keyParameters;
  return place;
}

MorphPlace MorphPlace::From(double start, int part, int parts) const
{
  MorphPlace between = *this;
  between.Parameter = start + (this->Parameter - start) * part / parts;
  between.Parameters = start + (this->Parameters.array() - start) * part / parts;
  const double share = static_cast<double>(part) / parts;
  for (Eigen::Index k = 0; k < this->Weights.size(); ++k)
  {
    between.Weights[k] =
      share * this->Weights[k] + (this->KeyParameters[k] == start ? 1.0 - share : 0.0);
  }
  return between;
}
}
