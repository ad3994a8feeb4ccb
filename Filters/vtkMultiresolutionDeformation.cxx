// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMultiresolutionDeformation.h"

#include "Kernel/Deformation/MultiresolutionDeformer.h"

#include "vtkObjectFactory.h"

#include <algorithm>

vtkStandardNewMacro(vtkMultiresolutionDeformation);

void vtkMultiresolutionDeformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Smoothness: " << this->Smoothness << "\n";
}

void vtkMultiresolutionDeformation::SetSmoothness(int smoothness)
{
  smoothness = std::min(std::max(smoothness, 1), 3);
  if (smoothness != this->Smoothness)
  {
    this->Smoothness = smoothness;
    this->ForgetDeformers();
    this->Modified();
  }
}

std::unique_ptr<cartan::SurfaceDeformer> vtkMultiresolutionDeformation::NewDeformer(
  const cartan::HandleProblem& problem, cartan::SolverBackend backend,
  const cartan::ExecutionContext& context)
{
  return std::make_unique<cartan::MultiresolutionDeformer>(
    problem, this->Smoothness, backend, context);
}
