// SPDX-License-Identifier: BSD-3-Clause
// The descent of rotations that are coupled over long distances.
#include "Algebra/LimitedMemoryBfgs.h"
#include "Algebra/Rotation.h"
#include "Deformation/AsRigidAsPossibleDeformer.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
/// The part of the decrease that the slope promises which a step must bring (Nocedal and
/// Wright, Numerical Optimization, 2006, Eq. 3.4).
constexpr double SufficientDecrease = 1e-4;

/// How often a step is shortened, and to how much at least.
constexpr int Shortenings = 8;
constexpr double Shortest = 0.1;

/// The largest angle by which a vertex turns in a step, in radians: beyond, slopes tell
/// nothing.
constexpr double LargestTurn = 2.0;
}

/// Fits of one cell after the other hand a turn on from neighbor to neighbor: some
/// alpha d^2 / h^2 of them for edges of length h, and h^2 is about the area of a vertex.
/// Below 1 fits alone do as well.
bool AsRigidAsPossibleDeformer::CouplesFar() const
{
  return this->AreCoupled &&
    this->BendingFactor() * this->System->NumberOfUnknowns() > this->FreeArea;
}

/// What a turn by a small vector o of a cell's rotation, R -> exp(o) R, adds to the energy
/// is g . o to first order. The energy depends on R through -2 tr R^T T, with
/// T = S + 2 alpha d^2 sum_j w_ij R_j, so g is twice the axial vector of T R^T.
///
/// Also P^-1 g, for the part P of the second derivatives by which rotations are coupled:
/// 8 alpha d^2 L, with the positions' matrix L on unknowns. Held cells beside them have
/// their diagonal of it and, on average, of the rest.
void AsRigidAsPossibleDeformer::SlopeOfTurns(
  Eigen::VectorXd& slope, Eigen::VectorXd& solved, const ExecutionContext& context)
{
  const double coupling = 8.0 * this->BendingFactor();
  const int numberOfUnknowns = this->System->NumberOfUnknowns();
  slope.setZero(3 * this->Cells.ActiveCount);
  solved.setZero(3 * this->Cells.ActiveCount);
  context.For(this->Cells.ActiveCount,
    [&](int begin, int end)
    {
      for (int cell = begin; cell < end; ++cell)
      {
        if (this->HoldsRotation[cell])
        {
          continue;
        }
        Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
        double diagonal = 0.0;
        for (int s = this->Cells.SpokeOffsets[cell]; s < this->Cells.SpokeOffsets[cell + 1]; ++s)
        {
          const RigidCells::Spoke& spoke = this->Cells.Spokes[s];
          sum += 0.25 * coupling * spoke.Weight * MatrixAt(this->Rotations, spoke.Neighbor);
          diagonal += spoke.Weight *
            (coupling +
              4.0 / 3.0 * (this->Rest.row(cell) - this->Rest.row(spoke.Neighbor)).squaredNorm());
        }
        const Eigen::Matrix3d turned =
          (this->Covariance(cell) + sum) * MatrixAt(this->Rotations, cell).transpose();
        const Eigen::Vector3d g = 2.0 *
          Eigen::Vector3d(
            turned(1, 2) - turned(2, 1), turned(2, 0) - turned(0, 2), turned(0, 1) - turned(1, 0));
        slope.segment<3>(3 * cell) = g;
        if (cell >= numberOfUnknowns && diagonal > 0.0)
        {
          solved.segment<3>(3 * cell) = g / diagonal;
        }
      }
    });
  Eigen::VectorXd unknowns;
  this->SolveCells(slope, unknowns, {});
  solved.head(3 * numberOfUnknowns) = unknowns / coupling;
  for (int cell = 0; cell < numberOfUnknowns; ++cell)
  {
    if (this->HoldsRotation[cell])
    {
      solved.segment<3>(3 * cell).setZero();
    }
  }
}

/// R = exp(t d) R of Before, then the positions that fit; returns the energy. It is
/// quadratic in the positions: a step that solves L step = f lowers it by 2 f . step.
double AsRigidAsPossibleDeformer::Turn(double t, const Eigen::VectorXd& direction,
  const HandleTargets& targets, Eigen::VectorXd& step, const ExecutionContext& context)
{
  context.For(this->Cells.ActiveCount,
    [&](int begin, int end)
    {
      for (int cell = begin; cell < end; ++cell)
      {
        MatrixAt(this->Rotations, cell) =
          RotationFromVector(t * direction.segment<3>(3 * cell)) * MatrixAt(this->Before, cell);
      }
    });
  const double energy = this->SumEnergies(targets, context);
  this->SolveStep(step, {});
  Eigen::Map<Eigen::VectorXd>(this->Current.data(), step.size()) += step;
  return energy -
    2.0 * step.dot(Eigen::Map<const Eigen::VectorXd>(this->Forces.data(), step.size()));
}

/// A step down the direction, shortened until it brings enough of what the slope
/// promises; returns the energy, which is not below `before` if no step brings any.
double AsRigidAsPossibleDeformer::SearchAlong(Eigen::VectorXd& direction, double promised,
  double before, const HandleTargets& targets, Eigen::VectorXd& step,
  const ExecutionContext& context)
{
  this->Before = this->Rotations;
  const Points positions = this->Current;
  double t = std::min(
    1.0, LargestTurn / direction.reshaped(3, direction.size() / 3).colwise().norm().maxCoeff());
  double after = this->Turn(t, direction, targets, step, context);
  for (int i = 0; i < Shortenings && !(after <= before + SufficientDecrease * t * promised); ++i)
  {
    // To the lowest point of the parabola through what is known.
    t *= std::clamp(-0.5 * t * promised / (after - before - t * promised), Shortest, 0.5);
    after = this->Turn(t, direction, targets, step, context);
  }
  if (!(after < before))
  {
    this->Rotations = this->Before;
    this->Current = positions;
    return before;
  }
  direction *= t;
  return after;
}

/// With the positions at their best for given rotations, the energy is a function of the
/// rotations alone. LimitedMemoryBfgs descends it: turns of all vertices at once, which
/// P^-1 spreads over the surface.
void AsRigidAsPossibleDeformer::DescendByTurns(
  const HandleTargets& targets, Eigen::VectorXd& step, const ExecutionContext& context)
{
  LimitedMemoryBfgs memory;
  Eigen::VectorXd slope;
  Eigen::VectorXd solved;
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(3 * this->Cells.ActiveCount);
  this->Before = this->Rotations;
  double energy = this->Turn(0.0, direction, targets, step, context);
  while (!this->Converged && this->GetNumberOfIterations() < this->MaximumIterations)
  {
    context.Report(0.1 + 0.85 * this->GetNumberOfIterations() / this->MaximumIterations);
    this->SlopeOfTurns(slope, solved, context);
    this->Residual = 0.5 * slope.dot(solved) / energy;
    memory.Next(slope, solved, direction);
    const double before = energy;
    energy = this->SearchAlong(direction, direction.dot(slope), before, targets, step, context);
    this->Energies.push_back(energy);
    if (energy < before)
    {
      memory.Take(direction);
      this->Converged = this->HasSettled(before, energy);
    }
    else
    {
      // What is left is rounding, unless the memory was to blame.
      this->Converged = memory.IsEmpty();
      memory.Forget();
    }
  }
  // Of each cell, too.
  this->Energies.back() = this->SumEnergies(targets, context);
}
}
