// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceFilter.h"

#include "Bridge/FilterRun.h"

#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkPolyData.h"

namespace
{
constexpr double Megabyte = 1e6;
}

vtkSurfaceFilter::vtkSurfaceFilter()
  : Kept(std::make_unique<cartan::KeptResults>())
{
}

vtkSurfaceFilter::~vtkSurfaceFilter() = default;

void vtkSurfaceFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "PrepareInput: " << this->PrepareInput << "\n";
  os << indent << "KeptMemoryLimit: " << this->KeptMemoryLimit << "\n";
  os << indent << "KeptMemory: " << this->GetKeptMemory() << "\n";
}

double vtkSurfaceFilter::GetKeptMemory() const
{
  return static_cast<double>(this->Kept->GetBytes()) / Megabyte;
}

void vtkSurfaceFilter::ReleaseKeptMemory()
{
  this->Kept->Clear();
}

int vtkSurfaceFilter::SetPortType(vtkInformation* info, const char* className, bool isOptional)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), className);
  if (isOptional)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

int vtkSurfaceFilter::SetOutputType(vtkInformation* info, const char* className)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), className);
  return 1;
}

void vtkSurfaceFilter::EmptyOutputs()
{
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    if (vtkDataObject* output = this->GetOutputDataObject(port))
    {
      output->Initialize();
    }
  }
}

void vtkSurfaceFilter::UsePreparedInput(cartan::FilterRun& run) const
{
  run.PrepareInputs();
}

void vtkSurfaceFilter::RefusePrepareInput() const
{
  throw cartan::Error(cartan::ErrorCode::BadInput,
    "PrepareInput is not possible in " + std::string(this->GetClassName()) +
      ": turn it off, and connect the output of vtkPrepareSurface (Prepare Surface).");
}

int vtkSurfaceFilter::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->SetErrorCode(vtkErrorCode::NoError);
  this->ForgetResults();
  cartan::FilterRun run(this, request, inputVector, outputVector, *this->Kept);
  const cartan::RunOutcome outcome = cartan::RunGuarded(
    [this, &run]
    {
      if (!this->SupportsPieces())
      {
        cartan::RefuseDistributed(this);
      }
      vtkPolyData* input = run.Input();
      if (input && input->GetNumberOfPoints() == 0 && input->GetNumberOfCells() == 0 &&
        this->AcceptsEmptyInput())
      {
        this->EmptyOutputs();
        return;
      }
      if (this->PrepareInput)
      {
        this->UsePreparedInput(run);
      }
      this->Execute(run);
      run.RestoreOutput();
      for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
      {
        cartan::ShareKeys(input, run.Output(port));
      }
    });
  this->Kept->Trim(static_cast<std::size_t>(this->KeptMemoryLimit * Megabyte));
  if (!outcome.IsSuccess())
  {
    this->EmptyOutputs();
    this->ForgetResults();
  }
  if (!outcome.Problem.empty())
  {
    this->SetErrorCode(vtkErrorCode::UserError);
    vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
    if (!outcome.IsCollective || !controller || controller->GetLocalProcessId() == 0)
    {
      vtkErrorMacro(<< outcome.Problem);
    }
  }
  return 1;
}
