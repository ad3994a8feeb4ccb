// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPoissonDeformation.h"

#include "Kernel/Deformation/PoissonDeformer.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkPoissonDeformation);

void vtkPoissonDeformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Propagation: " << this->Propagation << "\n";
}

void vtkPoissonDeformation::SetPropagation(int propagation)
{
  propagation = propagation <= HARMONIC ? HARMONIC : GEODESIC;
  if (propagation != this->Propagation)
  {
    this->Propagation = propagation;
    this->ForgetDeformers();
    this->Modified();
  }
}

std::unique_ptr<cartan::SurfaceDeformer> vtkPoissonDeformation::NewFrameDeformer(
  const cartan::HandleProblem& problem, cartan::SolverBackend backend,
  const cartan::ExecutionContext& context)
{
  static_assert(static_cast<int>(cartan::Propagation::Harmonic) == HARMONIC &&
      static_cast<int>(cartan::Propagation::Geodesic) == GEODESIC,
    "the enumerations agree");
  return std::make_unique<cartan::PoissonDeformer>(
    problem, static_cast<cartan::Propagation>(this->Propagation), backend, context);
}
