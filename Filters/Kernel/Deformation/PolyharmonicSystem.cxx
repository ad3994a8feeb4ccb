// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/PolyharmonicSystem.h"

#include "Differential/LaplaceOperator.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace cartan
{
namespace
{
/// Rows that reach beyond the neighbors make supernodes large, from which solves are no
/// slower than from columns.
FactorLimits PolyharmonicLimits(int order)
{
  FactorLimits limits;
  limits.Use = order > 1 ? FactorUse::FewSolves : FactorUse::ManySolves;
  return limits;
}
}

PolyharmonicSystem::PolyharmonicSystem(
  const HandleProblem& problem, int order, SolverBackend backend, const ExecutionContext& context)
  : Order(order)
  , System(
      order == 1 ? backend : RequireDirect(backend, "A method of order " + std::to_string(order)),
      PolyharmonicLimits(order))
{
  const TriangleMesh& mesh = *problem.Mesh;
  const std::vector<char> isUnknown = UnknownVertices(problem, Hold::AllHandles);
  const Eigen::VectorXd soft = SquaredSoftWeights(problem, isUnknown, Hold::AllHandles);
  this->NumberLocals(mesh, isUnknown, order);

  const LaplaceOperator laplace(mesh, *problem.Rest, problem.Weights, context.Part(0.0, 0.1));
  this->Laplacian = cartan::Laplacian(mesh, laplace.GetWeights(), this->Vertices);
  this->InverseMass.resize(this->NumberOfLocals());
  this->Held = Anchors::After(this->NumberOfUnknowns(), this->NumberOfLocals());
  this->Held.Vertices = this->Vertices;
  this->Held.Stiffness.resize(this->NumberOfLocals());
  for (int i = 0; i < this->NumberOfLocals(); ++i)
  {
    this->InverseMass[i] = 1.0 / laplace.GetMass()[this->Vertices[i]];
    this->Held.Stiffness[i] = 0.5 * soft[this->Vertices[i]];
  }
  // A walk of k edges from an unknown vertex meets complete rows only, so that
  // the unknowns' rows are those of the whole mesh.
  SparseMatrix matrix = PolyharmonicMatrix(this->Laplacian, this->InverseMass, order);
  context.Report(0.3);
  this->System.Factorize(std::move(matrix), this->Held, context.Part(0.3, 0.95));
  this->MeasureError(*problem.Rest);
  context.Report(1.0);
}

void PolyharmonicSystem::NumberLocals(
  const TriangleMesh& mesh, const std::vector<char>& isUnknown, int order)
{
  std::vector<char> isLocal = isUnknown;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (isUnknown[v])
    {
      this->Vertices.push_back(v);
    }
  }
  this->RingEnds.push_back(this->NumberOfLocals());
  int begin = 0;
  for (int ring = 1; ring <= order; ++ring)
  {
    const int end = this->NumberOfLocals();
    for (int i = begin; i < end; ++i)
    {
      const int v = this->Vertices[i];
      for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
      {
        if (!isLocal[mesh.Neighbor(d)])
        {
          isLocal[mesh.Neighbor(d)] = 1;
          this->Vertices.push_back(mesh.Neighbor(d));
        }
      }
    }
    this->RingEnds.push_back(this->NumberOfLocals());
    begin = end;
  }
}

Points PolyharmonicSystem::Gather(const Points& ofVertices) const
{
  Points locals(this->NumberOfLocals(), 3);
  for (int i = 0; i < this->NumberOfLocals(); ++i)
  {
    locals.row(i) = ofVertices.row(this->Vertices[i]);
  }
  return locals;
}

Points PolyharmonicSystem::Differential(const Points& locals) const
{
  return this->InverseMass.asDiagonal() * ApplyLaplacian(this->Laplacian, locals);
}

Points PolyharmonicSystem::Apply(const Points& locals) const
{
  Points values = locals;
  for (int k = 1; k < this->Order; ++k)
  {
    values = this->Differential(values);
  }
  return ApplyLaplacian(this->Laplacian, values);
}

/// One step of iterative refinement: x += K^-1 (b + s (t - x) - K x).
void PolyharmonicSystem::Refine(
  const Points& rightHandSide, const Points& targets, Points& values) const
{
  const Points residual =
    rightHandSide + this->Held.Stiffness.asDiagonal() * (targets - values) - this->Apply(values);
  Points correction = Points::Zero(values.rows(), 3);
  this->System.Solve(residual, correction);
  values += correction;
}

void PolyharmonicSystem::Solve(const Points& rightHandSide, Points& values) const
{
  const Points targets = this->Gather(values);
  Points locals = targets;
  this->System.Solve(rightHandSide, locals);
  for (int i = 0; i < this->Refinements; ++i)
  {
    this->Refine(rightHandSide, targets, locals);
  }
  for (int i = 0; i < this->NumberOfUnknowns(); ++i)
  {
    values.row(this->Vertices[i]) = locals.row(i);
  }
}

void PolyharmonicSystem::Interpolate(Field& locals) const
{
  const Field targets = locals;
  this->System.Interpolate(locals);
  const Points zero = Points::Zero(this->Refinements ? locals.rows() : 0, 3);
  for (Eigen::Index column = 0; this->Refinements && column < locals.cols(); column += 3)
  {
    const Eigen::Index count = std::min<Eigen::Index>(3, locals.cols() - column);
    Points target = Points::Zero(locals.rows(), 3);
    Points value = target;
    target.leftCols(count) = targets.middleCols(column, count);
    value.leftCols(count) = locals.middleCols(column, count);
    for (int i = 0; i < this->Refinements; ++i)
    {
      this->Refine(zero, target, value);
    }
    locals.middleCols(column, count) = value.leftCols(count);
  }
}

/// Solves for the rest positions, which are the solution to K times themselves,
/// and counts the refinements after which no more is won.
void PolyharmonicSystem::MeasureError(const Points& rest)
{
  Points known = this->Gather(rest);
  if (this->NumberOfUnknowns() == 0)
  {
    return;
  }
  known.rowwise() -= known.colwise().mean().eval();
  const double size = known.rowwise().norm().maxCoeff();
  const Points rightHandSide = this->Apply(known);
  Points values = known;
  this->System.Solve(rightHandSide, values);
  const auto errors = [&]() -> Eigen::VectorXd
  { return (values - known).rowwise().norm() / (size > 0.0 ? size : 1.0); };
  this->MeasuredError = errors().maxCoeff();
  // A step that wins less than a digit is of no use.
  constexpr double Gain = 0.1;
  for (double before = 1.0 / Gain;
       this->MeasuredError > RefinedError && this->MeasuredError < Gain * before;)
  {
    before = this->MeasuredError;
    this->Refine(rightHandSide, known, values);
    this->MeasuredError = errors().maxCoeff();
    ++this->Refinements;
  }
  this->Warn(errors());
}

void PolyharmonicSystem::Warn(const Eigen::VectorXd& errors)
{
  IdSample lost;
  for (int i = 0; i < this->NumberOfUnknowns(); ++i)
  {
    if (errors[i] > WarnedError)
    {
      lost.Add(this->Vertices[i]);
    }
  }
  if (!lost.IsEmpty())
  {
    std::ostringstream warning;
    warning << std::setprecision(2) << "Rounding in the system of order " << this->Order
            << " moves " << lost.Describe("point", "points") << " by up to " << errors.maxCoeff()
            << " of the size of the surface between the handles. Use a method of order 1, such as "
               "Rotation Invariant Deformation, or hold more points.";
    this->Warning = warning.str();
  }
}

HandleProblem RequirePositions(HandleProblem problem, const std::string& method)
{
  if (!problem.ConstrainPositions)
  {
    throw Error(ErrorCode::BadInput,
      method +
        " knows handles by their positions only: turn ConstrainHandlePositions on, or choose a "
        "method with frames.");
  }
  return problem;
}
}
