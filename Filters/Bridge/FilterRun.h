// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/KeptResults.h"
#include "Bridge/PieceSurface.h"
#include "Bridge/RankGroup.h"
#include "Bridge/SurfaceReader.h"

#include "vtkSmartPointer.h"

#include <map>
#include <utility>

class vtkAlgorithm;
class vtkDataObject;
class vtkInformation;
class vtkInformationVector;
class vtkPolyData;
class vtkTable;

namespace cartan
{
/// What a filter has at hand while it executes.
class FilterRun
{
public:
  FilterRun(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** inputs,
    vtkInformationVector* outputs, KeptResults& kept);

  vtkInformation* Request() const { return this->TheRequest; }
  vtkInformation* OutputInformation() const;

  /// From here on Input() gives prepared surfaces, all as the reference on port 1
  /// or else the first one needs it, and Output() one that RestoreOutput() carries
  /// back to the points and cells of the input.
  void PrepareInputs();
  void RestoreOutput();

  /// From here on surfaces stay in pieces, one on each rank. Where nothing but motions has
  /// changed since the update before (`isSettled`), all ranks have kept the same things, or
  /// make them together, and need not ask each other whether.
  void UsePieces(std::shared_ptr<const PieceGroup> group, bool isSettled);

  /// The ranks that have the pieces; null where the surface is whole.
  const PieceGroup* Pieces() const { return this->Group.get(); }

  /// Whether all pieces are so; pieces that were there stay there.
  bool AreAllEmpty(bool isEmpty) const { return !this->IsSettled && !this->Group->Any(!isEmpty); }

  /// The piece on a port, kept for the next update; collective.
  std::shared_ptr<const PieceSurface> ReadPiece(int port = 0, const std::string& role = "input");

  /// The same of any surface, wide enough for `reach`, see cartan::ReadPiece.
  std::shared_ptr<const PieceSurface> ReadPiece(
    vtkPolyData* piece, const std::string& role, const VerticesLookedAt& reach);

  /// Of the box around the whole surface whose piece was read from port 0.
  double GetDiagonal() const { return this->Diagonal; }

  /// Throws on all ranks, which call it together, so that the surface is gathered instead.
  [[noreturn]] void GatherInstead(const std::string& reason);
  const std::string& GetReasonToGather() const { return this->ReasonToGather; }

  /// What ids in messages mean; empty where the surface is whole.
  const std::string& GetNumbering() const { return this->Numbering; }

  /// Calls work(), which is collective where the surface is in pieces.
  void Together(const std::function<void()>& work) const;

  /// Calls work(), which needs no other rank. Where these need not be told of errors, an abort
  /// has to wait, and an error is this rank's alone, see IsAlone().
  void Alone(const std::function<void()>& work);
  bool IsAlone() const { return this->WorksAlone; }

  /// The data on an input port, null where nothing is connected.
  vtkDataObject* InputObject(int port = 0) const;
  vtkPolyData* Input(int port = 0, int connection = 0) const;
  vtkTable* InputTable(int port) const;
  int NumberOfConnections(int port) const;

  vtkDataObject* OutputObject(int port = 0) const;
  vtkPolyData* Output(int port = 0) const;
  vtkTable* OutputTable(int port) const;

  /// VTK's threads, the filter's progress and its AbortExecute.
  const ExecutionContext& Context() const { return this->TheContext; }

  /// The surface on a port, kept for the next update; warns about unusual input. Of pieces
  /// that of the piece, see PieceSurface.
  std::shared_ptr<const Surface> ReadSurface(int port = 0, const std::string& role = "input");

  /// Keeps a surface that has been read for the next update, so that it is not
  /// read again.
  void KeepSurface(const std::shared_ptr<const Surface>& surface);

  /// The key of the surface on port 0.
  ContentKey SurfaceKey() const;

  /// vtkWarningMacro on the filter if `text` is not empty. Of pieces the first rank warns, for
  /// all have the same text; WarnHere() is for what one rank finds.
  void Warn(const std::string& text) const;
  void WarnHere(const std::string& text) const;

  /// What survives to the next update, see KeptResults::Get.
  template <typename T, typename Make>
  std::shared_ptr<T> Keep(const ContentKey& key, const Make& make)
  {
    if (this->Group && this->IsMissing(this->Kept.Has<T>(key)))
    {
      std::shared_ptr<T> made;
      this->Group->Together([&] { made = make(); });
      this->Kept.Replace<T>(key, std::move(made));
    }
    return this->Kept.Get<T>(key, make);
  }

private:
  vtkPolyData* ConnectedInput(int port, int connection) const;
  bool IsMissing(bool isHere) const
  {
    return this->IsSettled ? !isHere : this->Group->Any(!isHere);
  }

  vtkAlgorithm* Filter;
  vtkInformation* TheRequest;
  vtkInformationVector** Inputs;
  vtkInformationVector* Outputs;
  KeptResults& Kept;
  ExecutionContext TheContext;
  /// By port and connection; empty when surfaces are used as they come.
  std::map<std::pair<int, int>, vtkSmartPointer<vtkPolyData>> PreparedInputs;
  vtkSmartPointer<vtkPolyData> PreparedOutput;
  std::shared_ptr<const PieceGroup> Group;
  bool IsSettled = false;
  bool WorksAlone = false;
  double Diagonal = 0.0;
  std::string ReasonToGather;
  std::string Numbering;
};

/// How a run ended.
struct RunOutcome
{
  std::string Problem; ///< a sentence for the user; empty if all went well
  bool IsAborted = false;
  bool IsCollective = false; ///< all ranks have the same problem

  bool IsSuccess() const { return this->Problem.empty() && !this->IsAborted; }
};

/// Runs `body` and turns every exception into an outcome: one that left
/// RequestData would take ParaView down.
RunOutcome RunGuarded(const std::function<void()>& body);

/// Throws on all ranks if the filter is to stop on one of them.
void StopTogether(vtkAlgorithm* filter, const RankGroup& ranks);

/// That composite data are on several ranks, and what to do: a sentence.
std::string DescribeBlocksOnRanks(int numberOfRanks);

/// Throws CollectiveError when more than one rank has a part of the surface on
/// port 0.
void RefuseDistributed(vtkAlgorithm* filter);
}
