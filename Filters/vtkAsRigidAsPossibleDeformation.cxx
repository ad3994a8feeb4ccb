// SPDX-License-Identifier: BSD-3-Clause
#include "vtkAsRigidAsPossibleDeformation.h"

#include "Kernel/Deformation/AsRigidAsPossibleDeformer.h"
#include "KernelBridge.h"

#include "vtkObjectFactory.h"

#include <algorithm>

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
  os << indent << "Converged: " << this->Converged << "\n";
}

void vtkAsRigidAsPossibleDeformation::SetEnergy(int energy)
{
  energy = std::min(std::max<int>(energy, SPOKES), static_cast<int>(SMOOTHED_ROTATIONS));
  if (energy != this->Energy)
  {
    this->Energy = energy;
    this->ForgetDeformers();
    this->Modified();
  }
}

void vtkAsRigidAsPossibleDeformation::SetInitialGuess(int guess)
{
  guess = std::min(std::max<int>(guess, REST_SHAPE), static_cast<int>(SHAPE_PRESERVING));
  if (guess != this->InitialGuess)
  {
    this->InitialGuess = guess;
    this->ForgetDeformers();
    this->Modified();
  }
}

std::unique_ptr<cartan::SurfaceDeformer> vtkAsRigidAsPossibleDeformation::NewDeformer(
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
  return std::make_unique<cartan::AsRigidAsPossibleDeformer>(problem,
    static_cast<cartan::RigidityEnergy>(this->Energy),
    static_cast<cartan::InitialGuess>(this->InitialGuess), backend, context);
}

void vtkAsRigidAsPossibleDeformation::ConfigureDeformer(
  cartan::SurfaceDeformer& deformer, const cartan::ExecutionContext&)
{
  auto& rigid = static_cast<cartan::AsRigidAsPossibleDeformer&>(deformer);
  rigid.SetBending(this->Bending);
  rigid.SetIteration(this->MaximumIterations, this->Tolerance);
}

void vtkAsRigidAsPossibleDeformation::DecorateOutput(const cartan::HandleProblem&,
  cartan::SurfaceDeformer& deformer, const cartan::DeformedSurface&, vtkPolyData* output,
  const cartan::ExecutionContext&)
{
  const auto& rigid = static_cast<const cartan::AsRigidAsPossibleDeformer&>(deformer);
  this->NumberOfIterations = rigid.GetNumberOfIterations();
  this->InitialEnergy = rigid.GetEnergies().front();
  this->FinalEnergy = rigid.GetEnergies().back();
  this->Converged = rigid.HasConverged();
  if (this->GenerateRigidityEnergy)
  {
    const Eigen::VectorXd shares = rigid.GetVertexEnergies();
    cartan::AddPointArray(output, "RigidityEnergy", shares.data(), shares.size(), 1);
  }
}
