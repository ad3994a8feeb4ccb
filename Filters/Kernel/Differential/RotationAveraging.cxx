// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/RotationAveraging.h"

#include "Algebra/Rotation.h"

#include <Eigen/Cholesky>

#include <deque>

namespace cartan
{
namespace
{
/// Steps of a fixed-point iteration that look back (Anderson acceleration; Walker
/// and Ni, Anderson Acceleration for Fixed-Point Iterations, 2011): of the steps
/// that the last differences allow, the one whose own next step would be the
/// smallest if all were linear.
class Acceleration
{
public:
  /// Replaces a plain step by a better one.
  void Improve(Field& step)
  {
    const Field plain = step;
    if (this->LastPlain.size())
    {
      this->Differences.push_back({ this->LastTaken, plain - this->LastPlain });
      if (this->Differences.size() > Depth)
      {
        this->Differences.pop_front();
      }
      const auto count = static_cast<Eigen::Index>(this->Differences.size());
      Eigen::MatrixXd products(count, count);
      Eigen::VectorXd rightHandSide(count);
      for (Eigen::Index a = 0; a < count; ++a)
      {
        rightHandSide[a] = this->Differences[a].OfStep.cwiseProduct(plain).sum();
        for (Eigen::Index b = 0; b <= a; ++b)
        {
          products(a, b) = products(b, a) =
            this->Differences[a].OfStep.cwiseProduct(this->Differences[b].OfStep).sum();
        }
      }
      // Differences that hardly differ must not blow up.
      products.diagonal() *= 1.0 + 1e-10;
      const Eigen::VectorXd parts = products.ldlt().solve(rightHandSide);
      for (Eigen::Index a = 0; a < count && parts.allFinite(); ++a)
      {
        step -= parts[a] * (this->Differences[a].Taken + this->Differences[a].OfStep);
      }
    }
    this->LastPlain = plain;
    this->LastTaken = step;
  }

private:
  static constexpr std::size_t Depth = 5;
  struct Difference
  {
    Field Taken;  // the step that was taken
    Field OfStep; // by how much it changed the plain step
  };
  std::deque<Difference> Differences;
  Field LastPlain;
  Field LastTaken;
};
}

RotationAveraging::RotationAveraging(
  int numberOfNodes, std::vector<Edge> edges, std::shared_ptr<const ConstrainedSolver> laplacian)
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
  Acceleration acceleration;
  const int numberOfEdges = static_cast<int>(this->Edges.size());
  Points residuals(numberOfEdges, 3);
  Field turns = Field::Zero(this->NodeCount, 3);
  for (int step = 1;; ++step)
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
      acceleration.Improve(turns);
    }
    context.For(this->NodeCount,
      [&](int begin, int end)
      {
        for (int v = begin; v < end; ++v)
        {
          const Eigen::Vector3d turn = turns.row(v);
          MatrixAt(frames, v) = (RotationFromVector(turn) * MatrixAt(frames, v)).eval();
        }
      });
    if (step == MaximumSteps || !(largest > tolerance))
    {
      return { step, largest };
    }
    context.Report(static_cast<double>(step) / MaximumSteps);
  }
}
}
