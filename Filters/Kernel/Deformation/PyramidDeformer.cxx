// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/PyramidDeformer.h"

#include "Algebra/ClosestRotation.h"
#include "Algebra/LimitedMemoryBfgs.h"
#include "Deformation/JoinedVertices.h"
#include "Differential/PyramidCoordinates.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace cartan
{
namespace
{
/// Below this part of what all edges would cost if they vanished, E is made of rounding.
constexpr double RoundingOfPyramids = 1e-20;

/// The part of the decrease that the slope promises which a step must bring (Nocedal and
/// Wright, Numerical Optimization, 2006, Eq. 3.4).
constexpr double LeastDecrease = 1e-4;

/// How often a step is shortened, and to how much at least.
constexpr int PyramidShortenings = 8;
constexpr double ShortestPart = 0.1;

HandleProblem HeldInPosition(HandleProblem problem)
{
  if (!problem.ConstrainPositions)
  {
    throw Error(ErrorCode::BadInput,
      "Rotations follow from where handles are: turn ConstrainHandlePositions on.");
  }
  problem.ClampWeights = true;
  return problem;
}
}

PyramidDeformer::PyramidDeformer(
  HandleProblem problem, InitialGuess guess, SolverBackend backend, const ExecutionContext& context)
  : SurfaceDeformer(HeldInPosition(std::move(problem)))
  , GuessKind(guess)
  , Guess(MakeInitialGuess(this->Problem, guess, backend, context.Part(0.0, 0.9)))
  , System(this->Guess->GetPositionSystem())
  , Weights(this->Guess->GetPositionWeights())
  , MovingHandles(MovingHandleOfVertices(this->Problem))
{
  const TriangleMesh& mesh = *this->Problem.Mesh;
  this->RestFrames = PyramidFrames(mesh, *this->Problem.Rest, context);
  this->Rings = PyramidCoordinates(mesh, *this->Problem.Rest, this->RestFrames, context);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    this->HasNormal.push_back(!RingAreaVector(mesh, *this->Problem.Rest, v).isZero(0.0));
  }
  this->Frames = this->RestFrames;
  this->Current = *this->Problem.Rest;
  this->SlopesOfAreas.setZero(mesh.NumberOfVertices(), 3);
  this->CellEnergies.setZero(this->System->NumberOfLocals());
  context.Report(1.0);
}

std::size_t PyramidDeformer::GetBytes() const
{
  return this->GetBaseBytes() + this->Guess->GetBytes() +
    TotalBytes(this->MovingHandles, this->HasNormal, this->RestFrames, this->Rings, this->Current,
      this->SoftTargets, this->Frames, this->SlopesOfAreas, this->CellEnergies, this->Energies);
}

Eigen::VectorXd PyramidDeformer::GetVertexEnergies() const
{
  Eigen::VectorXd energies = Eigen::VectorXd::Zero(this->Problem.Mesh->NumberOfVertices());
  for (int i = 0; i < this->System->NumberOfLocals(); ++i)
  {
    energies[this->System->Vertex(i)] = this->CellEnergies[i];
  }
  ShareEvenly(this->Problem.JoinedWith, energies);
  return energies;
}

void PyramidDeformer::Start(
  const HandleTargets& targets, DeformedSurface& result, const ExecutionContext& context)
{
  this->Warning.clear();
  const bool startsFromPrevious =
    this->GuessKind == InitialGuess::PreviousResult && this->HasPrevious;
  const bool isGuessed = this->GuessKind != InitialGuess::RestShape && !startsFromPrevious;
  const Points previous = startsFromPrevious ? this->Current : Points();
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
  this->Current = result.Positions;
  this->SoftTargets.setZero(this->System->NumberOfUnknowns(), 3);
  for (int i = 0; i < this->System->NumberOfUnknowns(); ++i)
  {
    const int v = this->System->Vertex(i);
    if (startsFromPrevious)
    {
      this->Current.row(v) = previous.row(v);
    }
    if (this->System->SquaredSoftWeight(i) > 0.0)
    {
      this->SoftTargets.row(i) =
        HandleTarget(this->Problem, targets, v, this->System->MovingHandle(i)).transpose();
    }
  }
  for (int i = 0; i < this->System->NumberOfLocals() && !startsFromPrevious; ++i)
  {
    const int v = this->System->Vertex(i);
    const Eigen::Matrix3d turn = isGuessed ? ClosestRotationOrNone(MatrixAt(result.Transforms, v))
                                           : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
    MatrixAt(this->Frames, v) = turn * MatrixAt(this->RestFrames, v);
  }
}

/// R_i, and E.
double PyramidDeformer::FitCells(const ExecutionContext& context)
{
  const TriangleMesh& mesh = *this->Problem.Mesh;
  context.For(this->System->NumberOfLocals(),
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        const int v = this->System->Vertex(i);
        const Eigen::Matrix3d product =
          RingProduct(mesh, this->Current, this->Rings, *this->Weights, v);
        const Eigen::Matrix3d guess = MatrixAt(this->Frames, v);
        const Eigen::Vector3d area = RingAreaVector(mesh, this->Current, v);
        PyramidFit fit{ guess, Eigen::Vector3d::Zero() };
        if (area.isZero(0.0) || !this->HasNormal[v])
        {
          fit.Frame = ClosestRotationNear(product, guess);
        }
        else
        {
          fit = FitPyramid(product, area, guess);
        }
        MatrixAt(this->Frames, v) = fit.Frame;
        this->SlopesOfAreas.row(v) = fit.SlopeOfArea.transpose();
        double energy =
          RingResidual(mesh, this->Current, this->Rings, *this->Weights, v, fit.Frame);
        if (i < this->System->NumberOfUnknowns() && this->System->SquaredSoftWeight(i) > 0.0)
        {
          energy += this->System->SquaredSoftWeight(i) *
            (this->Current.row(v) - this->SoftTargets.row(i)).squaredNorm();
        }
        this->CellEnergies[i] = energy;
      }
    });
  // In the same order whatever the threads.
  return this->CellEnergies.sum();
}

/// dE/dx_i. Edges i -> j are in the rings of i and j,
///
///   sum_j -2 w_ij (x_j - x_i - R_i p_ij) + 2 w_ij (x_i - x_j - R_j p_ji),
///
/// and a triangle (i, b, c) has the area vector (i x b + b x c + c x i) / 2 in the planes of
/// its corners: with their slopes s, -2 s . d(area) is -(b - c) x (s_i + s_b + s_c) . di.
Eigen::Vector3d PyramidDeformer::SlopeAt(int unknown) const
{
  const TriangleMesh& mesh = *this->Problem.Mesh;
  const int v = this->System->Vertex(unknown);
  const Eigen::Matrix3d frame = MatrixAt(this->Frames, v);
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    const int b = mesh.Neighbor(d);
    const Eigen::Vector3d edge = (this->Current.row(b) - this->Current.row(v)).transpose();
    const Eigen::Vector3d there = frame * this->Rings.row(d).transpose();
    const Eigen::Vector3d back =
      MatrixAt(this->Frames, b) * this->Rings.row(mesh.Twin(d)).transpose();
    slope += 2.0 * (*this->Weights)[d] * (there - back - 2.0 * edge);
    const int next = mesh.NextAround(v, d);
    if (next >= 0)
    {
      const int c = mesh.Neighbor(next);
      const Eigen::Vector3d side = (this->Current.row(b) - this->Current.row(c)).transpose();
      slope -= side.cross(Eigen::Vector3d(
        this->SlopesOfAreas.row(v) + this->SlopesOfAreas.row(b) + this->SlopesOfAreas.row(c)));
    }
  }
  return slope +
    2.0 * this->System->SquaredSoftWeight(unknown) *
    (this->Current.row(v) - this->SoftTargets.row(unknown)).transpose();
}

/// dE/dx and (4 L)^-1 of it, coordinate by coordinate: 3 #unknowns.
void PyramidDeformer::FindSlope(
  Eigen::VectorXd& slope, Eigen::VectorXd& solved, const ExecutionContext& context)
{
  const int unknowns = this->System->NumberOfUnknowns();
  Eigen::MatrixXd slopes(unknowns, 3);
  context.For(unknowns,
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        slopes.row(i) = this->SlopeAt(i).transpose();
      }
    });
  slope = slopes.reshaped();
  solved = 0.25 * Eigen::MatrixXd(this->System->Solve(slopes, context)).reshaped();
}

double PyramidDeformer::Move(
  double t, const Eigen::VectorXd& direction, const Points& from, const ExecutionContext& context)
{
  const int unknowns = this->System->NumberOfUnknowns();
  for (int i = 0; i < unknowns; ++i)
  {
    const int v = this->System->Vertex(i);
    for (int c = 0; c < 3; ++c)
    {
      this->Current(v, c) = from(v, c) + t * direction[c * unknowns + i];
    }
  }
  return this->FitCells(context);
}

/// A step down the direction, shortened until it brings enough of what the slope promises;
/// returns E, which is not below `before` if no step brings any.
double PyramidDeformer::SearchAlong(
  Eigen::VectorXd& direction, double promised, double before, const ExecutionContext& context)
{
  const Points from = this->Current;
  const Matrices frames = this->Frames;
  double t = 1.0;
  double after = this->Move(t, direction, from, context);
  for (int i = 0; i < PyramidShortenings && !(after <= before + LeastDecrease * t * promised); ++i)
  {
    // To the lowest point of the parabola through what is known.
    const double lowest = -0.5 * t * promised / (after - before - t * promised);
    t *= std::isfinite(lowest) ? std::clamp(lowest, ShortestPart, 0.5) : ShortestPart;
    after = this->Move(t, direction, from, context);
  }
  if (!(after < before))
  {
    this->Frames = frames;
    return this->Move(0.0, direction, from, context);
  }
  direction *= t;
  return after;
}

void PyramidDeformer::Descend(const ExecutionContext& context)
{
  LimitedMemoryBfgs memory;
  Eigen::VectorXd slope;
  Eigen::VectorXd solved;
  Eigen::VectorXd direction;
  double edges = 0.0;
  for (int d = 0; d < this->Rings.rows(); ++d)
  {
    edges += (*this->Weights)[d] * this->Rings.row(d).squaredNorm();
  }
  const double negligible = RoundingOfPyramids * edges;
  while (!this->Converged && this->GetNumberOfIterations() < this->MaximumIterations)
  {
    context.Report(0.1 + 0.85 * this->GetNumberOfIterations() / this->MaximumIterations);
    const double before = this->Energies.back();
    this->FindSlope(slope, solved, context);
    memory.Next(slope, solved, direction);
    const double after = this->SearchAlong(direction, direction.dot(slope), before, context);
    this->Energies.push_back(std::min(before, after));
    if (after < before)
    {
      memory.Take(direction);
      this->Converged = before - after <= this->Tolerance * (after + negligible);
    }
    else
    {
      // What is left is rounding, unless the memory was to blame.
      this->Converged = memory.IsEmpty();
      memory.Forget();
    }
  }
}

void PyramidDeformer::WriteTransforms(const HandleTargets& targets, Matrices& transforms) const
{
  const int vertices = this->Problem.Mesh->NumberOfVertices();
  transforms = Identities(vertices);
  for (int v = 0; v < vertices; ++v)
  {
    if (this->MovingHandles[v] >= 0)
    {
      MatrixAt(transforms, v) =
        ClosestRotationOrNone(HandleTransform(targets, v, this->MovingHandles[v]));
    }
  }
  for (int i = 0; i < this->System->NumberOfLocals(); ++i)
  {
    const int v = this->System->Vertex(i);
    MatrixAt(transforms, v) = MatrixAt(this->Frames, v) * MatrixAt(this->RestFrames, v).transpose();
  }
}

void PyramidDeformer::DeformRelative(const HandleTargets& targets, bool wantTransforms,
  DeformedSurface& result, const ExecutionContext& context)
{
  this->Start(targets, result, context.Part(0.0, 0.1));
  this->Energies = { this->FitCells(context) };
  this->Converged = this->System->NumberOfUnknowns() == 0;
  this->Descend(context);
  if (!this->Converged && this->MaximumIterations > 0)
  {
    const double before = this->Energies[this->Energies.size() - 2];
    std::ostringstream text;
    text << (this->Warning.empty() ? "" : " ") << "The surface has not settled: the last of "
         << this->GetNumberOfIterations() << " iterations lowers the energy by "
         << 100.0 * (1.0 - this->Energies.back() / before) << " %. Raise MaximumIterations.";
    this->Warning += text.str();
  }
  this->HasPrevious = true;
  for (int i = 0; i < this->System->NumberOfUnknowns(); ++i)
  {
    const int v = this->System->Vertex(i);
    result.Positions.row(v) = this->Current.row(v);
  }
  if (wantTransforms)
  {
    this->WriteTransforms(targets, result.Transforms);
  }
  context.Report(1.0);
}
}
