// SPDX-License-Identifier: BSD-3-Clause
#include "Morph/LengthPolish.h"

#include "Algebra/ConjugateGradients.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
using Edges = Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// With the unit edge u and the error r = l - |e| of edges, a step v minimizes
///
///   sum (u.(v_j - v_i) - r)^2 / l^2 + damping sum |v|^2 / m^2,
///
/// m the mean length of a vertex's edges. Damping is for bending, which changes
/// no length to first order. The normal equations A v = b are never assembled:
/// an edge adds d d^T with d = u / l to them.
class LengthEquations
{
public:
  LengthEquations(
    const Edges& edges, const Eigen::VectorXd& lengths, const std::vector<char>& isHeld)
    : Ends(edges)
    , Lengths(lengths)
    , IsHeld(isHeld)
    , Directions(edges.rows(), 3)
    , Softness(isHeld.size())
  {
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(this->Softness.size());
    Eigen::VectorXd valences = sums;
    for (Eigen::Index e = 0; e < edges.rows(); ++e)
    {
      for (const int v : { edges(e, 0), edges(e, 1) })
      {
        sums[v] += lengths[e];
        valences[v] += 1.0;
      }
    }
    for (Eigen::Index v = 0; v < sums.size(); ++v)
    {
      this->Softness[v] = valences[v] > 0.0 ? std::pow(valences[v] / sums[v], 2) : 1.0;
    }
  }

  /// Sets d of each edge and the preconditioner, the inverses of the diagonal's
  /// 3 x 3 blocks; returns b.
  Points Linearize(const Points& points, double damping)
  {
    this->Damping = damping;
    Points forces = Points::Zero(points.rows(), 3);
    this->Inverses = Matrices::Zero(points.rows(), 9);
    for (Eigen::Index e = 0; e < this->Ends.rows(); ++e)
    {
      const int i = this->Ends(e, 0);
      const int j = this->Ends(e, 1);
      const Eigen::RowVector3d edge = points.row(j) - points.row(i);
      const double length = edge.norm();
      this->Directions.row(e).setZero();
      if (length > 0.0)
      {
        this->Directions.row(e) = edge / (length * this->Lengths[e]);
      }
      const Eigen::RowVector3d d = this->Directions.row(e);
      const Eigen::RowVector3d force = (1.0 - length / this->Lengths[e]) * d;
      forces.row(i) -= force;
      forces.row(j) += force;
      MatrixAt(this->Inverses, i) += d.transpose() * d;
      MatrixAt(this->Inverses, j) += d.transpose() * d;
    }
    for (int v = 0; v < static_cast<int>(points.rows()); ++v)
    {
      auto block = MatrixAt(this->Inverses, v);
      block.diagonal().array() += damping * this->Softness[v];
      block = block.inverse().eval();
    }
    this->ClearHeld(forces);
    return forces;
  }

  /// A v for a v that is zero where vertices are held.
  Points Apply(const Points& v) const
  {
    Points image = (this->Damping * this->Softness).asDiagonal() * v;
    for (Eigen::Index e = 0; e < this->Ends.rows(); ++e)
    {
      const int i = this->Ends(e, 0);
      const int j = this->Ends(e, 1);
      const Eigen::RowVector3d d = this->Directions.row(e);
      const Eigen::RowVector3d pull = d.dot(v.row(j) - v.row(i)) * d;
      image.row(i) -= pull;
      image.row(j) += pull;
    }
    this->ClearHeld(image);
    return image;
  }

  Points Precondition(const Points& residual) const
  {
    Points result(residual.rows(), 3);
    for (Eigen::Index v = 0; v < residual.rows(); ++v)
    {
      result.row(v) = (MatrixAt(this->Inverses, v) * residual.row(v).transpose()).transpose();
    }
    return result;
  }

private:
  void ClearHeld(Points& values) const
  {
    for (Eigen::Index v = 0; v < values.rows(); ++v)
    {
      if (this->IsHeld[v])
      {
        values.row(v).setZero();
      }
    }
  }

  const Edges& Ends;
  const Eigen::VectorXd& Lengths;
  const std::vector<char>& IsHeld;
  Points Directions;
  Eigen::VectorXd Softness; // 1 / m^2
  Matrices Inverses;
  double Damping = 0.0;
};

/// A^-1 b to 1e-3: the next round corrects what a step lacks (Dembo, Eisenstat,
/// Steihaug, Inexact Newton Methods, 1982).
Points Solve(const LengthEquations& equations, Points residual, const ExecutionContext& context)
{
  constexpr double tolerance = 1e-3;
  Points solution = Points::Zero(residual.rows(), 3);
  double done = 0.0;
  ConjugateGradients(
    solution, std::move(residual), [&](const Points& v) { return equations.Apply(v); },
    [&](const Points& r) { return equations.Precondition(r); }, { tolerance, 2000 },
    [&](int, double reduction)
    {
      // Digits gained of those asked for; a residual may grow for a while.
      done = std::max(done, 0.5 * std::log(reduction) / std::log(tolerance));
      context.Report(std::min(done, 1.0));
    });
  return solution;
}
}

void PolishLengths(const Edges& edges, const Eigen::VectorXd& lengths,
  const std::vector<char>& isHeld, int rounds, Points& points, const ExecutionContext& context)
{
  // At 1e-3 three rounds leave a sixth of the errors of a bent tube; with less,
  // lengths that no shape can have make sharp bumps. Where a step does not help,
  // it is not taken, and the next is shorter.
  double damping = 1e-3;
  const auto error = [&](const Points& candidate)
  {
    double sum = 0.0;
    for (Eigen::Index e = 0; e < edges.rows(); ++e)
    {
      const double length = (candidate.row(edges(e, 1)) - candidate.row(edges(e, 0))).norm();
      sum += std::pow(length / lengths[e] - 1.0, 2);
    }
    return sum;
  };
  LengthEquations equations(edges, lengths, isHeld);
  for (int round = 0; round < rounds; ++round)
  {
    const Points forces = equations.Linearize(points, damping);
    const Points candidate = points +
      Solve(equations, forces,
        context.Part(round / static_cast<double>(rounds), (round + 1.0) / rounds));
    if (error(candidate) < error(points))
    {
      points = candidate;
    }
    else
    {
      damping *= 10.0;
    }
    context.Report((round + 1.0) / rounds);
  }
}
}
