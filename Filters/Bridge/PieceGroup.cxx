// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/PieceGroup.h"

#ifdef CARTAN_HAVE_PIECES
#include "Kernel/Distributed/Ranks.h"

#include "vtkMPI.h"
#include "vtkMPICommunicator.h"
#include "vtkMultiProcessController.h"

#include <map>
#endif

#include <string>

namespace cartan
{
#ifdef CARTAN_HAVE_PIECES

std::shared_ptr<const PieceGroup> PieceGroup::Of(vtkMultiProcessController* controller)
{
  auto* communicator = vtkMPICommunicator::SafeDownCast(controller->GetCommunicator());
  if (!communicator || !communicator->GetMPIComm() || !communicator->GetMPIComm()->GetHandle())
  {
    return nullptr;
  }
  // One duplicate for all filters.
  static std::map<MPI_Comm, std::shared_ptr<const PieceGroup>> groups;
  const MPI_Comm handle = *communicator->GetMPIComm()->GetHandle();
  std::shared_ptr<const PieceGroup>& group = groups[handle];
  if (!group)
  {
    group = std::shared_ptr<const PieceGroup>(new PieceGroup(std::make_shared<Ranks>(handle)));
  }
  return group;
}

bool PieceGroup::IsShared(const Error& error)
{
  return Ranks::IsShared(error);
}

int PieceGroup::GetRank() const
{
  return this->Members->GetRank();
}

void PieceGroup::Together(const std::function<void()>& work) const
{
  this->Members->Together(work);
}

bool PieceGroup::Any(bool value) const
{
  return this->Members->Any(value);
}

#else

std::shared_ptr<const PieceGroup> PieceGroup::Of(vtkMultiProcessController*)
{
  return nullptr;
}

bool PieceGroup::IsShared(const Error&)
{
  return false;
}

// There is no group.
int PieceGroup::GetRank() const
{
  return 0;
}

void PieceGroup::Together(const std::function<void()>& work) const
{
  work();
}

bool PieceGroup::Any(bool value) const
{
  return value;
}

#endif

void PieceGroup::TogetherByRank(const std::function<void()>& work) const
{
  this->Together(
    [&]
    {
      try
      {
        work();
      }
      catch (const Error& error)
      {
        throw Error(
          error.GetCode(), "On rank " + std::to_string(this->GetRank()) + ": " + error.what());
      }
    });
}
}
