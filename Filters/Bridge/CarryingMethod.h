// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Deformation/SurfaceDeformer.h"

#include <memory>

/// Private to the filters, not installed.
namespace cartan
{
/// A method that carries what another filter leaves open, with the defaults of its own filter,
/// but without volume correction. The numbers are those of the filters' enumerations.
enum class CarryingMethod
{
  RotationInvariant = 0,
  ShapePreserving = 1,
  Similarity = 2,
  Laplacian = 3, ///< estimated rotations
  Multiresolution = 4,
  Poisson = 5,           ///< harmonic
  AsRigidAsPossible = 6, ///< spokes
  Pyramid = 7
};

/// Throws what its constructor throws. `constrainTransforms`: whether Similarity takes the
/// transforms of handles, too; of the others only Laplacian never does.
std::unique_ptr<SurfaceDeformer> NewCarryingDeformer(CarryingMethod method,
  bool constrainTransforms, const HandleProblem& problem, SolverBackend backend,
  const ExecutionContext& context);
}
