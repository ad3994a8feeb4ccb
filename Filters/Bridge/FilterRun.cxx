// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/FilterRun.h"

#include "Bridge/InputPreparation.h"

#include "vtkAlgorithm.h"
#include "vtkAlgorithmOutput.h"
#include "vtkCommunicator.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"

#include <algorithm>
#include <new>

namespace cartan
{
namespace
{
struct KeptSurface
{
  std::shared_ptr<const Surface> TheSurface;

  std::size_t GetBytes() const { return this->TheSurface->GetBytes(); }
};

/// A prepared input of one state.
struct PreparedInput
{
  vtkSmartPointer<vtkPolyData> TheSurface;

  std::size_t GetBytes() const { return 1024 * this->TheSurface->GetActualMemorySize(); }
};

/// Between blocks of a long loop observers may stop it: the slowest loops take some
/// microseconds for each element.
constexpr int Block = 1 << 15;

bool IsToStop(vtkAlgorithm* algorithm)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 3, 0)
  return algorithm->CheckAbort(); // upstream's request to stop counts too
#else
  return algorithm->GetAbortExecute() != 0;
#endif
}

/// Tells the filter's observers, and whether to go on.
bool ReportProgress(vtkAlgorithm* algorithm, double fraction)
{
  algorithm->UpdateProgress(fraction);
  return !IsToStop(algorithm);
}

/// While `waits` is on, nothing stops.
ExecutionContext MakeContext(vtkAlgorithm* algorithm, const bool& waits)
{
  return ExecutionContext(
    [algorithm, &waits](int n, const ExecutionContext::Range& body)
    {
      for (int first = 0; first < n; first += Block)
      {
        if (first > 0 && !ReportProgress(algorithm, algorithm->GetProgress()) && !waits)
        {
          throw Error(ErrorCode::Aborted, "Stopped on request.");
        }
        vtkSMPTools::For(first, first + std::min(Block, n - first),
          [&body](vtkIdType begin, vtkIdType end)
          { body(static_cast<int>(begin), static_cast<int>(end)); });
      }
    },
    [algorithm, &waits](double fraction) { return ReportProgress(algorithm, fraction) || waits; });
}
}

FilterRun::FilterRun(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** inputs,
  vtkInformationVector* outputs, KeptResults& kept)
  : Filter(filter)
  , TheRequest(request)
  , Inputs(inputs)
  , Outputs(outputs)
  , Kept(kept)
  , TheContext(MakeContext(filter, this->WorksAlone))
{
}

vtkInformation* FilterRun::OutputInformation() const
{
  return this->Outputs->GetInformationObject(0);
}

vtkDataObject* FilterRun::InputObject(int port) const
{
  return vtkDataObject::GetData(this->Inputs[port]);
}

vtkPolyData* FilterRun::ConnectedInput(int port, int connection) const
{
  return vtkPolyData::GetData(this->Inputs[port], connection);
}

vtkPolyData* FilterRun::Input(int port, int connection) const
{
  const auto prepared = this->PreparedInputs.find({ port, connection });
  return prepared != this->PreparedInputs.end() ? prepared->second.Get()
                                                : this->ConnectedInput(port, connection);
}

void FilterRun::PrepareInputs()
{
  std::vector<std::pair<int, int>> places;
  for (int port = 0; port < this->Filter->GetNumberOfInputPorts(); ++port)
  {
    for (int connection = 0; connection < this->NumberOfConnections(port); ++connection)
    {
      if (this->ConnectedInput(port, connection))
      {
        places.emplace_back(port, connection);
      }
    }
  }
  if (places.empty())
  {
    return;
  }
  // What others are prepared like must be the same for all time steps that come one by one.
  const auto changes = [this](int port)
  {
    vtkInformation* info = this->Filter->GetInputInformation(port, 0);
    return info && info->Has(vtkStreamingDemandDrivenPipeline::TIME_STEPS());
  };
  const int last = places.back().first;
  const int first = places.front().first;
  vtkPolyData* model = this->ConnectedInput(changes(last) && !changes(first) ? first : last, 0);
  // Progress waits at its begin, where a filter that asks for time steps comes again.
  const auto prepare = [this](vtkPolyData* surface)
  {
    return this->Keep<InputPreparation>(KeyOfSurface(surface),
      [&] { return cartan::PrepareInput(surface, "input", this->TheContext.Part(0.0, 0.0)); });
  };
  const auto preparation = prepare(model);
  for (const auto& place : places)
  {
    vtkPolyData* surface = this->ConnectedInput(place.first, place.second);
    const bool isAlike = surface->GetNumberOfPoints() == model->GetNumberOfPoints() &&
      KeyOfCells(surface) == KeyOfCells(model);
    ContentKey key = KeyOfSurface(model);
    key.Add(static_cast<std::uint64_t>(reinterpret_cast<std::uintptr_t>(surface)));
    key.Add(static_cast<std::uint64_t>(surface->GetMTime()));
    this->PreparedInputs[place] =
      this
        ->Keep<PreparedInput>(key,
          [&]
          {
            return std::make_unique<PreparedInput>(PreparedInput{
              ApplyPreparation(isAlike ? *preparation : *prepare(surface), surface) });
          })
        ->TheSurface;
  }
  this->PreparedOutput = vtkSmartPointer<vtkPolyData>::New();
}

void FilterRun::RestoreOutput()
{
  const vtkSmartPointer<vtkPolyData> result = std::exchange(this->PreparedOutput, nullptr);
  if (!result || result->GetNumberOfPoints() == 0)
  {
    return;
  }
  this->Warn(RestoreResult(result, this->Input(), this->ConnectedInput(0, 0), this->Output()));
}

void FilterRun::UsePieces(std::shared_ptr<const PieceGroup> group, bool isSettled)
{
  this->Group = std::move(group);
  this->IsSettled = isSettled;
}

std::shared_ptr<const PieceSurface> FilterRun::ReadPiece(int port, const std::string& role)
{
  const auto piece = this->ReadPiece(this->Input(port), role, {});
  this->Diagonal = port == 0 ? piece->Diagonal : this->Diagonal;
  return piece;
}

std::shared_ptr<const PieceSurface> FilterRun::ReadPiece(
  vtkPolyData* input, const std::string& role, const VerticesLookedAt& reach)
{
  const auto piece = this->Keep<PieceSurface>(KeyOfPiece(input),
    [&]
    {
      std::string obstacle;
      auto read = cartan::ReadPiece(input, role, *this->Group, reach, this->Numbering, obstacle);
      if (!read)
      {
        this->GatherInstead(obstacle);
      }
      return read;
    });
  this->Numbering = piece->Numbering;
  this->Warn(piece->Warning);
  return piece;
}

void FilterRun::GatherInstead(const std::string& reason)
{
  this->ReasonToGather = reason;
  throw Error(ErrorCode::BadInput, reason);
}

void FilterRun::Together(const std::function<void()>& work) const
{
  if (this->Group)
  {
    this->Group->Together(work);
  }
  else
  {
    work();
  }
}

void FilterRun::Alone(const std::function<void()>& work)
{
  this->WorksAlone = this->IsSettled;
  work();
  this->WorksAlone = false;
}

vtkTable* FilterRun::InputTable(int port) const
{
  return vtkTable::GetData(this->Inputs[port]);
}

int FilterRun::NumberOfConnections(int port) const
{
  return this->Inputs[port]->GetNumberOfInformationObjects();
}

vtkDataObject* FilterRun::OutputObject(int port) const
{
  return vtkDataObject::GetData(this->Outputs, port);
}

vtkPolyData* FilterRun::Output(int port) const
{
  if (port == 0 && this->PreparedOutput)
  {
    return this->PreparedOutput;
  }
  return vtkPolyData::GetData(this->Outputs, port);
}

vtkTable* FilterRun::OutputTable(int port) const
{
  return vtkTable::GetData(this->Outputs, port);
}

std::shared_ptr<const Surface> FilterRun::ReadSurface(int port, const std::string& role)
{
  if (this->Group)
  {
    return this->ReadPiece(port, role)->TheSurface;
  }
  const ExecutionContext context = this->TheContext.Part(0.1 * port, 0.1 * (port + 1));
  const auto surface = cartan::ReadSurface(this->Input(port), role, context);
  this->KeepSurface(surface);
  this->Warn(surface->Describe(role, this->Input(port)));
  return surface;
}

void FilterRun::KeepSurface(const std::shared_ptr<const Surface>& surface)
{
  this->Kept.Get<KeptSurface>(
    surface->Key, [&] { return std::make_unique<KeptSurface>(KeptSurface{ surface }); });
}

ContentKey FilterRun::SurfaceKey() const
{
  return KeyOfSurface(this->Input());
}

void FilterRun::Warn(const std::string& text) const
{
  if (!this->Group || this->Group->GetRank() == 0)
  {
    this->WarnHere(text);
  }
}

void FilterRun::WarnHere(const std::string& text) const
{
  if (!text.empty())
  {
    vtkWarningWithObjectMacro(this->Filter, << text);
  }
}

RunOutcome RunGuarded(const std::function<void()>& body)
{
  RunOutcome outcome;
  try
  {
    body();
  }
  catch (const CollectiveError& error)
  {
    outcome.IsAborted = error.GetCode() == ErrorCode::Aborted;
    outcome.Problem = outcome.IsAborted ? "" : error.what();
    outcome.IsCollective = true;
  }
  catch (const Error& error)
  {
    outcome.IsAborted = error.GetCode() == ErrorCode::Aborted;
    outcome.Problem = outcome.IsAborted ? "" : error.what();
  }
  catch (const std::bad_alloc&)
  {
    outcome.Problem = "Out of memory: decimate the surface or free memory.";
  }
  catch (const std::exception& error)
  {
    outcome.Problem = error.what();
  }
  return outcome;
}

void StopTogether(vtkAlgorithm* filter, const RankGroup& ranks)
{
  ranks.Agree(IsToStop(filter) ? "Stopped on request." : "", ErrorCode::Aborted);
}

std::string DescribeBlocksOnRanks(int numberOfRanks)
{
  return "Composite surfaces are on " + std::to_string(numberOfRanks) +
    " ranks, and blocks are not gathered: make one surface of them (Merge Blocks, then Extract "
    "Surface) first.";
}

void RefuseDistributed(vtkAlgorithm* filter)
{
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  if (!controller || controller->GetNumberOfProcesses() < 2 ||
    filter->GetNumberOfInputConnections(0) == 0)
  {
    return;
  }
  // While the executive feeds a composite data set block by block, ranks may
  // have different numbers of blocks and must not wait for each other.
  vtkAlgorithm* producer = filter->GetInputAlgorithm(0, 0);
  const int producerPort = filter->GetInputConnection(0, 0)->GetIndex();
  if (!vtkDataSet::SafeDownCast(producer->GetOutputDataObject(producerPort)))
  {
    throw CollectiveError(
      "Composite surfaces cannot be processed on several ranks: extract a block and gather it on "
      "one rank (Aggregate Dataset) first.");
  }
  auto* input = vtkDataSet::SafeDownCast(filter->GetInputDataObject(0, 0));
  const int hasCells = input && input->GetNumberOfCells() > 0;
  int ranksWithCells = 0;
  controller->AllReduce(&hasCells, &ranksWithCells, 1, vtkCommunicator::SUM_OP);
  if (ranksWithCells > 1)
  {
    const bool isSurface = vtkPolyData::SafeDownCast(input) != nullptr;
    throw CollectiveError((isSurface ? "The surface" : "The mesh") +
      (" is distributed over " + std::to_string(ranksWithCells)) +
      " ranks, and the pieces do not know their neighbors: gather it on one rank (Aggregate "
      "Dataset, then " +
      (isSurface ? "Clean" : "Clean to Grid") + ") first.");
  }
}
}
