// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/AsRigidAsPossibleDeformer.h"

#include "Algebra/AndersonAcceleration.h"
#include "Algebra/Rotation.h"
#include "Deformation/RotationInvariantDeformer.h"
#include "Deformation/ShapePreservingDeformer.h"
#include "Mesh/Geometry.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
using Row = Eigen::RowVector3d;
}

AsRigidAsPossibleDeformer::AsRigidAsPossibleDeformer(HandleProblem problem, RigidityEnergy energy,
  InitialGuess guess, SolverBackend backend, const ExecutionContext& context)
  : SurfaceDeformer(std::move(problem))
  , GuessKind(guess)
{
  HandleProblem ofGuess = this->Problem;
  ofGuess.Weights = ofGuess.PositionWeights;
  ofGuess.ClampWeights = energy != RigidityEnergy::SpokesAndRims;
  if (guess == InitialGuess::RotationInvariant)
  {
    this->Guess =
      std::make_unique<RotationInvariantDeformer>(ofGuess, backend, context.Part(0.0, 0.9));
  }
  else
  {
    this->Guess =
      std::make_unique<ShapePreservingDeformer>(ofGuess, backend, context.Part(0.0, 0.9));
  }
  this->System = this->Guess->GetPositionSystem();
  this->MovingHandles = MovingHandleOfVertices(this->Problem);
  this->BuildCells();
  if (energy == RigidityEnergy::SpokesAndRims)
  {
    this->BuildRims();
  }
  if (energy == RigidityEnergy::SmoothedRotations)
  {
    this->BuildColors();
    const Eigen::VectorXd areas =
      MixedVoronoiAreas(*this->Problem.Mesh, *this->Problem.Rest, context);
    for (int i = 0; i < this->System->NumberOfUnknowns(); ++i)
    {
      this->FreeArea += areas[this->Vertices[i]];
    }
  }
  context.Report(1.0);
}

AsRigidAsPossibleDeformer::~AsRigidAsPossibleDeformer() = default;

std::size_t AsRigidAsPossibleDeformer::GetBytes() const
{
  return this->GetBaseBytes() + this->Guess->GetBytes() +
    TotalBytes(this->Vertices, this->Unknowns, this->Cells, this->HoldsRotation, this->SpokeOffsets,
      this->Spokes, this->Rims, this->Colors, this->MovingHandles, this->Rest, this->Current,
      this->Rotations, this->CellEnergies, this->Residual, this->Energies);
}

Eigen::VectorXd AsRigidAsPossibleDeformer::GetVertexEnergies() const
{
  Eigen::VectorXd energies = Eigen::VectorXd::Zero(this->Problem.Mesh->NumberOfVertices());
  for (int cell = 0; cell < this->CellCount; ++cell)
  {
    energies[this->Vertices[cell]] = this->CellEnergies[cell];
  }
  return energies;
}

void AsRigidAsPossibleDeformer::BuildCells()
{
  const TriangleMesh& mesh = *this->Problem.Mesh;
  const Eigen::VectorXd& weights = *this->Guess->GetPositionWeights();
  std::vector<int> site(mesh.NumberOfVertices(), -1);
  const auto number = [&](int v)
  {
    if (site[v] < 0)
    {
      site[v] = static_cast<int>(this->Vertices.size());
      this->Vertices.push_back(v);
    }
    return site[v];
  };
  // Breadth first, so that a cell's neighbors are near it in memory: an order
  // of vertices without that makes a step half as fast.
  std::vector<int> unknown(mesh.NumberOfVertices(), -1);
  for (int i = 0; i < this->System->NumberOfUnknowns(); ++i)
  {
    unknown[this->System->Vertex(i)] = i;
  }
  this->Cells.resize(this->System->NumberOfUnknowns());
  for (int i = 0; i < this->System->NumberOfUnknowns(); ++i)
  {
    std::size_t next = this->Vertices.size();
    for (number(this->System->Vertex(i)); next < this->Vertices.size(); ++next)
    {
      const int v = this->Vertices[next];
      this->Cells[unknown[v]] = static_cast<int>(this->Unknowns.size());
      this->Unknowns.push_back(unknown[v]);
      for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
      {
        if (unknown[mesh.Neighbor(d)] >= 0)
        {
          number(mesh.Neighbor(d));
        }
      }
    }
  }
  for (int i = this->System->NumberOfUnknowns(); i < this->System->NumberOfLocals(); ++i)
  {
    number(this->System->Vertex(i));
  }
  this->ActiveCount = this->System->NumberOfLocals();
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (this->MovingHandles[v] >= 0 && mesh.IsUsed(v))
    {
      number(v);
      for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
      {
        number(mesh.Neighbor(d));
      }
    }
  }
  this->CellCount = static_cast<int>(this->Vertices.size());
  this->SpokeOffsets.push_back(0);
  for (int cell = 0; cell < this->CellCount; ++cell)
  {
    const int v = this->Vertices[cell];
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      this->Spokes.push_back({ number(mesh.Neighbor(d)), weights[d] });
    }
    this->SpokeOffsets.push_back(static_cast<int>(this->Spokes.size()));
    this->HoldsRotation.push_back(!this->Problem.ConstrainPositions && this->MovingHandles[v] >= 0);
  }
  const auto numberOfSites = static_cast<Eigen::Index>(this->Vertices.size());
  this->Rest.resize(numberOfSites, 3);
  for (Eigen::Index i = 0; i < numberOfSites; ++i)
  {
    this->Rest.row(i) = this->Problem.Rest->row(this->Vertices[i]);
  }
  this->Current = this->Rest;
  this->Rotations = Identities(numberOfSites);
  this->CellEnergies.setZero(this->CellCount);
  this->Residual.resize(this->System->NumberOfUnknowns(), 3);
}

void AsRigidAsPossibleDeformer::BuildRims()
{
  const TriangleMesh& mesh = *this->Problem.Mesh;
  const Points cornerWeights =
    CornerWeights(mesh, *this->Problem.Rest, this->Problem.PositionWeights);
  const auto weightOpposite = [&](int triangle, int v)
  {
    const auto corners = mesh.GetTriangles().row(triangle);
    return cornerWeights(triangle, corners[0] == v ? 0 : corners[1] == v ? 1 : 2);
  };
  // Sites of a ring's vertices are its cell's spokes: the left one is the next.
  for (int cell = 0; cell < this->CellCount; ++cell)
  {
    const int v = this->Vertices[cell];
    const int begin = this->SpokeOffsets[cell];
    const int count = this->SpokeOffsets[cell + 1] - begin;
    for (int k = 0; k < count; ++k)
    {
      const int d = mesh.RingBegin(v) + k;
      const int before = (k + count - 1) % count;
      Rim rim = { -1, -1, 0.0, 0.0 };
      if (mesh.LeftTriangle(d) >= 0)
      {
        rim.Left = this->Spokes[begin + (k + 1) % count].Neighbor;
        rim.LeftWeight = weightOpposite(mesh.LeftTriangle(d), mesh.Opposite(d));
        rim.RimWeight = weightOpposite(mesh.LeftTriangle(d), v);
      }
      if (mesh.LeftTriangle(mesh.RingBegin(v) + before) >= 0)
      {
        rim.Right = this->Spokes[begin + before].Neighbor;
      }
      this->Rims.push_back(rim);
    }
  }
}

void AsRigidAsPossibleDeformer::BuildColors()
{
  // Greedy: the smallest color that no neighbor has.
  std::vector<int> colors(this->ActiveCount, -1);
  std::vector<char> isTaken;
  for (int cell = 0; cell < this->ActiveCount; ++cell)
  {
    isTaken.assign(this->Colors.size() + 1, 0);
    for (int s = this->SpokeOffsets[cell]; s < this->SpokeOffsets[cell + 1]; ++s)
    {
      const int neighbor = this->Spokes[s].Neighbor;
      if (neighbor < this->ActiveCount && colors[neighbor] >= 0)
      {
        isTaken[colors[neighbor]] = 1;
      }
    }
    const auto color = std::find(isTaken.begin(), isTaken.end(), 0) - isTaken.begin();
    colors[cell] = static_cast<int>(color);
    if (color == static_cast<std::ptrdiff_t>(this->Colors.size()))
    {
      this->Colors.emplace_back();
    }
    this->Colors[color].push_back(cell);
  }
}

void AsRigidAsPossibleDeformer::FitCell(int cell, double bending)
{
  if (this->HoldsRotation[cell])
  {
    return;
  }
  // Spokes: E_i is least for the rotation closest to
  //   sum_j w_ij (x_i - x_j) (p_i - p_j)^T;
  // each pair of coupled rotations is in the sum over both its cells, which
  // adds 2 alpha A sum_j w_ij R_j.
  const Row rest = this->Rest.row(cell);
  const Row current = this->Current.row(cell);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (int s = this->SpokeOffsets[cell]; s < this->SpokeOffsets[cell + 1]; ++s)
  {
    const Spoke& spoke = this->Spokes[s];
    const Row edge = current - this->Current.row(spoke.Neighbor);
    const Row restEdge = spoke.Weight * (rest - this->Rest.row(spoke.Neighbor));
    covariance += edge.transpose() * restEdge;
    if (bending > 0.0)
    {
      covariance += 2.0 * bending * spoke.Weight * MatrixAt(this->Rotations, spoke.Neighbor);
    }
  }
  if (!this->Rims.empty())
  {
    for (int s = this->SpokeOffsets[cell]; s < this->SpokeOffsets[cell + 1]; ++s)
    {
      const Rim& rim = this->Rims[s];
      if (rim.Left >= 0)
      {
        const int neighbor = this->Spokes[s].Neighbor;
        const Row edge = this->Current.row(neighbor) - this->Current.row(rim.Left);
        const Row restEdge = rim.RimWeight * (this->Rest.row(neighbor) - this->Rest.row(rim.Left));
        covariance += edge.transpose() * restEdge;
      }
    }
  }
  auto rotation = MatrixAt(this->Rotations, cell);
  rotation = ProjectOnRotations(covariance, rotation);
}

void AsRigidAsPossibleDeformer::FitRotations(const ExecutionContext& context)
{
  if (this->Colors.empty())
  {
    context.For(this->ActiveCount,
      [&](int begin, int end)
      {
        for (int cell = begin; cell < end; ++cell)
        {
          this->FitCell(cell, 0.0);
        }
      });
    return;
  }
  // Each fit sees its neighbors' rotations, so that none raises the energy;
  // those of one color see none of each other.
  const double bending = this->Bending * this->FreeArea;
  for (const std::vector<int>& cells : this->Colors)
  {
    context.For(static_cast<int>(cells.size()),
      [&](int begin, int end)
      {
        for (int i = begin; i < end; ++i)
        {
          this->FitCell(cells[i], bending);
        }
      });
  }
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
  for (int s = this->SpokeOffsets[cell]; s < this->SpokeOffsets[cell + 1]; ++s)
  {
    const Spoke& spoke = this->Spokes[s];
    const auto other = MatrixAt(this->Rotations, spoke.Neighbor);
    const Eigen::Vector3d edge = (current - this->Current.row(spoke.Neighbor)).transpose();
    const Eigen::Vector3d restEdge = (rest - this->Rest.row(spoke.Neighbor)).transpose();
    const Eigen::Vector3d turned = rotation * restEdge;
    energy += spoke.Weight * (edge - turned).squaredNorm();
    if (bending > 0.0)
    {
      // A pair of coupled rotations counts in both its cells. Where one is held
      // and so never evaluated again, the other counts for both.
      const int limit = cell < this->ActiveCount ? this->ActiveCount : this->CellCount;
      const double times = spoke.Neighbor >= limit                        ? 2.0
        : cell >= this->ActiveCount && spoke.Neighbor < this->ActiveCount ? 0.0
                                                                          : 1.0;
      turning += times * spoke.Weight * (rotation - other).squaredNorm();
    }
    if (hasRims && this->Rims[s].Left >= 0)
    {
      const Rim& rim = this->Rims[s];
      rimEnergy += rim.RimWeight *
        ((this->Current.row(spoke.Neighbor) - this->Current.row(rim.Left)).transpose() -
          rotation * (this->Rest.row(spoke.Neighbor) - this->Rest.row(rim.Left)).transpose())
          .squaredNorm();
    }
    if (!isUnknown)
    {
      continue;
    }
    if (!hasRims)
    {
      residual += spoke.Weight * (0.5 * (turned + other * restEdge) - edge);
      continue;
    }
    // A triangle's edge is in three cells: those of its corners.
    const Rim& rim = this->Rims[s];
    Eigen::Vector3d sum = spoke.Weight * (turned + other * restEdge);
    if (rim.Left >= 0)
    {
      sum += rim.LeftWeight * (MatrixAt(this->Rotations, rim.Left) * restEdge);
    }
    if (rim.Right >= 0)
    {
      sum += (spoke.Weight - rim.LeftWeight) * (MatrixAt(this->Rotations, rim.Right) * restEdge);
    }
    residual += sum / 3.0 - spoke.Weight * edge;
  }
  this->CellEnergies[cell] =
    hasRims ? 2.0 / 3.0 * (energy + rimEnergy) : energy + bending * turning;
  if (isUnknown)
  {
    const int unknown = this->Unknowns[cell];
    const double squaredWeight = this->System->SquaredSoftWeight(unknown);
    if (squaredWeight > 0.0)
    {
      const Eigen::Vector3d pull = HandleTarget(this->Problem, targets, this->Vertices[cell],
                                     this->System->MovingHandle(unknown)) -
        current.transpose();
      this->CellEnergies[cell] += squaredWeight * pull.squaredNorm();
      residual += 0.5 * squaredWeight * pull;
    }
    this->Residual.row(cell) = residual;
  }
}

double AsRigidAsPossibleDeformer::Evaluate(
  const HandleTargets& targets, const ExecutionContext& context)
{
  this->FitRotations(context);
  const double bending = this->Colors.empty() ? 0.0 : this->Bending * this->FreeArea;
  context.For(this->ActiveCount,
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
  for (int i = startsFromPrevious ? numberOfUnknowns : 0; i < this->CellCount; ++i)
  {
    this->Current.row(i) = result.Positions.row(this->Vertices[i]);
  }
  const double bending = this->Colors.empty() ? 0.0 : this->Bending * this->FreeArea;
  context.For(this->CellCount,
    [&](int begin, int end)
    {
      for (int cell = begin; cell < end; ++cell)
      {
        const int v = this->Vertices[cell];
        auto rotation = MatrixAt(this->Rotations, cell);
        if (this->HoldsRotation[cell])
        {
          rotation = ProjectOnRotations(HandleTransform(targets, v, this->MovingHandles[v]));
        }
        else if (isGuessed)
        {
          rotation = ProjectOnRotations(MatrixAt(result.Transforms, v));
        }
        else if (!startsFromPrevious)
        {
          rotation.setIdentity();
        }
        if (cell >= this->ActiveCount)
        {
          this->FitCell(cell, 0.0);
        }
      }
    });
  for (int cell = this->ActiveCount; cell < this->CellCount; ++cell)
  {
    this->EvaluateCell(cell, bending, targets);
  }
}

void AsRigidAsPossibleDeformer::DeformRelative(const HandleTargets& targets, bool wantTransforms,
  DeformedSurface& result, const ExecutionContext& context)
{
  this->Start(targets, result, context.Part(0.0, 0.1));
  const int numberOfUnknowns = this->System->NumberOfUnknowns();
  Eigen::Map<Eigen::VectorXd> unknowns(this->Current.data(), 3 * numberOfUnknowns);
  AndersonAcceleration extrapolation(1e-12);
  Eigen::MatrixXd rightHandSide(numberOfUnknowns, 3);
  Eigen::VectorXd step(3 * numberOfUnknowns);
  Eigen::VectorXd plain;
  Eigen::VectorXd next;
  Matrices rotations;

  // Below this part of what all edges would cost if they vanished, energies are
  // made of rounding.
  double negligible = 0.0;
  for (int cell = 0; cell < this->CellCount; ++cell)
  {
    for (int s = this->SpokeOffsets[cell]; s < this->SpokeOffsets[cell + 1]; ++s)
    {
      negligible += 1e-20 * this->Spokes[s].Weight *
        (this->Rest.row(cell) - this->Rest.row(this->Spokes[s].Neighbor)).squaredNorm();
    }
  }
  this->Energies = { this->Evaluate(targets, context) };
  this->Converged = numberOfUnknowns == 0;
  while (!this->Converged && this->GetNumberOfIterations() < this->MaximumIterations)
  {
    const int iteration = this->GetNumberOfIterations();
    context.Report(0.1 + 0.85 * iteration / this->MaximumIterations);
    const double before = this->Energies.back();
    // In the order of the system, whose columns lie far apart.
    for (int i = 0; i < numberOfUnknowns; ++i)
    {
      rightHandSide.row(i) = this->Residual.row(this->Cells[i]);
    }
    const Eigen::Map<const Eigen::MatrixXd> solution = this->System->Solve(rightHandSide);
    for (int i = 0; i < numberOfUnknowns; ++i)
    {
      step.segment<3>(3 * this->Cells[i]) = solution.row(i);
    }
    plain = unknowns + step;
    const bool isExtrapolated = extrapolation.Next(plain, step, next);
    unknowns = next;
    if (isExtrapolated && !this->Colors.empty())
    {
      rotations = this->Rotations;
    }
    double after = this->Evaluate(targets, context);
    if (isExtrapolated && !(before - after > this->Tolerance * std::abs(after)))
    {
      unknowns = plain;
      extrapolation.Forget();
      if (!this->Colors.empty())
      {
        // Coupled rotations depend on where they come from.
        this->Rotations = rotations;
      }
      after = this->Evaluate(targets, context);
    }
    this->Energies.push_back(after);
    this->Converged = before - after <= this->Tolerance * (std::abs(after) + negligible);
  }
  this->HasPrevious = true;

  for (int i = 0; i < numberOfUnknowns; ++i)
  {
    result.Positions.row(this->Vertices[i]) = this->Current.row(i);
  }
  if (wantTransforms)
  {
    result.Transforms = Identities(this->Problem.Mesh->NumberOfVertices());
    for (int cell = 0; cell < this->CellCount; ++cell)
    {
      result.Transforms.row(this->Vertices[cell]) = this->Rotations.row(cell);
    }
  }
  context.Report(1.0);
}
}
