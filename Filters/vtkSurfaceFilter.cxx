// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceFilter.h"

#include "Bridge/FilterRun.h"
#include "Bridge/GatheredRun.h"

#include "vtkCommand.h"
#include "vtkCompositeDataSet.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <vector>

namespace
{
constexpr double Megabyte = 1e6;

bool AcceptsBlocks(vtkInformation* port)
{
  const int count = port->Length(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  for (int index = 0; index < count; ++index)
  {
    if (port->Get(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), index) ==
      std::string("vtkCompositeDataSet"))
    {
      return true;
    }
  }
  return false;
}
}

vtkSurfaceFilter::vtkSurfaceFilter()
  : Kept(std::make_unique<cartan::KeptResults>())
{
  // The executive hands composite data over block by block: only here they are whole.
  this->AddObserver(vtkCommand::StartEvent, this, &vtkSurfaceFilter::LookForBlocks);
}

vtkSurfaceFilter::~vtkSurfaceFilter() = default;

void vtkSurfaceFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "PrepareInput: " << this->PrepareInput << "\n";
  os << indent << "GatherLimit: " << this->GatherLimit << "\n";
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

void vtkSurfaceFilter::ReportProblem(const std::string& problem, bool isCollective)
{
  this->SetErrorCode(vtkErrorCode::UserError);
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  if (!isCollective || !controller || controller->GetLocalProcessId() == 0)
  {
    vtkErrorMacro(<< problem << (this->Numbering.empty() ? "" : " ") << this->Numbering);
  }
}

void vtkSurfaceFilter::LookForBlocks()
{
  this->HasBlocks = false;
  this->RefusesBlocks = false;
  vtkMultiProcessController* controller = cartan::RankGroup::ControllerOf(this);
  if (!controller)
  {
    return;
  }
  bool hasBlocks = false;
  vtkIdType points = 0;
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    for (int index = 0; index < this->GetNumberOfInputConnections(port); ++index)
    {
      auto* blocks = vtkCompositeDataSet::SafeDownCast(this->GetInputDataObject(port, index));
      if (blocks && !AcceptsBlocks(this->GetInputPortInformation(port)))
      {
        hasBlocks = true;
        points += blocks->GetNumberOfPoints();
      }
    }
  }
  if (!hasBlocks && this->SettledStamp != 0 && this->SettledStamp == this->StampOfInputs())
  {
    return; // nor have the others: their inputs, too, are those of the update before
  }
  const cartan::RankGroup ranks(controller);
  this->HasBlocks = ranks.Any(hasBlocks);
  if (this->HasBlocks)
  {
    const std::vector<vtkIdType> all = ranks.All({ points });
    const auto used = std::count_if(all.begin(), all.end(), [](vtkIdType n) { return n > 0; });
    this->RefusesBlocks = used > 1;
    if (this->RefusesBlocks)
    {
      this->ReportProblem(cartan::DescribeBlocksOnRanks(static_cast<int>(used)), true);
    }
  }
}

vtkTypeBool vtkSurfaceFilter::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (request->Has(vtkDemandDrivenPipeline::REQUEST_DATA()))
  {
    if (this->RefusesBlocks)
    {
      this->EmptyOutputs();
      return 1;
    }
    // Blocks of one rank concern no other.
    vtkMultiProcessController* controller = cartan::RankGroup::ControllerOf(this);
    if (controller && !this->HasBlocks && this->ServesPiecesOf(controller))
    {
      return this->RunOnPieces(request, inputVector, outputVector, controller);
    }
    if (controller && !this->HasBlocks)
    {
      return this->RunOnFirstRank(
        request, inputVector, outputVector, cartan::RankGroup(controller));
    }
  }
  return this->Superclass::ProcessRequest(request, inputVector, outputVector);
}

int vtkSurfaceFilter::RunOnFirstRank(vtkInformation* request, vtkInformationVector** inputVector,
  vtkInformationVector* outputVector, const cartan::RankGroup& ranks, const std::string& reason)
{
  this->SettledStamp = 0;
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  this->SetErrorCode(vtkErrorCode::NoError);
  this->ForgetResults();
  cartan::GatheredRun gathered(ranks, inputVector, this->GetNumberOfInputPorts());
  std::string warning;
  const auto end = [&](const cartan::RunOutcome& outcome)
  {
    this->EmptyOutputs();
    this->ForgetResults();
    request->Remove(Pipeline::CONTINUE_EXECUTING());
    if (!outcome.Problem.empty())
    {
      this->ReportProblem(outcome.Problem, outcome.IsCollective);
    }
    this->FollowFirstRank(request, inputVector, true);
    return 1;
  };
  cartan::RunOutcome outcome = cartan::RunGuarded(
    [&]
    {
      cartan::StopTogether(this, ranks);
      warning = gathered.Gather(this->GatherLimit, reason);
    });
  if (!outcome.IsSuccess())
  {
    return end(outcome);
  }
  if (ranks.IsFirst())
  {
    if (!warning.empty() && !this->HasWarnedOfGathering)
    {
      vtkWarningMacro(<< warning);
      this->HasWarnedOfGathering = true;
    }
    this->Numbering = gathered.Numbering();
    this->Superclass::ProcessRequest(request, gathered.Inputs(), outputVector);
    this->Numbering.clear();
  }
  const std::vector<vtkIdType> all = ranks.All({ static_cast<vtkIdType>(this->GetErrorCode()),
    request->Has(Pipeline::CONTINUE_EXECUTING()) ? 1 : 0 });
  if (!ranks.IsFirst())
  {
    this->SetErrorCode(static_cast<unsigned long>(all[0]));
    request->Remove(Pipeline::CONTINUE_EXECUTING());
    if (all[1])
    {
      request->Set(Pipeline::CONTINUE_EXECUTING(), 1);
    }
    this->FollowFirstRank(request, inputVector, all[0] != 0);
  }
  outcome = cartan::RunGuarded(
    [&] { gathered.HandBack(outputVector, this->HandsBackPieces() && !all[1]); });
  return outcome.IsSuccess() ? 1 : end(outcome);
}

bool vtkSurfaceFilter::ServesPiecesOf(vtkMultiProcessController* controller) const
{
  return !this->PrepareInput && this->SupportsPieces() && cartan::PieceGroup::Of(controller);
}

/// Changes where a producer has run again, as it does on all ranks or on none.
unsigned long long vtkSurfaceFilter::StampOfInputs()
{
  cartan::ContentKey stamp;
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    for (int index = 0; index < this->GetNumberOfInputConnections(port); ++index)
    {
      vtkDataObject* input = this->GetInputDataObject(port, index);
      stamp.Add(static_cast<std::uint64_t>(reinterpret_cast<std::uintptr_t>(input)));
      if (input)
      {
        stamp.Add(static_cast<std::uint64_t>(input->GetMTime()));
        stamp.Add(static_cast<std::uint64_t>(input->GetUpdateTime()));
      }
    }
  }
  return stamp.GetValue();
}

int vtkSurfaceFilter::RunOnPieces(vtkInformation* request, vtkInformationVector** inputVector,
  vtkInformationVector* outputVector, vtkMultiProcessController* controller)
{
  this->SetErrorCode(vtkErrorCode::NoError);
  this->ForgetResults();
  const unsigned long long stamp = this->StampOfInputs();
  const bool isSettled = this->MovesAlone() && stamp == this->SettledStamp;
  this->SettledStamp = 0;
  cartan::FilterRun run(this, request, inputVector, outputVector, *this->Kept);
  run.UsePieces(cartan::PieceGroup::Of(controller), isSettled);
  const auto work = [this, &run] { this->ExecuteOnPieces(run); };
  cartan::RunOutcome outcome = cartan::RunGuarded(
    [&]
    {
      if (isSettled)
      {
        work();
      }
      else
      {
        run.Together(work);
      }
    });
  if (!run.GetReasonToGather().empty())
  {
    this->Kept->Clear();
    return this->RunOnFirstRank(
      request, inputVector, outputVector, cartan::RankGroup(controller), run.GetReasonToGather());
  }
  if (outcome.IsSuccess() || run.IsAlone())
  {
    this->SettledStamp = stamp;
    this->Kept->KeepUsed();
  }
  else
  {
    this->Kept->Clear(); // some ranks may have what others have not
  }
  if (!outcome.IsSuccess())
  {
    this->EmptyOutputs();
    this->ForgetResults();
  }
  if (!outcome.Problem.empty())
  {
    this->Numbering = run.GetNumbering();
    this->ReportProblem(outcome.Problem, !run.IsAlone());
    this->Numbering.clear();
  }
  return 1;
}

void vtkSurfaceFilter::ExecuteOnPieces(cartan::FilterRun& run)
{
  vtkPolyData* input = run.Input();
  run.Context().Report(0.0);
  const bool isEmpty = input->GetNumberOfPoints() == 0 && input->GetNumberOfCells() == 0;
  if (this->AcceptsEmptyInput() && run.AreAllEmpty(isEmpty))
  {
    this->EmptyOutputs();
    return;
  }
  this->Execute(run);
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    cartan::ShareKeys(input, run.Output(port));
  }
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
    this->ReportProblem(outcome.Problem, outcome.IsCollective);
  }
  return 1;
}
