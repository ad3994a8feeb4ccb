// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

namespace cartan
{
/// When conjugate gradients end: when r^T M^-1 r is `Tolerance`^2 of that of the
/// start, or no more than `Negligible`, or after so many steps.
struct ConjugateGradientsGoal
{
  double Tolerance;
  int MaximumSteps;
  double Negligible = 0.0;
};

struct ConjugateGradientsResult
{
  int Steps;
  bool HasConverged;
};

/// Solves A x = b for a symmetric positive definite A by preconditioned conjugate
/// gradients (Hestenes and Stiefel, Methods of Conjugate Gradients for Solving
/// Linear Systems, 1952). `solution` has the start and `residual` is b - A x there;
/// several columns are one long vector. apply(v) is A v and precondition(r) is
/// M^-1 r, near A^-1 r. progress(steps, reduction) is called after each step,
/// `reduction` the part of r^T M^-1 r that is left. Where each of several processes has
/// some rows, sum(s) adds up what they have of a scalar product.
template <typename Columns, typename Apply, typename Precondition, typename Progress, typename Sum>
ConjugateGradientsResult ConjugateGradients(Columns& solution, Columns residual, const Apply& apply,
  Precondition&& precondition, const ConjugateGradientsGoal& goal, const Progress& progress,
  const Sum& sum)
{
  const auto dot = [&sum](const Columns& a, const Columns& b)
  { return sum(a.cwiseProduct(b).sum()); };
  Columns direction = precondition(residual);
  double product = dot(residual, direction);
  const double start = product;
  int steps = 0;
  // Written so that NaN ends it.
  const auto isAbove = [&goal, start](double value)
  { return value > goal.Tolerance * goal.Tolerance * start && value > goal.Negligible; };
  for (; steps < goal.MaximumSteps && isAbove(product); ++steps)
  {
    const Columns image = apply(direction);
    const double length = product / dot(direction, image);
    solution += length * direction;
    residual -= length * image;
    const Columns preconditioned = precondition(residual);
    const double next = dot(residual, preconditioned);
    direction = preconditioned + next / product * direction;
    product = next;
    progress(steps + 1, product / start);
  }
  return { steps, !isAbove(product) };
}

/// The same where one process has all rows.
template <typename Columns, typename Apply, typename Precondition, typename Progress>
ConjugateGradientsResult ConjugateGradients(Columns& solution, Columns residual, const Apply& apply,
  Precondition&& precondition, const ConjugateGradientsGoal& goal, const Progress& progress)
{
  return ConjugateGradients(solution, std::move(residual), apply,
    std::forward<Precondition>(precondition), goal, progress, [](double part) { return part; });
}
}
