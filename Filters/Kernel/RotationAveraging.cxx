// SPDX-License-Identifier: BSD-3-Clause
#include "RotationAveraging.h"

#include "Rotation.h"

namespace cartan
{
RotationAveraging::RotationAveraging(
  int numberOfNodes, std::vector<Edge> edges, std::shared_ptr<const ConstrainedSolver> laplacian)
  : NodeCount(numberOfNodes)
  , Edges(std::move(edges))
  , Laplacian(std::move(laplacian))
{
}

RotationAveraging::Result RotationAveraging::Improve(const Matrices& transitions,
  int maximumSteps, Matrices& frames, const ExecutionContext& context) const
{
  constexpr double tolerance = 1e-10;
  const int numberOfEdges = static_cast<int>(this->Edges.size());
  Points residuals(numberOfEdges, 3);
  Field turns = Field::Zero(this->NodeCount, 3);
  for (int step = 1; step <= maximumSteps; ++step)
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
            residuals.row(e) = VectorFromRotation(misfit).transpose();
          }
        }
      });
    Field rightHandSide = Field::Zero(this->NodeCount, 3);
    for (int e = 0; e < numberOfEdges; ++e)
    {
      rightHandSide.row(this->Edges[e].From) -= residuals.row(e);
      rightHandSide.row(this->Edges[e].To) += residuals.row(e);
    }
    this->Laplacian->Solve(rightHandSide, turns);
    context.For(this->NodeCount,
      [&](int begin, int end)
      {
        for (int v = begin; v < end; ++v)
        {
          const Eigen::Vector3d turn = turns.row(v);
          MatrixAt(frames, v) = (RotationFromVector(turn) * MatrixAt(frames, v)).eval();
        }
      });
    if (turns.rowwise().norm().maxCoeff() <= tolerance)
    {
      return { step, true };
    }
    context.Report(static_cast<double>(step) / maximumSteps);
  }
  return { maximumSteps, false };
}
}
