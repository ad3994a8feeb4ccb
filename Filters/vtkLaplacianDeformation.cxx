// SPDX-License-Identifier: BSD-3-Clause
#include "vtkLaplacianDeformation.h"

#include "Kernel/Deformation/LaplacianDeformer.h"

#include "vtkObjectFactory.h"

#include <algorithm>

vtkStandardNewMacro(vtkLaplacianDeformation);

void vtkLaplacianDeformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Rotations: " << this->Rotations << "\n";
  os << indent << "Rounds: " << this->Rounds << "\n";
}

void vtkLaplacianDeformation::SetRotations(int rotations)
{
  rotations = std::min(std::max<int>(rotations, NO_ROTATIONS), static_cast<int>(IMPLICIT));
  if (rotations != this->Rotations)
  {
    this->Rotations = rotations;
    this->ForgetDeformers();
    this->Modified();
  }
}

std::unique_ptr<cartan::SurfaceDeformer> vtkLaplacianDeformation::NewDeformer(
  const cartan::HandleProblem& problem, cartan::SolverBackend backend,
  const cartan::ExecutionContext& context)
{
  static_assert(static_cast<int>(cartan::LaplacianRotations::None) == NO_ROTATIONS &&
      static_cast<int>(cartan::LaplacianRotations::Estimated) == ESTIMATED &&
      static_cast<int>(cartan::LaplacianRotations::Implicit) == IMPLICIT,
    "the enumerations agree");
  return std::make_unique<cartan::LaplacianDeformer>(
    problem, static_cast<cartan::LaplacianRotations>(this->Rotations), backend, context);
}

void vtkLaplacianDeformation::ConfigureDeformer(
  cartan::SurfaceDeformer& deformer, const cartan::ExecutionContext&)
{
  static_cast<cartan::LaplacianDeformer&>(deformer).SetRounds(this->Rounds);
}
