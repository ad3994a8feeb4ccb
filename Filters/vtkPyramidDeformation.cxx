// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPyramidDeformation.h"

#include "Bridge/DeformationMethod.h"
#include "Bridge/PointArrays.h"
#include "Kernel/Deformation/PyramidDeformer.h"

#include "vtkObjectFactory.h"

#include <cmath>

vtkStandardNewMacro(vtkPyramidDeformation);

void vtkPyramidDeformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "InitialGuess: " << this->InitialGuess << "\n";
  os << indent << "MaximumIterations: " << this->MaximumIterations << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "GeneratePyramidEnergy: " << this->GeneratePyramidEnergy << "\n";
  os << indent << "NumberOfIterations: " << this->NumberOfIterations << "\n";
  os << indent << "InitialEnergy: " << this->InitialEnergy << "\n";
  os << indent << "FinalEnergy: " << this->FinalEnergy << "\n";
  os << indent << "Converged: " << this->Converged << "\n";
}

void vtkPyramidDeformation::ForgetResults()
{
  this->Superclass::ForgetResults();
  this->NumberOfIterations = 0;
  this->InitialEnergy = 0.0;
  this->FinalEnergy = 0.0;
  this->Converged = false;
}

void vtkPyramidDeformation::AddSettings(cartan::ContentKey& settings) const
{
  this->Superclass::AddSettings(settings);
  settings.Add(static_cast<std::uint64_t>(this->InitialGuess));
}

cartan::DeformationMethod vtkPyramidDeformation::NewMethod(const cartan::HandleProblem& problem,
  cartan::SolverBackend backend, const cartan::ExecutionContext& context)
{
  static_assert(static_cast<int>(cartan::InitialGuess::RestShape) == REST_SHAPE &&
      static_cast<int>(cartan::InitialGuess::PreviousResult) == PREVIOUS_RESULT &&
      static_cast<int>(cartan::InitialGuess::RotationInvariant) == ROTATION_INVARIANT &&
      static_cast<int>(cartan::InitialGuess::ShapePreserving) == SHAPE_PRESERVING,
    "the enumerations agree");
  auto deformer = std::make_unique<cartan::PyramidDeformer>(
    problem, static_cast<cartan::InitialGuess>(this->InitialGuess), backend, context);
  auto* pyramids = deformer.get();
  cartan::DeformationMethod method;
  method.Deformer = std::move(deformer);
  method.Configure = [this, pyramids](cartan::FilterRun&, const cartan::ExecutionContext&)
  { pyramids->SetIteration(this->MaximumIterations, this->Tolerance); };
  method.Decorate = [this, pyramids](const cartan::DeformedSurface&, cartan::FilterRun& run)
  {
    this->NumberOfIterations = pyramids->GetNumberOfIterations();
    this->InitialEnergy = pyramids->GetEnergies().front();
    this->FinalEnergy = pyramids->GetEnergies().back();
    this->Converged = pyramids->HasConverged();
    if (!std::isfinite(this->FinalEnergy))
    {
      throw cartan::Error(cartan::ErrorCode::BadInput,
        "The pyramid energy is outside the range of double precision: use smaller motions.");
    }
    if (this->GeneratePyramidEnergy)
    {
      cartan::AddPointArray(run.Output(), "PyramidEnergy", pyramids->GetVertexEnergies());
    }
  };
  return method;
}
