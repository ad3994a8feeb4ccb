// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/RotationAveraging.h"

#include "Algebra/AndersonAcceleration.h"
#include "Algebra/Rotation.h"

namespace cartan
{
RotationAveraging::RotationAveraging(
  int numberOfNodes, std::vector<Edge> edges, std::shared_ptr<const AnchoredSystem> laplacian)
  : NodeCount(numberOfNodes)
  , Edges(std::move(edges))
  , Laplacian(std::move(laplacian))
{
}

RotationAveraging::Result RotationAveraging::Improve(
  const Matrices& transitions, Matrices& frames, const ExecutionContext& context) const
{
  constexpr double tolerance = 1e-8;
  // Turns add up like vectors, as the acceleration has it, while they are small.
  constexpr double small = 0.3;
  AndersonAcceleration acceleration(1e-10);
  const int numberOfEdges = static_cast<int>(this->Edges.size());
  Points residuals(numberOfEdges, 3);
  Field turns = Field::Zero(this->NodeCount, 3);
  Eigen::Map<Eigen::VectorXd> step(turns.data(), turns.size());
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(turns.size()); // of all steps
  Eigen::VectorXd next;
  for (int steps = 1;; ++steps)
  {
    context.For(numberOfEdges,
      [&](int begin, int end)
      {
        for (int e = begin; e < end; ++e)
        {
          const Eigen::Matrix3d misfit = MatrixAt(frames, this->Edges[e].From) *
            MatrixAt(transitions, e) * MatrixAt(frames, this->Edges[e].To).transpose();
          residuals.row(e).setZero();
          if (!misfit.isZero(0.0))
          {
            residuals.row(e) = this->Edges[e].Weight * VectorFromRotation(misfit).transpose();
          }
        }
      });
    Field rightHandSide = Field::Zero(this->NodeCount, 3);
    for (int e = 0; e < numberOfEdges; ++e)
    {
      rightHandSide.row(this->Edges[e].From) -= residuals.row(e);
      rightHandSide.row(this->Edges[e].To) += residuals.row(e);
    }
    turns.setZero();
    this->Laplacian->Solve(rightHandSide, turns);
    const double largest = turns.rowwise().norm().maxCoeff();
    if (largest < small)
    {
      acceleration.Next(sum + step, step, next);
      step = next - sum;
    }
    sum += step;
    context.For(this->NodeCount,
      [&](int begin, int end)
      {
        for (int v = begin; v < end; ++v)
        {
          const Eigen::Vector3d turn = turns.row(v);
          MatrixAt(frames, v) = (RotationFromVector(turn) * MatrixAt(frames, v)).eval();
        }
      });
    if (steps == MaximumSteps || !(largest > tolerance))
    {
      return { steps, largest };
    }
    context.Report(static_cast<double>(steps) / MaximumSteps);
  }
}
}
