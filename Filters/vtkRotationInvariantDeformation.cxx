// SPDX-License-Identifier: BSD-3-Clause
#include "vtkRotationInvariantDeformation.h"

#include "Kernel/Deformation/RotationInvariantDeformer.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkRotationInvariantDeformation);

void vtkRotationInvariantDeformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FrameProjection: " << this->FrameProjection << "\n";
}

std::unique_ptr<cartan::SurfaceDeformer> vtkRotationInvariantDeformation::NewFrameDeformer(
  const cartan::HandleProblem& problem, cartan::SolverBackend backend,
  const cartan::ExecutionContext& context)
{
  return std::make_unique<cartan::RotationInvariantDeformer>(problem, backend, context);
}

void vtkRotationInvariantDeformation::ConfigureDeformer(
  cartan::SurfaceDeformer& deformer, const cartan::ExecutionContext& context)
{
  this->Superclass::ConfigureDeformer(deformer, context);
  static_assert(static_cast<int>(cartan::FrameProjection::Automatic) == AUTOMATIC &&
      static_cast<int>(cartan::FrameProjection::None) == NONE &&
      static_cast<int>(cartan::FrameProjection::Rotation) == ROTATION,
    "the enumerations agree");
  static_cast<cartan::RotationInvariantDeformer&>(deformer).SetFrameProjection(
    static_cast<cartan::FrameProjection>(this->FrameProjection));
}
