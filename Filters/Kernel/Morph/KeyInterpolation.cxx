// SPDX-License-Identifier: BSD-3-Clause
#include "Morph/KeyInterpolation.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace cartan
{
namespace
{
/// Of a dimension that is known at run time, without memory of its own.
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;

/// At most as long as `bound`.
Vector Shortened(const Vector& slope, double bound)
{
  const double length = slope.norm();
  return length > bound ? Vector(slope * (bound / length)) : slope;
}

/// A slope between two secants that keeps the cubics beside it monotone where the
/// secants have one direction; zero where these are opposite.
Vector Limited(const Vector& slope, const Vector& before, const Vector& after)
{
  const double lengths = before.norm() * after.norm();
  if (!(lengths > 0.0))
  {
    return Vector::Zero(slope.size());
  }
  const double agreement = 0.5 * (1.0 + std::clamp(before.dot(after) / lengths, -1.0, 1.0));
  return Shortened(slope, 3.0 * agreement * std::min(before.norm(), after.norm()));
}

/// The slope at an end from the nearest two secants: that of the parabola, if
/// it has the direction of the end's own secant.
Vector EndSlope(double width, const Vector& secant, double nextWidth, const Vector& nextSecant)
{
  const Vector slope = secant + (secant - nextSecant) * (width / (width + nextWidth));
  return slope.dot(secant) > 0.0 ? Shortened(slope, 3.0 * secant.norm())
                                 : Vector::Zero(slope.size());
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

KeyInterpolation::KeyInterpolation(std::vector<double> parameters, Field values, int dimension)
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
  if (keys > 2)
  {
    this->ComputeSlopes(dimension);
  }
}

void KeyInterpolation::ComputeSlopes(int dimension)
{
  const int keys = static_cast<int>(this->Parameters.size());
  std::vector<double> widths(keys - 1);
  for (int k = 0; k + 1 < keys; ++k)
  {
    widths[k] = this->Parameters[k + 1] - this->Parameters[k];
  }
  std::vector<Vector> secants(keys - 1);
  this->Slopes.resize(this->Values.rows(), keys);
  for (Eigen::Index row = 0; row < this->Values.rows(); row += dimension)
  {
    for (int k = 0; k + 1 < keys; ++k)
    {
      secants[k] = (this->Values.col(k + 1).segment(row, dimension) -
                     this->Values.col(k).segment(row, dimension)) /
        widths[k];
    }
    for (int k = 1; k + 1 < keys; ++k)
    {
      const Vector parabola =
        (widths[k] * secants[k - 1] + widths[k - 1] * secants[k]) / (widths[k - 1] + widths[k]);
      this->Slopes.col(k).segment(row, dimension) = Limited(parabola, secants[k - 1], secants[k]);
    }
    this->Slopes.col(0).segment(row, dimension) =
      EndSlope(widths[0], secants[0], widths[1], secants[1]);
    this->Slopes.col(keys - 1).segment(row, dimension) =
      EndSlope(widths[keys - 2], secants[keys - 2], widths[keys - 3], secants[keys - 3]);
  }
}

KeyInterpolation::Coefficients KeyInterpolation::CoefficientsAt(double t) const
{
  const bool isCubic = this->Parameters.size() > 2;
  const KeyPlace place = PlaceBetweenKeys(t, this->Parameters);
  const int k = place.Before;
  const double s = place.Part;
  const double width = this->Parameters[k + 1] - this->Parameters[k];
  if (!isCubic)
  {
    return { k, 1.0 - s, s, 0.0, 0.0 };
  }
  // Hermite's cubic, and straight lines outside.
  if (s < 0.0)
  {
    return { k, 1.0, 0.0, s * width, 0.0 };
  }
  if (s > 1.0)
  {
    return { k, 0.0, 1.0, 0.0, (s - 1.0) * width };
  }
  return { k, (1.0 - s) * (1.0 - s) * (1.0 + 2.0 * s), s * s * (3.0 - 2.0 * s),
    s * (1.0 - s) * (1.0 - s) * width, s * s * (s - 1.0) * width };
}

double KeyInterpolation::RowAt(Eigen::Index row, const Coefficients& at) const
{
  const int k = at.Before;
  double result = at.A * this->Values(row, k) + at.B * this->Values(row, k + 1);
  if (this->Slopes.size() > 0)
  {
    result += at.C * this->Slopes(row, k) + at.D * this->Slopes(row, k + 1);
  }
  return result;
}

Eigen::VectorXd KeyInterpolation::Evaluate(double t, const ExecutionContext& context) const
{
  Eigen::VectorXd result(this->Values.rows());
  this->Evaluate(t, result, context);
  return result;
}

void KeyInterpolation::Evaluate(
  double t, Eigen::Ref<Eigen::VectorXd> result, const ExecutionContext& context) const
{
  const Coefficients at = this->CoefficientsAt(t);
  const double* const values = this->Values.data();
  double* const to = result.data();
  context.For(static_cast<int>(this->Values.rows()),
    [&](int begin, int end)
    {
      if (this->Slopes.size() > 0)
      {
        for (Eigen::Index row = begin; row < end; ++row)
        {
          to[row] = this->RowAt(row, at);
        }
        return;
      }
      // Both keys' numbers side by side: several rows at a time.
      for (Eigen::Index row = begin; row < end; ++row)
      {
        to[row] = at.A * values[2 * row] + at.B * values[2 * row + 1];
      }
    });
}

Eigen::VectorXd KeyInterpolation::EvaluateEach(
  const Eigen::VectorXd& parameters, const ExecutionContext& context) const
{
  Eigen::VectorXd result(this->Values.rows());
  const Eigen::Index rows = parameters.size() > 0 ? this->Values.rows() / parameters.size() : 0;
  context.For(static_cast<int>(parameters.size()),
    [&](int begin, int end)
    {
      for (Eigen::Index item = begin; item < end; ++item)
      {
        const Coefficients at = this->CoefficientsAt(parameters[item]);
        for (Eigen::Index row = item * rows; row < (item + 1) * rows; ++row)
        {
          result[row] = this->RowAt(row, at);
        }
      }
    });
  return result;
}
}
