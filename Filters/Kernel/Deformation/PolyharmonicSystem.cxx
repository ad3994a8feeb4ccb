// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/PolyharmonicSystem.h"

#include "Differential/LaplaceOperator.h"

namespace cartan
{
PolyharmonicSystem::PolyharmonicSystem(
  const HandleProblem& problem, int order, SolverBackend backend, const ExecutionContext& context)
  : System(backend)
{
  const TriangleMesh& mesh = *problem.Mesh;
  const std::vector<char> isUnknown = UnknownVertices(problem, Hold::AllHandles);
  const Eigen::VectorXd soft = SquaredSoftWeights(problem, isUnknown, Hold::AllHandles);
  this->NumberLocals(mesh, isUnknown, order);

  const LaplaceOperator laplace(mesh, *problem.Rest, problem.Weights, context.Part(0.0, 0.1));
  this->Laplacian = laplace.Restricted(mesh, this->Vertices);
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
  const SparseMatrix matrix = PolyharmonicMatrix(this->Laplacian, this->InverseMass, order);
  context.Report(0.3);
  this->System.Factorize(matrix, this->Held, context.Part(0.3, 1.0));
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

void PolyharmonicSystem::Solve(const Points& rightHandSide, Points& positions) const
{
  Points values = this->Gather(positions);
  this->System.Solve(rightHandSide, values);
  for (int i = 0; i < this->NumberOfUnknowns(); ++i)
  {
    positions.row(this->Vertices[i]) = values.row(i);
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
