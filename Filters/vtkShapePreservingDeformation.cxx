// SPDX-License-Identifier: BSD-3-Clause
#include "vtkShapePreservingDeformation.h"

#include "Bridge/DeformationMethod.h"
#include "Kernel/Deformation/ShapePreservingDeformer.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkShapePreservingDeformation);

vtkShapePreservingDeformation::vtkShapePreservingDeformation()
{
  this->SetVolumeCorrection(NEUTRAL_OFFSET);
}

void vtkShapePreservingDeformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MaximumIterations: " << this->MaximumIterations << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "SharedAxis: " << this->SharedAxis << "\n";
  os << indent << "NumberOfIterations: " << this->NumberOfIterations << "\n";
  os << indent << "Residual: " << this->Residual << "\n";
  os << indent << "Converged: " << this->Converged << "\n";
}

void vtkShapePreservingDeformation::ForgetResults()
{
  this->Superclass::ForgetResults();
  this->SharedAxis = true;
  this->NumberOfIterations = 0;
  this->Residual = 0.0;
  this->Converged = true;
}

cartan::DeformationMethod vtkShapePreservingDeformation::NewFrameMethod(
  const cartan::HandleProblem& problem, cartan::SolverBackend backend,
  const cartan::ExecutionContext& context)
{
  auto deformer = std::make_unique<cartan::ShapePreservingDeformer>(problem, backend, context);
  auto* shape = deformer.get();
  cartan::DeformationMethod method = this->FrameMethod(std::move(deformer));
  method.Configure = [this, shape, correct = std::move(method.Configure)](
                       cartan::FilterRun& run, const cartan::ExecutionContext& part)
  {
    correct(run, part);
    shape->SetIteration(this->MaximumIterations, this->Tolerance);
  };
  method.Decorate = [this, shape, decorate = std::move(method.Decorate)](
                      const cartan::DeformedSurface& result, cartan::FilterRun& run)
  {
    this->SharedAxis = shape->HasSharedAxis();
    this->NumberOfIterations = shape->GetNumberOfIterations();
    this->Residual = shape->GetResidual();
    this->Converged = shape->HasConverged();
    decorate(result, run);
  };
  return method;
}
