// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/RankGroup.h"

#include "vtkAlgorithm.h"
#include "vtkCommunicator.h"
#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <new>
#include <utility>

namespace cartan
{
namespace
{
/// Among the messages of one controller.
constexpr int PieceTag = 47025;
}

RankGroup::RankGroup(vtkMultiProcessController* controller)
  : Controller(controller)
{
}

vtkMultiProcessController* RankGroup::ControllerOf(vtkAlgorithm* filter)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  if (!controller || controller->GetNumberOfProcesses() < 2)
  {
    return nullptr;
  }
  // The executive tells the port that somebody asks for.
  for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
  {
    vtkInformation* output = filter->GetOutputInformation(port);
    if (output->Has(Pipeline::UPDATE_NUMBER_OF_PIECES()) &&
      output->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()) == controller->GetNumberOfProcesses() &&
      output->Get(Pipeline::UPDATE_PIECE_NUMBER()) == controller->GetLocalProcessId())
    {
      return controller;
    }
  }
  return nullptr;
}

int RankGroup::Rank() const
{
  return this->Controller->GetLocalProcessId();
}

int RankGroup::Size() const
{
  return this->Controller->GetNumberOfProcesses();
}

void RankGroup::Together(const std::function<void()>& work) const
{
  std::string problem;
  ErrorCode code = ErrorCode::BadInput;
  try
  {
    work();
  }
  catch (const Error& error)
  {
    problem = error.what();
    code = error.GetCode();
  }
  catch (const std::bad_alloc&)
  {
    problem = "Rank " + std::to_string(this->Rank()) +
      ": Out of memory: decimate the surface or free memory.";
    code = ErrorCode::OutOfMemory;
  }
  catch (const std::exception& error)
  {
    problem = error.what();
  }
  this->Agree(problem, code);
}

void RankGroup::Agree(const std::string& problem, ErrorCode code) const
{
  const int none = this->Size();
  const std::vector<vtkIdType> all =
    this->All({ problem.empty() ? none : this->Rank(), static_cast<vtkIdType>(code) });
  int lowest = none;
  for (int rank = none - 1; rank >= 0; --rank)
  {
    lowest = all[2 * rank] == rank ? rank : lowest;
  }
  if (lowest < none)
  {
    throw CollectiveError(static_cast<ErrorCode>(all[2 * lowest + 1]), this->Tell(problem, lowest));
  }
}

std::vector<vtkIdType> RankGroup::All(const std::vector<vtkIdType>& values) const
{
  std::vector<vtkIdType> all(values.size() * static_cast<std::size_t>(this->Size()));
  this->Controller->AllGather(values.data(), all.data(), static_cast<vtkIdType>(values.size()));
  return all;
}

bool RankGroup::Any(bool value) const
{
  const std::vector<vtkIdType> all = this->All({ value ? 1 : 0 });
  return std::find(all.begin(), all.end(), 1) != all.end();
}

std::string RankGroup::Tell(const std::string& text, int from) const
{
  auto length = static_cast<vtkIdType>(text.size());
  this->Controller->Broadcast(&length, 1, from);
  std::string told =
    this->Rank() == from ? text : std::string(static_cast<std::size_t>(length), ' ');
  this->Controller->Broadcast(told.data(), length, from);
  return told;
}

std::vector<std::vector<char>> RankGroup::ToFirst(std::vector<char> bytes) const
{
  const std::vector<vtkIdType> sizes = this->All({ static_cast<vtkIdType>(bytes.size()) });
  std::vector<std::vector<char>> received(this->IsFirst() ? sizes.size() : 0);
  // Memory first: nobody waits for a rank that has none.
  this->Together(
    [&]
    {
      for (std::size_t rank = 1; rank < received.size(); ++rank)
      {
        received[rank].resize(static_cast<std::size_t>(sizes[rank]));
      }
    });
  if (!this->IsFirst())
  {
    this->Controller->Send(bytes.data(), static_cast<vtkIdType>(bytes.size()), 0, PieceTag);
    return {};
  }
  received[0] = std::move(bytes);
  for (int rank = 1; rank < this->Size(); ++rank)
  {
    this->Controller->Receive(received[rank].data(), sizes[rank], rank, PieceTag);
  }
  return received;
}

std::vector<char> RankGroup::FromFirst(std::vector<std::vector<char>> bytes) const
{
  std::vector<vtkIdType> sizes(static_cast<std::size_t>(this->Size()), 0);
  for (std::size_t rank = 0; rank < bytes.size(); ++rank)
  {
    sizes[rank] = static_cast<vtkIdType>(bytes[rank].size());
  }
  this->Controller->Broadcast(sizes.data(), this->Size(), 0);
  std::vector<char> received;
  this->Together(
    [&]
    {
      if (!this->IsFirst())
      {
        received.resize(static_cast<std::size_t>(sizes[this->Rank()]));
      }
    });
  if (!this->IsFirst())
  {
    this->Controller->Receive(received.data(), sizes[this->Rank()], 0, PieceTag);
    return received;
  }
  for (int rank = 1; rank < this->Size(); ++rank)
  {
    this->Controller->Send(bytes[rank].data(), sizes[rank], rank, PieceTag);
  }
  return std::move(bytes[0]);
}
}
