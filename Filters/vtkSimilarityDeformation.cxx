// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSimilarityDeformation.h"

#include "Kernel/Deformation/SimilarityDeformer.h"
#include "KernelBridge.h"

#include "vtkObjectFactory.h"

#include <algorithm>

vtkStandardNewMacro(vtkSimilarityDeformation);

void vtkSimilarityDeformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ScaleFeatures: " << this->ScaleFeatures << "\n";
  os << indent << "CoherenceRings: " << this->CoherenceRings << "\n";
  os << indent << "ConstrainHandleTransforms: " << this->ConstrainHandleTransforms << "\n";
  os << indent << "Reconstruction: " << this->Reconstruction << "\n";
  os << indent << "Refits: " << this->Refits << "\n";
  os << indent << "GenerateScaleFactor: " << this->GenerateScaleFactor << "\n";
  os << indent << "NumberOfDisplacedPoints: " << this->NumberOfDisplacedPoints << "\n";
}

void vtkSimilarityDeformation::SetCoherenceRings(int rings)
{
  rings = std::min(std::max(rings, 1), 2);
  if (rings != this->CoherenceRings)
  {
    this->CoherenceRings = rings;
    this->ForgetDeformers();
    this->Modified();
  }
}

void vtkSimilarityDeformation::SetConstrainHandleTransforms(bool constrain)
{
  if (constrain != this->ConstrainHandleTransforms)
  {
    this->ConstrainHandleTransforms = constrain;
    this->ForgetDeformers();
    this->Modified();
  }
}

std::unique_ptr<cartan::SurfaceDeformer> vtkSimilarityDeformation::NewDeformer(
  const cartan::HandleProblem& problem, cartan::SolverBackend backend,
  const cartan::ExecutionContext& context)
{
  cartan::SimilarityDeformer::Options options;
  options.CoherenceRings = this->CoherenceRings;
  options.ConstrainTransforms = this->ConstrainHandleTransforms;
  auto deformer =
    std::make_unique<cartan::SimilarityDeformer>(problem, options, backend, context.Part(0.0, 0.7));
  // The other factorizations belong to the set-up, not to the first motion.
  deformer->SetReconstruction(static_cast<cartan::SimilarityReconstruction>(this->Reconstruction));
  deformer->SetRefits(this->Refits);
  deformer->Prepare(context.Part(0.7, 1.0));
  return deformer;
}

void vtkSimilarityDeformation::ConfigureDeformer(
  cartan::SurfaceDeformer& deformer, const cartan::ExecutionContext&)
{
  static_assert(static_cast<int>(cartan::SimilarityReconstruction::Affine) == AFFINE &&
      static_cast<int>(cartan::SimilarityReconstruction::LeastSquares) == LEAST_SQUARES &&
      static_cast<int>(cartan::SimilarityReconstruction::EdgeForm) == EDGE_FORM,
    "the enumerations agree");
  auto& similarity = static_cast<cartan::SimilarityDeformer&>(deformer);
  similarity.SetReconstruction(static_cast<cartan::SimilarityReconstruction>(this->Reconstruction));
  similarity.SetScaleFeatures(this->ScaleFeatures);
  similarity.SetRefits(this->Refits);
}

void vtkSimilarityDeformation::DecorateOutput(const cartan::HandleProblem&,
  cartan::SurfaceDeformer& deformer, const cartan::DeformedSurface&, vtkPolyData* output,
  const cartan::ExecutionContext&)
{
  const auto& similarity = static_cast<const cartan::SimilarityDeformer&>(deformer);
  this->NumberOfDisplacedPoints = similarity.GetNumberOfDisplacedVertices();
  if (this->GenerateScaleFactor)
  {
    const Eigen::VectorXd& scales = similarity.GetScaleFactors();
    cartan::AddPointArray(output, "ScaleFactor", scales.data(), scales.size(), 1);
  }
}
