// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPoissonDeformation.h"

#include "Bridge/DeformationMethod.h"
#include "Kernel/Deformation/PoissonDeformer.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkPoissonDeformation);

void vtkPoissonDeformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Propagation: " << this->Propagation << "\n";
}

void vtkPoissonDeformation::AddSettings(cartan::ContentKey& settings) const
{
  this->Superclass::AddSettings(settings);
  settings.Add(static_cast<std::uint64_t>(this->Propagation));
}

void vtkPoissonDeformation::RequireTargets(const cartan::HandleTargets& targets) const
{
  cartan::PoissonDeformer::RequireMotions(targets);
}

cartan::DeformationMethod vtkPoissonDeformation::NewFrameMethod(
  const cartan::HandleProblem& problem, cartan::SolverBackend backend,
  const cartan::ExecutionContext& context)
{
  static_assert(static_cast<int>(cartan::Propagation::Harmonic) == HARMONIC &&
      static_cast<int>(cartan::Propagation::Geodesic) == GEODESIC,
    "the enumerations agree");
  return this->FrameMethod(std::make_unique<cartan::PoissonDeformer>(
    problem, static_cast<cartan::Propagation>(this->Propagation), backend, context));
}
