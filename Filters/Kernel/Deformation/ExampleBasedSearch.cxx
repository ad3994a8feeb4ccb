// SPDX-License-Identifier: BSD-3-Clause
// The search for the weights of examples.
#include "Deformation/ExampleBasedDeformer.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cartan
{
namespace
{
/// The part of E(x = 0) that is made of rounding.
constexpr double RoundingPart = 1e-24;

/// By which part of E a pose must fit better to count as better, and by which part of
/// E(x = 0): two poses that fit to 1e-9 of the size fit alike.
constexpr double BetterFit = 1e-9;
constexpr double EqualFit = 1e-18;

/// The part of the decrease that the slope promises which a step must bring.
constexpr double SufficientDecrease = 1e-4;
constexpr int Halvings = 12;

/// The part of E below which two values differ by rounding, and the part of the slope along
/// a step that may then be left at its end.
constexpr double RoundingOfEnergy = 1e-13;
constexpr double SlopeLeft = 0.9;

/// The largest change of a weight in a step: from one example to the next. Beyond, slopes
/// tell nothing.
constexpr double LargestStep = 1.0;
}

/// E(x = 0) of the last weights.
double ExampleBasedDeformer::SizeOfEdges() const
{
  double size = 0.0;
  const auto& triangles = this->Span.GetTriangles();
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    size += triangles[t].Weights.dot(
      this->Span.Edges(static_cast<Eigen::Index>(t)).colwise().squaredNorm().transpose());
  }
  return size;
}

Eigen::VectorXd ExampleBasedDeformer::BestStart(const ExecutionContext& context)
{
  const int count = this->Span.NumberOfExamples();
  Eigen::VectorXd best = Eigen::VectorXd::Zero(count);
  double least = std::numeric_limits<double>::infinity();
  for (int k = -1; k < count; ++k)
  {
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(count);
    if (k >= 0)
    {
      weights[k] = 1.0;
    }
    const double energy = this->Evaluate(weights, context);
    const double negligible = EqualFit * this->SizeOfEdges();
    // The first of those that fit alike.
    if (energy < (1.0 - BetterFit) * least - negligible)
    {
      least = energy;
      best = weights;
    }
  }
  return best;
}

/// Shortens the step until it brings enough, and tells whether one did; without one, all is as
/// before. Far from the examples E is made of what no weight changes, and its digits no longer
/// tell two weights apart. The slope's still do: a step is then good that leaves less of it
/// (Hager and Zhang, A New Conjugate Gradient Method with Guaranteed Descent and an Efficient
/// Line Search, 2005, the approximate Wolfe conditions).
bool ExampleBasedDeformer::StepDown(
  double& energy, Eigen::VectorXd& step, const ExecutionContext& context)
{
  const Eigen::VectorXd from = this->Weights;
  const double before = energy;
  const double slope = this->Slope.dot(step);
  double t = std::min(1.0, LargestStep / step.cwiseAbs().maxCoeff());
  for (int i = 0; i < Halvings; ++i)
  {
    this->Weights = from + t * step;
    energy = this->Evaluate(this->Weights, context);
    const bool isLower = energy < before && energy <= before + SufficientDecrease * t * slope;
    const bool isFlatter = std::abs(energy - before) <= RoundingOfEnergy * before &&
      std::abs(this->Slope.dot(step)) <= SlopeLeft * std::abs(slope);
    if (isLower || isFlatter)
    {
      step *= t;
      return true;
    }
    t *= 0.5;
  }
  this->Weights = from;
  energy = this->Evaluate(from, context);
  return false;
}

void ExampleBasedDeformer::Descend(const ExecutionContext& context)
{
  double energy = this->Evaluate(this->Weights, context);
  const double size = this->SizeOfEdges();
  bool isFresh = this->Curvature.size() == 0;
  if (isFresh && energy > RoundingPart * size)
  {
    this->Curvature = this->GaussNewton();
  }
  this->Iterations = 0;
  this->Converged = energy <= RoundingPart * size;
  while (!this->Converged && this->Iterations < this->MaximumIterations)
  {
    context.Report(static_cast<double>(this->Iterations) / this->MaximumIterations);
    const Eigen::VectorXd slope = this->Slope;
    Eigen::VectorXd step = -this->Curvature.ldlt().solve(slope);
    ++this->Iterations;
    if (!(slope.dot(step) < 0.0) || !this->StepDown(energy, step, context))
    {
      // What is left is rounding, unless the curvature was that of another place.
      this->Converged = isFresh;
      this->Curvature = isFresh ? this->Curvature : this->GaussNewton();
      isFresh = true;
      continue;
    }
    isFresh = false;
    this->Converged =
      step.cwiseAbs().maxCoeff() <= this->Tolerance || energy <= RoundingPart * size;
    // BFGS: the curvature along the step becomes that which it found.
    const Eigen::VectorXd change = this->Slope - slope;
    const Eigen::VectorXd expected = this->Curvature * step;
    if (change.dot(step) > 1e-3 * expected.dot(step))
    {
      this->Curvature += change * change.transpose() / change.dot(step) -
        expected * expected.transpose() / expected.dot(step);
    }
  }
  this->Distance = size > 0.0 ? std::sqrt(std::max(energy, 0.0) / size) : 0.0;
}
}
