// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/InitialGuess.h"

#include "Deformation/RotationInvariantDeformer.h"
#include "Deformation/ShapePreservingDeformer.h"

namespace cartan
{
std::unique_ptr<FrameDeformer> MakeInitialGuess(
  HandleProblem problem, InitialGuess guess, SolverBackend backend, const ExecutionContext& context)
{
  problem.Weights = problem.PositionWeights;
  if (guess == InitialGuess::RotationInvariant)
  {
    return std::make_unique<RotationInvariantDeformer>(std::move(problem), backend, context);
  }
  return std::make_unique<ShapePreservingDeformer>(std::move(problem), backend, context);
}
}
