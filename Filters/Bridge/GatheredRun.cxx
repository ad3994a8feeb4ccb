// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/GatheredRun.h"

#include "Bridge/FilterRun.h"
#include "Bridge/ResultPieces.h"

#include "vtkCompositeDataSet.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>
#include <numeric>

namespace cartan
{
namespace
{
/// How much there is, in points or rows; of other kinds of data all ranks have the same.
vtkIdType CountOf(vtkDataObject* data)
{
  auto* set = vtkDataSet::SafeDownCast(data);
  auto* table = vtkTable::SafeDownCast(data);
  auto* blocks = vtkCompositeDataSet::SafeDownCast(data);
  return set ? set->GetNumberOfPoints()
    : table  ? table->GetNumberOfRows()
    : blocks ? blocks->GetNumberOfPoints()
             : 0;
}

/// Of how many ranks there is something.
int CountUsed(const std::vector<vtkIdType>& ofRanks)
{
  return static_cast<int>(
    std::count_if(ofRanks.begin(), ofRanks.end(), [](vtkIdType n) { return n > 0; }));
}

/// What WriteOutput() begins with.
constexpr int NotInPieces = -1;
}

GatheredRun::GatheredRun(RankGroup ranks, vtkInformationVector** inputs, int numberOfPorts)
  : Ranks(ranks)
  , Original(inputs)
{
  for (int port = 0; port < numberOfPorts; ++port)
  {
    auto copy = vtkSmartPointer<vtkInformationVector>::New();
    for (int index = 0; index < inputs[port]->GetNumberOfInformationObjects(); ++index)
    {
      vtkNew<vtkInformation> info;
      info->Copy(inputs[port]->GetInformationObject(index));
      copy->Append(info);
      this->Connections.push_back({ port, index });
    }
    this->Vectors.push_back(copy);
    this->Pointers.push_back(copy);
  }
}

GatheredRun::~GatheredRun() = default;

vtkDataObject* GatheredRun::InputOf(const Connection& connection) const
{
  return vtkDataObject::GetData(this->Original[connection.Port], connection.Index);
}

void GatheredRun::Replace(const Connection& connection, vtkDataObject* data)
{
  this->Vectors[connection.Port]
    ->GetInformationObject(connection.Index)
    ->Set(vtkDataObject::DATA_OBJECT(), data);
}

std::string GatheredRun::Gather(vtkIdType limit, const std::string& reason)
{
  const std::size_t count = this->Connections.size();
  const std::vector<vtkIdType> counts = this->Ranks.All({ static_cast<vtkIdType>(count) });
  this->Ranks.Agree(std::all_of(counts.begin(), counts.end(),
                      [&](vtkIdType n) { return n == static_cast<vtkIdType>(count); })
      ? ""
      : "The ranks have different numbers of inputs: connect the same ones on each.");
  vtkIdType total = 0;
  int mostRanks = 0;
  std::vector<vtkIdType> own;
  for (const Connection& connection : this->Connections)
  {
    own.push_back(CountOf(this->InputOf(connection)));
  }
  const std::vector<vtkIdType> all = this->Ranks.All(own);
  std::string obstacle;
  for (std::size_t c = 0; c < count; ++c)
  {
    Connection& connection = this->Connections[c];
    std::vector<vtkIdType> ofRanks;
    for (int rank = 0; rank < this->Ranks.Size(); ++rank)
    {
      ofRanks.push_back(all[rank * count + c]);
    }
    connection.IsGathered =
      std::any_of(ofRanks.begin() + 1, ofRanks.end(), [](vtkIdType n) { return n > 0; });
    vtkDataObject* input = this->InputOf(connection);
    if (connection.IsGathered && vtkPolyData::SafeDownCast(input))
    {
      mostRanks = std::max(mostRanks, CountUsed(ofRanks));
      total += std::accumulate(ofRanks.begin(), ofRanks.end(), vtkIdType{ 0 });
    }
    else if (connection.IsGathered && !vtkTable::SafeDownCast(input))
    {
      const int used = CountUsed(ofRanks);
      obstacle = vtkCompositeDataSet::SafeDownCast(input)
        ? DescribeBlocksOnRanks(used)
        : "The mesh is distributed over " + std::to_string(used) +
          " ranks, and only surfaces are gathered: gather it on one rank (Aggregate Dataset, then "
          "Clean to Grid) first.";
    }
  }
  this->Ranks.Agree(obstacle);
  const std::string what = "The surface is distributed over " + std::to_string(mostRanks) +
    " ranks, with " + std::to_string(total) + " points in all" +
    (reason.empty() ? "" : ", and cannot stay in pieces, for " + reason);
  this->Ranks.Agree(mostRanks > 1 && total > limit ? what + (reason.empty() ? ", more" : ": more") +
        " than GatherLimit (" + std::to_string(limit) +
        ") allows on one rank: raise it if the first rank has the memory, or decimate the surface."
                                                   : "");
  this->GatherSurfaces();
  return mostRanks > 1 ? what + ": it is gathered on the first, which works alone. " +
      this->TheNumbering + " Fewer ranks leave more threads and memory to the first."
                       : "";
}

void GatheredRun::GatherSurfaces()
{
  std::map<std::pair<int, int>, SurfacePieces> pieces;
  // The last port comes first: a surface at rest, by which others are joined, is there.
  std::vector<Connection> order = this->Connections;
  std::stable_sort(order.begin(), order.end(),
    [](const Connection& a, const Connection& b) { return a.Port > b.Port; });
  for (const Connection& connection : order)
  {
    if (!connection.IsGathered)
    {
      continue;
    }
    auto* input = vtkPolyData::SafeDownCast(this->InputOf(connection));
    if (!input)
    {
      this->GatherTable(connection);
      continue;
    }
    ByteWriter writer;
    this->Ranks.Together([&] { writer.AddSurface(input); });
    const std::vector<std::vector<char>> received = this->Ranks.ToFirst(writer.Take());
    this->Ranks.Together(
      [&]
      {
        if (!this->Ranks.IsFirst())
        {
          return;
        }
        const std::pair<int, int> place{ connection.Port, connection.Index };
        SurfacePieces& own = pieces[place];
        for (const std::vector<char>& bytes : received)
        {
          own.push_back(ByteReader(bytes).ReadSurface());
        }
        const JoinedPieces* model = nullptr;
        for (const auto& [other, joined] : this->Joined)
        {
          model = !model && AreAlike(own, pieces[other]) ? &joined : model;
        }
        JoinedPieces& joined = this->Joined[place] = JoinPieces(own, model);
        this->Replace(connection, joined.Whole);
        this->TheNumbering = joined.Points.Numbering;
      });
  }
  this->TheNumbering = this->Ranks.Tell(this->TheNumbering, 0);
}

/// Brings a table to the first rank where another one has it.
void GatheredRun::GatherTable(const Connection& connection)
{
  auto* input = vtkTable::SafeDownCast(this->InputOf(connection));
  ByteWriter writer;
  writer.AddAttributes(input->GetRowData());
  const std::vector<vtkIdType> rows = this->Ranks.All({ input->GetNumberOfRows() });
  const int used = CountUsed(rows);
  this->Ranks.Agree(used > 1
      ? "The table is distributed over " + std::to_string(used) + " ranks: read it on one of them."
      : "");
  const std::vector<std::vector<char>> received = this->Ranks.ToFirst(writer.Take());
  for (std::size_t rank = 0; rank < received.size(); ++rank)
  {
    if (rows[rank] > 0)
    {
      vtkNew<vtkTable> table;
      ByteReader(received[rank]).ReadAttributes(table->GetRowData());
      this->Replace(connection, table);
    }
  }
}

void GatheredRun::WriteOutput(
  vtkDataObject* output, std::size_t rank, bool inPieces, ByteWriter& bytes) const
{
  auto* result = vtkPolyData::SafeDownCast(output);
  for (std::size_t c = 0; result && inPieces && c < this->Connections.size(); ++c)
  {
    const auto joined =
      this->Joined.find({ this->Connections[c].Port, this->Connections[c].Index });
    if (joined != this->Joined.end() && result->GetNumberOfPoints() > 0 &&
      IsOfPieces(result, joined->second.Whole))
    {
      bytes.Add(static_cast<int>(c));
      vtkInformation* info = output->GetInformation();
      bytes.Add(info->Has(vtkDataObject::DATA_TIME_STEP()) != 0);
      bytes.Add(info->Has(vtkDataObject::DATA_TIME_STEP())
          ? info->Get(vtkDataObject::DATA_TIME_STEP())
          : 0.0);
      WriteDifference(result, joined->second, rank, bytes);
      return;
    }
  }
  bytes.Add(NotInPieces);
}

void GatheredRun::HandBack(vtkInformationVector* outputs, bool inPieces)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkDataObject* output = vtkDataObject::GetData(outputs, port);
    std::vector<std::vector<char>> bytes;
    this->Ranks.Together(
      [&]
      {
        for (int rank = 0; this->Ranks.IsFirst() && rank < this->Ranks.Size(); ++rank)
        {
          ByteWriter writer;
          this->WriteOutput(output, static_cast<std::size_t>(rank), inPieces, writer);
          bytes.push_back(writer.Take());
        }
      });
    const std::vector<char> own = this->Ranks.FromFirst(std::move(bytes));
    this->Ranks.Together(
      [&]
      {
        ByteReader reader(own);
        const int connection = reader.Read<int>();
        if (connection == NotInPieces)
        {
          if (!this->Ranks.IsFirst())
          {
            output->Initialize();
          }
          return;
        }
        const bool hasTime = reader.Read<bool>();
        const auto time = reader.Read<double>();
        output->Initialize();
        ApplyDifference(vtkPolyData::SafeDownCast(this->InputOf(this->Connections[connection])),
          reader, vtkPolyData::SafeDownCast(output));
        if (hasTime)
        {
          output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
        }
      });
  }
}
}
