// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Deformation/AsRigidAsPossibleDeformer.h"
#include "Kernel/Deformation/LaplacianDeformer.h"
#include "Kernel/Deformation/MultiresolutionDeformer.h"
#include "Kernel/Deformation/PoissonDeformer.h"
#include "Kernel/Deformation/PyramidDeformer.h"
#include "Kernel/Deformation/RotationInvariantDeformer.h"
#include "Kernel/Deformation/ShapePreservingDeformer.h"
#include "Kernel/Deformation/SimilarityDeformer.h"

#include <functional>
#include <map>
#include <memory>
#include <string>

/// Every deformation method in each of its kinds, for laws that hold for all.
namespace deformers
{
using MakeDeformer = std::function<std::unique_ptr<cartan::SurfaceDeformer>(
  const cartan::HandleProblem&, const cartan::ExecutionContext&)>;

template <typename Deformer, typename... Options>
MakeDeformer Maker(cartan::SolverBackend backend, Options... options)
{
  return [=](const cartan::HandleProblem& problem, const cartan::ExecutionContext& context)
  { return std::make_unique<Deformer>(problem, options..., backend, context); };
}

inline MakeDeformer SimilarityMaker(cartan::SolverBackend backend,
  cartan::SimilarityReconstruction reconstruction, bool constrainTransforms, int refits)
{
  return [=](const cartan::HandleProblem& problem, const cartan::ExecutionContext& context)
  {
    cartan::SimilarityDeformer::Options options;
    options.ConstrainTransforms = constrainTransforms;
    auto deformer = std::make_unique<cartan::SimilarityDeformer>(
      problem, options, backend, context.Part(0.0, 0.5));
    deformer->SetReconstruction(reconstruction);
    deformer->SetRefits(refits);
    deformer->Prepare(context.Part(0.5, 1.0));
    return deformer;
  };
}

/// By name.
inline std::map<std::string, MakeDeformer> All(
  cartan::SolverBackend backend = cartan::SolverBackend::Automatic)
{
  using namespace cartan;
  std::map<std::string, MakeDeformer> makers;
  makers["RotationInvariant"] = Maker<RotationInvariantDeformer>(backend);
  makers["ShapePreserving"] = Maker<ShapePreservingDeformer>(backend);
  makers["PoissonHarmonic"] = Maker<PoissonDeformer>(backend, Propagation::Harmonic);
  makers["PoissonGeodesic"] = Maker<PoissonDeformer>(backend, Propagation::Geodesic);
  makers["LaplacianNone"] = Maker<LaplacianDeformer>(backend, LaplacianRotations::None);
  makers["LaplacianEstimated"] = Maker<LaplacianDeformer>(backend, LaplacianRotations::Estimated);
  makers["LaplacianImplicit"] = Maker<LaplacianDeformer>(backend, LaplacianRotations::Implicit);
  for (int order = 1; order <= 3; ++order)
  {
    makers["Multiresolution" + std::to_string(order)] =
      Maker<MultiresolutionDeformer>(backend, order);
  }
  makers["Spokes"] = Maker<AsRigidAsPossibleDeformer>(
    backend, RigidityEnergy::Spokes, InitialGuess::ShapePreserving);
  makers["SpokesAndRims"] = Maker<AsRigidAsPossibleDeformer>(
    backend, RigidityEnergy::SpokesAndRims, InitialGuess::RotationInvariant);
  makers["SmoothedRotations"] = Maker<AsRigidAsPossibleDeformer>(
    backend, RigidityEnergy::SmoothedRotations, InitialGuess::RestShape);
  makers["Pyramid"] = Maker<PyramidDeformer>(backend, InitialGuess::ShapePreserving);
  makers["SimilarityEdgeForm"] =
    SimilarityMaker(backend, SimilarityReconstruction::EdgeForm, true, 3);
  makers["SimilarityLeastSquares"] =
    SimilarityMaker(backend, SimilarityReconstruction::LeastSquares, true, 2);
  makers["SimilarityAffine"] = SimilarityMaker(backend, SimilarityReconstruction::Affine, true, 0);
  makers["SimilarityOfPositions"] =
    SimilarityMaker(backend, SimilarityReconstruction::EdgeForm, false, 0);
  return makers;
}
}
