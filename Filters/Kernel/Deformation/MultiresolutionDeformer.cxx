// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/MultiresolutionDeformer.h"

#include "Measure/Measures.h"

namespace cartan
{
MultiresolutionDeformer::MultiresolutionDeformer(
  HandleProblem problem, int order, SolverBackend backend, const ExecutionContext& context)
  : SurfaceDeformer(std::move(problem))
  , System(this->Problem, order, backend, context.Part(0.0, 0.9))
  , RestBase(*this->Problem.Rest)
{
  RequirePositions(this->Problem, "Multiresolution editing");
  this->System.Solve(Points::Zero(this->RestBase.rows(), 3), this->RestBase);
  context.Report(1.0);
}

void MultiresolutionDeformer::Deform(const HandleTargets& targets, bool wantTransforms,
  DeformedSurface& result, const ExecutionContext& context)
{
  const Points& rest = *this->Problem.Rest;
  result.Positions = this->System.Targets(targets);
  this->System.Solve(Points::Zero(rest.rows(), 3), result.Positions);
  context.Report(0.5);
  // The base's local frame turns as its one-ring and normal do.
  const Matrices rotations =
    FitRotations(*this->Problem.Mesh, this->RestBase, result.Positions, context);
  const std::vector<int>& unknowns = this->System.GetUnknowns();
  context.For(static_cast<int>(unknowns.size()),
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        const int v = unknowns[i];
        const Eigen::Vector3d detail = (rest.row(v) - this->RestBase.row(v)).transpose();
        result.Positions.row(v) += (MatrixAt(rotations, v) * detail).transpose();
      }
    });
  if (wantTransforms)
  {
    result.Transforms = rotations;
  }
  context.Report(1.0);
}
}
