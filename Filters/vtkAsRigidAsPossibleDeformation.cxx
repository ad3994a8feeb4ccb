// SPDX-License-Identifier: BSD-3-Clause
#include "vtkAsRigidAsPossibleDeformation.h"

#include "Bridge/DeformationMethod.h"
#include "Bridge/PointArrays.h"
#include "Kernel/Deformation/AsRigidAsPossibleDeformer.h"

#include "vtkObjectFactory.h"

#include <cmath>

vtkStandardNewMacro(vtkAsRigidAsPossibleDeformation);

void vtkAsRigidAsPossibleDeformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Energy: " << this->Energy << "\n";
  os << indent << "Bending: " << this->Bending << "\n";
  os << indent << "InitialGuess: " << this->InitialGuess << "\n";
  os << indent << "MaximumIterations: " << this->MaximumIterations << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "GenerateRigidityEnergy: " << this->GenerateRigidityEnergy << "\n";
  os << indent << "NumberOfIterations: " << this->NumberOfIterations << "\n";
  os << indent << "InitialEnergy: " << this->InitialEnergy << "\n";
  os << indent << "FinalEnergy: " << this->FinalEnergy << "\n";
  os << indent << "Residual: " << this->Residual << "\n";
  os << indent << "Converged: " << this->Converged << "\n";
}

void vtkAsRigidAsPossibleDeformation::ForgetResults()
{
  this->Superclass::ForgetResults();
  this->NumberOfIterations = 0;
  this->InitialEnergy = 0.0;
  this->FinalEnergy = 0.0;
  this->Residual = 0.0;
  this->Converged = false;
}

void vtkAsRigidAsPossibleDeformation::AddSettings(cartan::ContentKey& settings) const
{
  this->Superclass::AddSettings(settings);
  settings.Add(static_cast<std::uint64_t>(this->Energy));
  settings.Add(static_cast<std::uint64_t>(this->InitialGuess));
}

cartan::DeformationMethod vtkAsRigidAsPossibleDeformation::NewMethod(
  const cartan::HandleProblem& problem, cartan::SolverBackend backend,
  const cartan::ExecutionContext& context)
{
  static_assert(static_cast<int>(cartan::RigidityEnergy::Spokes) == SPOKES &&
      static_cast<int>(cartan::RigidityEnergy::SpokesAndRims) == SPOKES_AND_RIMS &&
      static_cast<int>(cartan::RigidityEnergy::SmoothedRotations) == SMOOTHED_ROTATIONS &&
      static_cast<int>(cartan::InitialGuess::RestShape) == REST_SHAPE &&
      static_cast<int>(cartan::InitialGuess::PreviousResult) == PREVIOUS_RESULT &&
      static_cast<int>(cartan::InitialGuess::RotationInvariant) == ROTATION_INVARIANT &&
      static_cast<int>(cartan::InitialGuess::ShapePreserving) == SHAPE_PRESERVING,
    "the enumerations agree");
  auto deformer = std::make_unique<cartan::AsRigidAsPossibleDeformer>(problem,
    static_cast<cartan::RigidityEnergy>(this->Energy),
    static_cast<cartan::InitialGuess>(this->InitialGuess), backend, context);
  auto* rigid = deformer.get();
  cartan::DeformationMethod method;
  method.Deformer = std::move(deformer);
  method.Configure = [this, rigid](cartan::FilterRun&, const cartan::ExecutionContext&)
  {
    rigid->SetBending(this->Bending);
    rigid->SetIteration(this->MaximumIterations, this->Tolerance);
  };
  method.Decorate = [this, rigid](const cartan::DeformedSurface&, cartan::FilterRun& run)
  {
    this->NumberOfIterations = rigid->GetNumberOfIterations();
    this->InitialEnergy = rigid->GetEnergies().front();
    this->FinalEnergy = rigid->GetEnergies().back();
    this->Residual = rigid->GetResidual();
    this->Converged = rigid->HasConverged();
    if (!std::isfinite(this->FinalEnergy))
    {
      throw cartan::Error(cartan::ErrorCode::BadInput,
        "The rigidity energy is outside the range of double precision: use smaller motions.");
    }
    if (this->GenerateRigidityEnergy)
    {
      cartan::AddPointArray(run.Output(), "RigidityEnergy", rigid->GetVertexEnergies());
    }
  };
  return method;
}
