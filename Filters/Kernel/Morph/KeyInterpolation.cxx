// SPDX-License-Identifier: BSD-3-Clause
#include "Morph/KeyInterpolation.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace cartan
{
namespace
{
/// A slope between two secants that keeps the cubics beside it monotone.
double Limited(double slope, double before, double after)
{
  if (!(before * after > 0.0))
  {
    return 0.0;
  }
  const double bound = 3.0 * std::min(std::abs(before), std::abs(after));
  return std::copysign(std::min(std::abs(slope), bound), before);
}

/// The slope at an end from the nearest two secants: that of the parabola, if
/// it has the direction of the end's own secant.
double EndSlope(double width, double secant, double nextWidth, double nextSecant)
{
  const double slope = secant + (secant - nextSecant) * width / (width + nextWidth);
  return slope * secant > 0.0
    ? std::copysign(std::min(std::abs(slope), 3.0 * std::abs(secant)), secant)
    : 0.0;
}
}

KeyPlace PlaceBetweenKeys(double t, const std::vector<double>& parameters)
{
  if (std::isnan(t))
  {
    throw Error(
      ErrorCode::BadInput, "The parameter of the morph is not a number: set one, such as 0.5.");
  }
  const auto after = std::upper_bound(parameters.begin() + 1, parameters.end() - 1, t);
  const auto before = after - 1;
  return { static_cast<int>(before - parameters.begin()), (t - *before) / (*after - *before) };
}

KeyInterpolation::KeyInterpolation(std::vector<double> parameters, Field values)
  : Parameters(std::move(parameters))
  , Values(std::move(values))
{
  const int keys = static_cast<int>(this->Parameters.size());
  if (this->Values.cols() != keys)
  {
    throw Error(ErrorCode::BadInput,
      "There are " + std::to_string(keys) + " key parameters for " +
        std::to_string(this->Values.cols()) + " key frames: give each its own.");
  }
  if (keys < 2)
  {
    throw Error(ErrorCode::BadInput,
      "Interpolation needs at least two key frames; there " +
        std::string(keys == 1 ? "is one." : "are none."));
  }
  for (int k = 0; k < keys; ++k)
  {
    const double parameter = this->Parameters[k];
    if (!std::isfinite(parameter) || (k > 0 && !(parameter > this->Parameters[k - 1])))
    {
      throw Error(ErrorCode::BadInput,
        "The parameters of key frames must be finite and increase; that of key frame " +
          std::to_string(k) + " is " + std::to_string(parameter) +
          (k > 0 ? " after " + std::to_string(this->Parameters[k - 1]) : "") + ".");
    }
  }
  if (keys == 2)
  {
    return;
  }

  std::vector<double> widths(keys - 1);
  for (int k = 0; k + 1 < keys; ++k)
  {
    widths[k] = this->Parameters[k + 1] - this->Parameters[k];
  }
  std::vector<double> secants(keys - 1);
  this->Slopes.resize(this->Values.rows(), keys);
  for (Eigen::Index row = 0; row < this->Values.rows(); ++row)
  {
    for (int k = 0; k + 1 < keys; ++k)
    {
      secants[k] = (this->Values(row, k + 1) - this->Values(row, k)) / widths[k];
    }
    for (int k = 1; k + 1 < keys; ++k)
    {
      const double parabola =
        (widths[k] * secants[k - 1] + widths[k - 1] * secants[k]) / (widths[k - 1] + widths[k]);
      this->Slopes(row, k) = Limited(parabola, secants[k - 1], secants[k]);
    }
    this->Slopes(row, 0) = EndSlope(widths[0], secants[0], widths[1], secants[1]);
    this->Slopes(row, keys - 1) =
      EndSlope(widths[keys - 2], secants[keys - 2], widths[keys - 3], secants[keys - 3]);
  }
}

Eigen::VectorXd KeyInterpolation::Evaluate(double t, const ExecutionContext& context) const
{
  const int keys = static_cast<int>(this->Parameters.size());
  const KeyPlace place = PlaceBetweenKeys(t, this->Parameters);
  const int k = place.Before;
  const double s = place.Part;
  const double width = this->Parameters[k + 1] - this->Parameters[k];

  // v = a v_k + b v_{k+1} + c v'_k + d v'_{k+1}: Hermite's cubic, and straight
  // lines outside.
  double a = 1.0 - s;
  double b = s;
  double c = 0.0;
  double d = 0.0;
  if (keys > 2 && s < 0.0)
  {
    a = 1.0;
    b = 0.0;
    c = s * width;
  }
  else if (keys > 2 && s > 1.0)
  {
    a = 0.0;
    b = 1.0;
    d = (s - 1.0) * width;
  }
  else if (keys > 2)
  {
    a = (1.0 - s) * (1.0 - s) * (1.0 + 2.0 * s);
    b = s * s * (3.0 - 2.0 * s);
    c = s * (1.0 - s) * (1.0 - s) * width;
    d = s * s * (s - 1.0) * width;
  }
  Eigen::VectorXd result(this->Values.rows());
  context.For(static_cast<int>(this->Values.rows()),
    [&](int begin, int end)
    {
      for (int row = begin; row < end; ++row)
      {
        result[row] = a * this->Values(row, k) + b * this->Values(row, k + 1);
        if (keys > 2)
        {
          result[row] += c * this->Slopes(row, k) + d * this->Slopes(row, k + 1);
        }
      }
    });
  return result;
}
}
