// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/CarryingMethod.h"

#include "Kernel/Deformation/AsRigidAsPossibleDeformer.h"
#include "Kernel/Deformation/LaplacianDeformer.h"
#include "Kernel/Deformation/MultiresolutionDeformer.h"
#include "Kernel/Deformation/PoissonDeformer.h"
#include "Kernel/Deformation/PyramidDeformer.h"
#include "Kernel/Deformation/RotationInvariantDeformer.h"
#include "Kernel/Deformation/ShapePreservingDeformer.h"
#include "Kernel/Deformation/SimilarityDeformer.h"

namespace cartan
{
std::unique_ptr<SurfaceDeformer> NewCarryingDeformer(CarryingMethod method,
  bool constrainTransforms, const HandleProblem& problem, SolverBackend backend,
  const ExecutionContext& context)
{
  switch (method)
  {
    case CarryingMethod::ShapePreserving:
      return std::make_unique<ShapePreservingDeformer>(problem, backend, context);
    case CarryingMethod::Similarity:
    {
      SimilarityDeformer::Options options;
      options.ConstrainTransforms = constrainTransforms;
      return std::make_unique<SimilarityDeformer>(problem, options, backend, context);
    }
    case CarryingMethod::Laplacian:
      return std::make_unique<LaplacianDeformer>(
        problem, LaplacianRotations::Estimated, backend, context);
    case CarryingMethod::Multiresolution:
      return std::make_unique<MultiresolutionDeformer>(problem, 2, backend, context);
    case CarryingMethod::Poisson:
      return std::make_unique<PoissonDeformer>(problem, Propagation::Harmonic, backend, context);
    case CarryingMethod::AsRigidAsPossible:
      return std::make_unique<AsRigidAsPossibleDeformer>(
        problem, RigidityEnergy::Spokes, InitialGuess::ShapePreserving, backend, context);
    case CarryingMethod::Pyramid:
      return std::make_unique<PyramidDeformer>(
        problem, InitialGuess::ShapePreserving, backend, context);
    default:
      return std::make_unique<RotationInvariantDeformer>(problem, backend, context);
  }
}
}
