// SPDX-License-Identifier: BSD-3-Clause
#include "vtkRotationInvariantDeformation.h"

#include "Bridge/DeformationMethod.h"
#include "Kernel/Deformation/RotationInvariantDeformer.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkRotationInvariantDeformation);

void vtkRotationInvariantDeformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FrameProjection: " << this->FrameProjection << "\n";
}

cartan::DeformationMethod vtkRotationInvariantDeformation::NewFrameMethod(
  const cartan::HandleProblem& problem, cartan::SolverBackend backend,
  const cartan::ExecutionContext& context)
{
  static_assert(static_cast<int>(cartan::FrameProjection::Automatic) == AUTOMATIC &&
      static_cast<int>(cartan::FrameProjection::None) == NONE &&
      static_cast<int>(cartan::FrameProjection::Rotation) == ROTATION,
    "the enumerations agree");
  auto deformer = std::make_unique<cartan::RotationInvariantDeformer>(problem, backend, context);
  auto* frames = deformer.get();
  cartan::DeformationMethod method = this->FrameMethod(std::move(deformer));
  method.Configure = [this, frames, correct = std::move(method.Configure)](
                       cartan::FilterRun& run, const cartan::ExecutionContext& part)
  {
    correct(run, part);
    frames->SetFrameProjection(static_cast<cartan::FrameProjection>(this->FrameProjection));
  };
  return method;
}
