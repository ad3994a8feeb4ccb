// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/AsRigidAsPossibleDeformer.h"

#include "Algebra/AndersonAcceleration.h"
#include "Algebra/ClosestRotation.h"
#include "Algebra/Rotation.h"
#include "Deformation/JoinedVertices.h"
#include "Deformation/RegionThickness.h"
#include "Mesh/Geometry.h"

#include <cmath>

namespace cartan
{
namespace
{
using Row = Eigen::RowVector3d;

/// Below this part of what all edges would cost if they vanished, energies are made
/// of rounding.
constexpr double RoundingPart = 1e-20;

/// The largest parts of the energy and of the size in a last step that has settled.
constexpr double SettledDecrease = 0.01;
constexpr double SettledMove = 0.001;
}

AsRigidAsPossibleDeformer::AsRigidAsPossibleDeformer(HandleProblem problem, RigidityEnergy energy,
  InitialGuess guess, SolverBackend backend, const ExecutionContext& context)
  : SurfaceDeformer(std::move(problem))
  , GuessKind(guess)
{
  HandleProblem ofGuess = this->Problem;
  ofGuess.ClampWeights = energy != RigidityEnergy::SpokesAndRims;
  this->Guess = MakeInitialGuess(std::move(ofGuess), guess, backend, context.Part(0.0, 0.9));
  this->System = this->Guess->GetPositionSystem();
  this->MovingHandles = MovingHandleOfVertices(this->Problem);
  this->Cells = RigidCells(
    this->Problem, *this->System, *this->Guess->GetPositionWeights(), this->MovingHandles);
  if (energy == RigidityEnergy::SpokesAndRims)
  {
    this->Rims = this->Cells.FindRims(this->Problem);
  }
  if (energy == RigidityEnergy::SmoothedRotations)
  {
    this->AreCoupled = true;
    const Eigen::VectorXd areas =
      MixedVoronoiAreas(*this->Problem.Mesh, *this->Problem.Rest, context);
    std::vector<char> isFree(this->Problem.Mesh->NumberOfVertices(), 0);
    for (int i = 0; i < this->System->NumberOfUnknowns(); ++i)
    {
      this->FreeArea += areas[this->Cells.Vertices[i]];
      isFree[this->Cells.Vertices[i]] = 1;
    }
    this->Thickness = RegionThickness(*this->Problem.Mesh, *this->Problem.Rest, isFree);
  }
  for (int cell = 0; cell < this->Cells.Count; ++cell)
  {
    this->HoldsRotation.push_back(
      !this->Problem.ConstrainPositions && this->MovingHandles[this->Cells.Vertices[cell]] >= 0);
  }
  this->Rest.resize(this->Cells.NumberOfSites(), 3);
  for (int i = 0; i < this->Cells.NumberOfSites(); ++i)
  {
    this->Rest.row(i) = this->Problem.Rest->row(this->Cells.Vertices[i]);
  }
  this->NegligibleEnergy = RoundingPart * this->Cells.EnergyOfVanishedEdges(this->Rest);
  this->Current = this->Rest;
  this->Rotations = Identities(this->Cells.NumberOfSites());
  this->CellEnergies.setZero(this->Cells.Count);
  this->Forces.resize(this->System->NumberOfUnknowns(), 3);
  context.Report(1.0);
}

AsRigidAsPossibleDeformer::~AsRigidAsPossibleDeformer() = default;

std::size_t AsRigidAsPossibleDeformer::GetBytes() const
{
  return this->GetBaseBytes() + this->Guess->GetBytes() + this->Cells.GetBytes() +
    TotalBytes(this->Rims, this->HoldsRotation, this->MovingHandles, this->Rest, this->Current,
      this->Rotations, this->Before, this->Covariances, this->CellEnergies, this->Forces,
      this->Energies);
}

Eigen::VectorXd AsRigidAsPossibleDeformer::GetVertexEnergies() const
{
  Eigen::VectorXd energies = Eigen::VectorXd::Zero(this->Problem.Mesh->NumberOfVertices());
  for (int cell = 0; cell < this->Cells.Count; ++cell)
  {
    energies[this->Cells.Vertices[cell]] = this->CellEnergies[cell];
  }
  ShareEvenly(this->Problem.JoinedWith, energies);
  return energies;
}

/// c_jk |x_j - x_k - R (p_j - p_k)|^2 of the edge from the spoke's neighbor j to
/// the next one k.
inline double AsRigidAsPossibleDeformer::RimEnergy(int spoke, const Eigen::Matrix3d& rotation) const
{
  const RigidCells::Rim& rim = this->Rims[spoke];
  const int neighbor = this->Cells.Spokes[spoke].Neighbor;
  return rim.RimWeight *
    ((this->Current.row(neighbor) - this->Current.row(rim.Left)).transpose() -
      rotation * (this->Rest.row(neighbor) - this->Rest.row(rim.Left)).transpose())
      .squaredNorm();
}

/// How often a cell counts the bending toward a neighbor. A pair of coupled
/// rotations counts in both its cells. Where one is held and so never evaluated
/// again, the other counts for both.
inline double AsRigidAsPossibleDeformer::TimesOfBending(int cell, int neighbor) const
{
  const int active = this->Cells.ActiveCount;
  const int limit = cell < active ? active : this->Cells.Count;
  return neighbor >= limit ? 2.0 : cell >= active && neighbor < active ? 0.0 : 1.0;
}

/// What a spoke of an unknown cell i adds to b - L x,
///
///   w_ij ((R_i + R_j) (p_i - p_j) / 2 - (x_i - x_j));
///
/// with rims the mean is over the cells of the corners of the triangles beside it,
/// in which a triangle's edge is. `turned` is (R_i + R_j) (p_i - p_j).
inline Eigen::Vector3d AsRigidAsPossibleDeformer::ResidualOfSpoke(int spoke,
  const Eigen::Vector3d& edge, const Eigen::Vector3d& restEdge, const Eigen::Vector3d& turned) const
{
  const double weight = this->Cells.Spokes[spoke].Weight;
  if (this->Rims.empty())
  {
    return weight * (0.5 * turned - edge);
  }
  const RigidCells::Rim& rim = this->Rims[spoke];
  Eigen::Vector3d sum = weight * turned;
  if (rim.Left >= 0)
  {
    sum += rim.LeftWeight * (MatrixAt(this->Rotations, rim.Left) * restEdge);
  }
  if (rim.Right >= 0)
  {
    sum += (weight - rim.LeftWeight) * (MatrixAt(this->Rotations, rim.Right) * restEdge);
  }
  return sum / 3.0 - weight * edge;
}

void AsRigidAsPossibleDeformer::EvaluateCell(int cell, double bending, const HandleTargets& targets)
{
  const Row rest = this->Rest.row(cell);
  const Row current = this->Current.row(cell);
  const Eigen::Matrix3d rotation = MatrixAt(this->Rotations, cell);
  const bool isUnknown = cell < this->System->NumberOfUnknowns();
  const bool hasRims = !this->Rims.empty();
  double energy = 0.0;
  double rimEnergy = 0.0;
  double turning = 0.0;
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  for (int s = this->Cells.SpokeOffsets[cell]; s < this->Cells.SpokeOffsets[cell + 1]; ++s)
  {
    const RigidCells::Spoke& spoke = this->Cells.Spokes[s];
    const auto other = MatrixAt(this->Rotations, spoke.Neighbor);
    const Eigen::Vector3d edge = (current - this->Current.row(spoke.Neighbor)).transpose();
    const Eigen::Vector3d restEdge = (rest - this->Rest.row(spoke.Neighbor)).transpose();
    const Eigen::Vector3d turned = rotation * restEdge;
    energy += spoke.Weight * (edge - turned).squaredNorm();
    if (bending > 0.0)
    {
      turning += this->TimesOfBending(cell, spoke.Neighbor) * spoke.Weight *
        (rotation - other).squaredNorm();
    }
    if (hasRims && this->Rims[s].Left >= 0)
    {
      rimEnergy += this->RimEnergy(s, rotation);
    }
    if (isUnknown)
    {
      residual += this->ResidualOfSpoke(s, edge, restEdge, turned + other * restEdge);
    }
  }
  this->CellEnergies[cell] =
    hasRims ? 2.0 / 3.0 * (energy + rimEnergy) : energy + bending * turning;
  if (isUnknown)
  {
    const int unknown = this->Cells.Unknowns[cell];
    const double squaredWeight = this->System->SquaredSoftWeight(unknown);
    if (squaredWeight > 0.0)
    {
      const Eigen::Vector3d pull = HandleTarget(this->Problem, targets, this->Cells.Vertices[cell],
                                     this->System->MovingHandle(unknown)) -
        current.transpose();
      this->CellEnergies[cell] += squaredWeight * pull.squaredNorm();
      residual += 0.5 * squaredWeight * pull;
    }
    this->Forces.row(cell) = residual;
  }
}

double AsRigidAsPossibleDeformer::SumEnergies(
  const HandleTargets& targets, const ExecutionContext& context)
{
  const double bending = this->BendingFactor();
  context.For(this->Cells.ActiveCount,
    [&](int begin, int end)
    {
      for (int cell = begin; cell < end; ++cell)
      {
        this->EvaluateCell(cell, bending, targets);
      }
    });
  // In the same order whatever the threads.
  return this->CellEnergies.sum();
}

void AsRigidAsPossibleDeformer::Start(
  const HandleTargets& targets, DeformedSurface& result, const ExecutionContext& context)
{
  const int numberOfUnknowns = this->System->NumberOfUnknowns();
  this->Warning.clear();
  const bool startsFromPrevious =
    this->GuessKind == InitialGuess::PreviousResult && this->HasPrevious;
  const bool isGuessed = this->GuessKind != InitialGuess::RestShape && !startsFromPrevious;
  if (isGuessed)
  {
    this->Guess->Deform(targets, true, result, context);
    this->Warning = this->Guess->GetWarning();
  }
  else
  {
    result.Positions = HandlePositions(this->Problem, targets, this->MovingHandles);
  }
  result.FrameScale.setOnes(this->Problem.Mesh->NumberOfVertices());
  for (int i = startsFromPrevious ? numberOfUnknowns : 0; i < this->Cells.Count; ++i)
  {
    this->Current.row(i) = result.Positions.row(this->Cells.Vertices[i]);
  }
  const double bending = this->BendingFactor();
  context.For(this->Cells.Count,
    [&](int begin, int end)
    {
      for (int cell = begin; cell < end; ++cell)
      {
        const int v = this->Cells.Vertices[cell];
        auto rotation = MatrixAt(this->Rotations, cell);
        if (this->HoldsRotation[cell])
        {
          rotation = ClosestRotationOrNone(HandleTransform(targets, v, this->MovingHandles[v]));
        }
        else if (isGuessed)
        {
          rotation = ClosestRotationOrNone(MatrixAt(result.Transforms, v));
        }
        else if (!startsFromPrevious)
        {
          rotation.setIdentity();
        }
        if (cell >= this->Cells.ActiveCount && !this->HoldsRotation[cell])
        {
          rotation = ClosestRotationNear(this->Covariance(cell), rotation);
        }
      }
    });
  if (this->AreCoupled)
  {
    this->Before = this->Rotations;
  }
  for (int cell = this->Cells.ActiveCount; cell < this->Cells.Count; ++cell)
  {
    this->EvaluateCell(cell, bending, targets);
  }
}

/// L y = z for three values per cell, in the order of the cells.
void AsRigidAsPossibleDeformer::SolveCells(const Eigen::Ref<const Eigen::VectorXd>& values,
  Eigen::VectorXd& solution, const ExecutionContext& context)
{
  const int numberOfUnknowns = this->System->NumberOfUnknowns();
  Eigen::MatrixXd rightHandSide(numberOfUnknowns, 3);
  // In the order of the system, whose columns lie far apart.
  context.For(numberOfUnknowns,
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        rightHandSide.row(i) = values.segment<3>(3 * this->Cells.CellOfUnknown[i]);
      }
    });
  const Eigen::Map<const Eigen::MatrixXd> solved = this->System->Solve(rightHandSide, context);
  solution.resize(3 * numberOfUnknowns);
  context.For(numberOfUnknowns,
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        solution.segment<3>(3 * this->Cells.CellOfUnknown[i]) = solved.row(i);
      }
    });
}

/// L step = b - L x.
void AsRigidAsPossibleDeformer::SolveStep(Eigen::VectorXd& step, const ExecutionContext& context)
{
  this->SolveCells(
    Eigen::Map<const Eigen::VectorXd>(this->Forces.data(), this->Forces.size()), step, context);
}

bool AsRigidAsPossibleDeformer::HasSettled(double before, double after) const
{
  return before - after <= this->Tolerance * (std::abs(after) + this->NegligibleEnergy);
}

void AsRigidAsPossibleDeformer::WarnIfUnsettled(const Eigen::VectorXd& step)
{
  const double decrease = 1.0 - this->Energies.back() / this->Energies[this->Energies.size() - 2];
  if (!(decrease > SettledDecrease))
  {
    return;
  }
  const double settled = SettledMove * BoundingDiagonal(*this->Problem.Rest);
  IdSample moved;
  for (int i = 0; i < this->System->NumberOfUnknowns(); ++i)
  {
    if (step.segment<3>(3 * i).norm() > settled)
    {
      moved.Add(this->Cells.Vertices[i]);
    }
  }
  if (!moved.IsEmpty())
  {
    this->Warning += (this->Warning.empty() ? "" : " ") +
      ("The smoothed rotations have not settled: the last of " +
        std::to_string(this->GetNumberOfIterations()) + " iterations lowers the energy by " +
        std::to_string(std::lround(100.0 * decrease)) + " % and moves " +
        moved.Describe("point", "points") +
        " by over .1 % of the size. Raise MaximumIterations, or guess SHAPE_PRESERVING.");
  }
}

void AsRigidAsPossibleDeformer::WriteResult(bool wantTransforms, DeformedSurface& result) const
{
  for (int i = 0; i < this->System->NumberOfUnknowns(); ++i)
  {
    result.Positions.row(this->Cells.Vertices[i]) = this->Current.row(i);
  }
  if (wantTransforms)
  {
    result.Transforms = Identities(this->Problem.Mesh->NumberOfVertices());
    for (int cell = 0; cell < this->Cells.Count; ++cell)
    {
      result.Transforms.row(this->Cells.Vertices[cell]) = this->Rotations.row(cell);
    }
  }
}

/// Fits and solves in turn.
void AsRigidAsPossibleDeformer::Alternate(
  const HandleTargets& targets, Eigen::VectorXd& step, const ExecutionContext& context)
{
  Eigen::Map<Eigen::VectorXd> unknowns(this->Current.data(), 3 * this->System->NumberOfUnknowns());
  AndersonAcceleration extrapolation(1e-12);
  Eigen::VectorXd plain;
  Eigen::VectorXd next;
  Matrices rotations;
  const auto evaluate = [&]
  {
    this->FitRotations(context);
    return this->SumEnergies(targets, context);
  };
  while (!this->Converged && this->GetNumberOfIterations() < this->MaximumIterations)
  {
    const int iteration = this->GetNumberOfIterations();
    const double progress = 0.1 + 0.85 * iteration / this->MaximumIterations;
    context.Report(progress);
    const double before = this->Energies.back();
    this->SolveStep(step, context.Part(progress, progress));
    // E has the second derivatives 4 L and the gradient -4 (b - L x).
    this->Residual =
      2.0 * step.dot(Eigen::Map<const Eigen::VectorXd>(this->Forces.data(), step.size())) / before;
    plain = unknowns + step;
    const bool isExtrapolated = extrapolation.Next(plain, step, next);
    unknowns = next;
    if (isExtrapolated && this->AreCoupled)
    {
      rotations = this->Rotations;
    }
    double after = evaluate();
    if (isExtrapolated && !(before - after > this->Tolerance * std::abs(after)))
    {
      unknowns = plain;
      extrapolation.Forget();
      if (this->AreCoupled)
      {
        // Coupled rotations depend on where they come from.
        this->Rotations = rotations;
      }
      after = evaluate();
    }
    this->Energies.push_back(after);
    this->Converged = this->HasSettled(before, after);
  }
}

void AsRigidAsPossibleDeformer::DeformRelative(const HandleTargets& targets, bool wantTransforms,
  DeformedSurface& result, const ExecutionContext& context)
{
  this->Start(targets, result, context.Part(0.0, 0.1));
  const bool descends = this->CouplesFar() && this->MaximumIterations > 0;
  if (!descends)
  {
    this->FitRotations(context);
  }
  this->Energies = { this->SumEnergies(targets, context) };
  this->Residual = 0.0;
  this->Converged = this->System->NumberOfUnknowns() == 0;
  Eigen::VectorXd step;
  if (descends)
  {
    this->DescendByTurns(targets, step, context);
  }
  else
  {
    this->Alternate(targets, step, context);
  }
  if (this->AreCoupled && !this->Converged && step.size() > 0)
  {
    this->WarnIfUnsettled(step);
  }
  this->HasPrevious = true;
  this->WriteResult(wantTransforms, result);
  context.Report(1.0);
}
}
