// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Bytes.h"
#include "Base/ExecutionContext.h"
#include "Base/Types.h"

#include <vector>

namespace cartan
{
/// The position of t between two key parameters: the fraction Part of the way
/// from Before to the next, below 0 or above 1 outside of all.
struct KeyPlace
{
  int Before;
  double Part;
};

/// `parameters` are two or more, increasing. At an interior one Part is 0.
KeyPlace PlaceBetweenKeys(double t, const std::vector<double>& parameters);

/// Interpolates numbers that are known at key parameters: linearly between two
/// keys, by monotone piecewise cubics with a continuous derivative through more
/// (Fritsch and Carlson, Monotone Piecewise Cubic Interpolation, 1980), which
/// do not overshoot between two keys. The slope at a key is that of the
/// parabola through it and its neighbors, limited to three times the smaller of
/// the two adjacent secants, and zero if these differ in sign. Outside of the
/// keys the function is linear, with the slope of the first or last one.
///
/// The numbers may be the coordinates of vectors. Then slopes are limited as
/// vectors, so that the curves turn with the keys: to 3 (1 + cos a) / 2 times the
/// smaller secant, where a is the angle between the two.
///
/// The same numbers in reverse order at the mirrored parameters give the
/// mirrored result.
class KeyInterpolation
{
public:
  KeyInterpolation() = default;

  /// `values` is m x #keys, a column per key; each `dimension` rows, 1 to 3, are one
  /// vector. Throws Error(BadInput) unless there are at least two parameters, all
  /// finite and increasing, and as many columns.
  KeyInterpolation(std::vector<double> parameters, Field values, int dimension = 1);

  /// The m numbers at t.
  Eigen::VectorXd Evaluate(double t, const ExecutionContext& context = {}) const;

  /// The same into `result` (m).
  void Evaluate(
    double t, Eigen::Ref<Eigen::VectorXd> result, const ExecutionContext& context = {}) const;

  /// The same with a parameter for each item (#items), which has m / #items rows.
  Eigen::VectorXd EvaluateEach(
    const Eigen::VectorXd& parameters, const ExecutionContext& context = {}) const;

  /// The sum of the keys' numbers, with a weight for each (#keys).
  Eigen::VectorXd Blend(const Eigen::VectorXd& weights) const { return this->Values * weights; }

  const std::vector<double>& GetParameters() const { return this->Parameters; }
  const Field& GetValues() const { return this->Values; }

  std::size_t GetBytes() const { return TotalBytes(this->Parameters, this->Values, this->Slopes); }

private:
  void ComputeSlopes(int dimension);

  /// v = A v_k + B v_{k+1} + C v'_k + D v'_{k+1}.
  struct Coefficients
  {
    int Before; // k
    double A, B, C, D;
  };
  Coefficients CoefficientsAt(double t) const;
  double RowAt(Eigen::Index row, const Coefficients& at) const;

  std::vector<double> Parameters;
  Field Values;
  Field Slopes; // m x #keys, empty for two keys
};
}
