// SPDX-License-Identifier: BSD-3-Clause
#include "vtkShapePreservingDeformation.h"

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

std::unique_ptr<cartan::SurfaceDeformer> vtkShapePreservingDeformation::NewFrameDeformer(
  const cartan::HandleProblem& problem, cartan::SolverBackend backend,
  const cartan::ExecutionContext& context)
{
  return std::make_unique<cartan::ShapePreservingDeformer>(problem, backend, context);
}

void vtkShapePreservingDeformation::ConfigureDeformer(
  cartan::SurfaceDeformer& deformer, const cartan::ExecutionContext& context)
{
  this->Superclass::ConfigureDeformer(deformer, context);
  static_cast<cartan::ShapePreservingDeformer&>(deformer).SetIteration(
    this->MaximumIterations, this->Tolerance);
}

void vtkShapePreservingDeformation::DecorateOutput(const cartan::HandleProblem& problem,
  cartan::SurfaceDeformer& deformer, const cartan::DeformedSurface& result, vtkPolyData* output,
  const cartan::ExecutionContext& context)
{
  const auto& shape = static_cast<cartan::ShapePreservingDeformer&>(deformer);
  this->SharedAxis = shape.HasSharedAxis();
  this->NumberOfIterations = shape.GetNumberOfIterations();
  this->Residual = shape.GetResidual();
  this->Converged = shape.HasConverged();
  this->Superclass::DecorateOutput(problem, deformer, result, output, context);
}
