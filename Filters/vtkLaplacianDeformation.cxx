// SPDX-License-Identifier: BSD-3-Clause
#include "vtkLaplacianDeformation.h"

#include "Bridge/DeformationMethod.h"
#include "Kernel/Deformation/LaplacianDeformer.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkLaplacianDeformation);

void vtkLaplacianDeformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Rotations: " << this->Rotations << "\n";
  os << indent << "Rounds: " << this->Rounds << "\n";
}

void vtkLaplacianDeformation::AddSettings(cartan::ContentKey& settings) const
{
  this->Superclass::AddSettings(settings);
  settings.Add(static_cast<std::uint64_t>(this->Rotations));
}

cartan::DeformationMethod vtkLaplacianDeformation::NewMethod(const cartan::HandleProblem& problem,
  cartan::SolverBackend backend, const cartan::ExecutionContext& context)
{
  static_assert(static_cast<int>(cartan::LaplacianRotations::None) == NO_ROTATIONS &&
      static_cast<int>(cartan::LaplacianRotations::Estimated) == ESTIMATED &&
      static_cast<int>(cartan::LaplacianRotations::Implicit) == IMPLICIT,
    "the enumerations agree");
  auto deformer = std::make_unique<cartan::LaplacianDeformer>(
    problem, static_cast<cartan::LaplacianRotations>(this->Rotations), backend, context);
  auto* laplacian = deformer.get();
  cartan::DeformationMethod method;
  method.Deformer = std::move(deformer);
  method.Configure = [this, laplacian](cartan::FilterRun&, const cartan::ExecutionContext&)
  { laplacian->SetRounds(this->Rounds); };
  return method;
}
