// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSimilarityDeformation.h"

#include "Bridge/DeformationMethod.h"
#include "Bridge/PointArrays.h"
#include "Kernel/Deformation/SimilarityDeformer.h"

#include "vtkObjectFactory.h"

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
  os << indent << "NumberOfFlatPoints: " << this->NumberOfFlatPoints << "\n";
}

void vtkSimilarityDeformation::ForgetResults()
{
  this->Superclass::ForgetResults();
  this->NumberOfFlatPoints = 0;
}

void vtkSimilarityDeformation::AddSettings(cartan::ContentKey& settings) const
{
  this->Superclass::AddSettings(settings);
  settings.Add(static_cast<std::uint64_t>(this->CoherenceRings));
  settings.Add(static_cast<std::uint64_t>(this->ConstrainHandleTransforms));
}

cartan::DeformationMethod vtkSimilarityDeformation::NewMethod(const cartan::HandleProblem& problem,
  cartan::SolverBackend backend, const cartan::ExecutionContext& context)
{
  static_assert(static_cast<int>(cartan::SimilarityReconstruction::Affine) == AFFINE &&
      static_cast<int>(cartan::SimilarityReconstruction::LeastSquares) == LEAST_SQUARES &&
      static_cast<int>(cartan::SimilarityReconstruction::EdgeForm) == EDGE_FORM,
    "the enumerations agree");
  cartan::SimilarityDeformer::Options options;
  options.CoherenceRings = this->CoherenceRings;
  options.ConstrainTransforms = this->ConstrainHandleTransforms;
  auto deformer =
    std::make_unique<cartan::SimilarityDeformer>(problem, options, backend, context.Part(0.0, 0.7));
  auto* similarity = deformer.get();
  // The other factorizations belong to the set-up, not to the first motion.
  similarity->SetReconstruction(
    static_cast<cartan::SimilarityReconstruction>(this->Reconstruction));
  similarity->SetRefits(this->Refits);
  similarity->Prepare(context.Part(0.7, 1.0));
  cartan::DeformationMethod method;
  method.Deformer = std::move(deformer);
  method.Configure = [this, similarity](cartan::FilterRun&, const cartan::ExecutionContext&)
  {
    similarity->SetReconstruction(
      static_cast<cartan::SimilarityReconstruction>(this->Reconstruction));
    similarity->SetScaleFeatures(this->ScaleFeatures);
    similarity->SetRefits(this->Refits);
  };
  method.Decorate = [this, similarity](const cartan::DeformedSurface&, cartan::FilterRun& run)
  {
    this->NumberOfFlatPoints = similarity->GetNumberOfFlatVertices();
    if (this->GenerateScaleFactor)
    {
      cartan::AddPointArray(run.Output(), "ScaleFactor", similarity->GetScaleFactors());
    }
  };
  return method;
}
