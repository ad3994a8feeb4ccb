// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/DataBytes.h"
#include "Bridge/JoinedPieces.h"
#include "Bridge/RankGroup.h"

#include <map>
#include <utility>
#include <vector>

class vtkDataObject;
class vtkInformationVector;

/// Private to the filters, not installed.
namespace cartan
{
/// A filter that knows nothing of pieces runs on the first rank, with the pieces of all.
///
/// All functions are collective, see RankGroup, and throw a CollectiveError on all ranks.
class GatheredRun
{
public:
  GatheredRun(RankGroup ranks, vtkInformationVector** inputs, int numberOfPorts);
  ~GatheredRun();

  /// Brings the inputs to the first rank. Surfaces in pieces that have more points than `limit`
  /// in all are refused. Returns a warning where the pieces of several ranks were joined, with
  /// the `reason` if there is one.
  std::string Gather(vtkIdType limit, const std::string& reason = "");

  /// What the filter reads: on the first rank what was gathered.
  vtkInformationVector** Inputs() { return this->Pointers.data(); }

  /// What ids in messages mean; empty where there are no pieces.
  const std::string& Numbering() const { return this->TheNumbering; }

  /// Gives each rank its piece of the outputs of the first that have the points and cells of an
  /// input; the others stay on the first rank. Without `inPieces` all do.
  void HandBack(vtkInformationVector* outputs, bool inPieces);

private:
  struct Connection
  {
    int Port;
    int Index;
    bool IsGathered = false;
  };

  vtkDataObject* InputOf(const Connection& connection) const;
  void GatherSurfaces();
  void GatherTable(const Connection& connection);
  void Replace(const Connection& connection, vtkDataObject* data);
  void WriteOutput(vtkDataObject* output, std::size_t rank, bool inPieces, ByteWriter& bytes) const;

  RankGroup Ranks;
  vtkInformationVector** Original;
  std::vector<vtkSmartPointer<vtkInformationVector>> Vectors;
  std::vector<vtkInformationVector*> Pointers;
  std::vector<Connection> Connections;
  std::map<std::pair<int, int>, JoinedPieces> Joined; // on the first rank
  std::string TheNumbering;
};
}
