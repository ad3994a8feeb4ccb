// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMultiresolutionDeformation.h"

#include "Bridge/DeformationMethod.h"
#include "Kernel/Deformation/MultiresolutionDeformer.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkMultiresolutionDeformation);

void vtkMultiresolutionDeformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Smoothness: " << this->Smoothness << "\n";
}

void vtkMultiresolutionDeformation::AddSettings(cartan::ContentKey& settings) const
{
  this->Superclass::AddSettings(settings);
  settings.Add(static_cast<std::uint64_t>(this->Smoothness));
}

cartan::DeformationMethod vtkMultiresolutionDeformation::NewMethod(
  const cartan::HandleProblem& problem, cartan::SolverBackend backend,
  const cartan::ExecutionContext& context)
{
  cartan::DeformationMethod method;
  method.Deformer =
    std::make_unique<cartan::MultiresolutionDeformer>(problem, this->Smoothness, backend, context);
  return method;
}
