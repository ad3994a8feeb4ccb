// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/PolyharmonicSystem.h"

#include "Mesh/Geometry.h"

namespace cartan
{
PolyharmonicSystem::PolyharmonicSystem(
  const HandleProblem& problem, int order, SolverBackend backend, const ExecutionContext& context)
  : Problem(problem)
  , MovingHandles(MovingHandleOfVertices(problem))
  , Solver(backend)
{
  const TriangleMesh& mesh = *problem.Mesh;
  this->Laplacian = cartan::Laplacian(
    mesh, SymmetricPart(mesh, EdgeWeights(mesh, *problem.Rest, problem.Weights, context)));
  this->InverseMass = Eigen::VectorXd::Ones(mesh.NumberOfVertices());
  if (problem.Weights != LaplacianWeights::Uniform)
  {
    const Eigen::VectorXd areas = MixedVoronoiAreas(mesh, *problem.Rest, context);
    int numberOfUsed = 0;
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      numberOfUsed += mesh.IsUsed(v) ? 1 : 0;
    }
    const double mean = areas.sum() / numberOfUsed;
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      // A vertex whose triangles have no area counts as an average one.
      this->InverseMass[v] = areas[v] > 1e-12 * mean ? mean / areas[v] : 1.0;
    }
  }
  SparseMatrix matrix = this->Laplacian;
  for (int k = 1; k < order; ++k)
  {
    matrix = (matrix * this->InverseMass.asDiagonal() * this->Laplacian).eval();
  }
  context.Report(0.3);
  const std::vector<char> isUnknown = UnknownVertices(problem, Hold::AllHandles);
  std::vector<char> isFixed(isUnknown.size());
  for (std::size_t v = 0; v < isFixed.size(); ++v)
  {
    isFixed[v] = !isUnknown[v];
  }
  this->Stiffness = 0.5 * SquaredSoftWeights(problem, isUnknown, Hold::AllHandles);
  this->Solver.Factorize(matrix, isFixed, this->Stiffness, {}, context.Part(0.3, 1.0));
}

Points PolyharmonicSystem::DifferentialCoordinates(const Points& points) const
{
  return this->InverseMass.asDiagonal() * (this->Laplacian * points).eval();
}

Points PolyharmonicSystem::Targets(const HandleTargets& targets) const
{
  return HandlePositions(this->Problem, targets, this->MovingHandles);
}

void PolyharmonicSystem::Solve(const Points& rightHandSide, Points& values) const
{
  const Field complete = rightHandSide + this->Stiffness.asDiagonal() * values;
  Field solution = values;
  this->Solver.Solve(complete, solution);
  values = solution;
}

void RequirePositions(const HandleProblem& problem, const std::string& method)
{
  if (!problem.ConstrainPositions)
  {
    throw Error(ErrorCode::BadInput,
      method +
        " knows handles by their positions only: turn ConstrainHandlePositions on, or choose a "
        "method with frames.");
  }
}
}
