// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Deformation/FrameDeformer.h"

#include <memory>

namespace cartan
{
/// Where a nonlinear method starts.
enum class InitialGuess
{
  RestShape,         ///< only the handles moved
  PreviousResult,    ///< that of the last motion; of the first, ShapePreserving
  RotationInvariant, ///< RotationInvariantDeformer
  ShapePreserving    ///< ShapePreservingDeformer, which knows full turns
};

/// The linear method of a guess; also where there is none, for its position system serves
/// the steps from the guess too. HandleProblem::PositionWeights are those of its frames.
std::unique_ptr<FrameDeformer> MakeInitialGuess(HandleProblem problem, InitialGuess guess,
  SolverBackend backend, const ExecutionContext& context);
}
