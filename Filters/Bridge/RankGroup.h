// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Base/Error.h"

#include "vtkType.h"

#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkMultiProcessController;

/// What the processes (*ranks*) of a parallel server tell each other. Private to the
/// filters, not installed.
namespace cartan
{
/// What all ranks found out together: the first one tells.
class CollectiveError : public Error
{
public:
  using Error::Error;
  explicit CollectiveError(const std::string& message)
    : Error(ErrorCode::BadInput, message)
  {
  }
};

/// The ranks of VTK's controller. All functions but the first few are *collective*: all ranks
/// call the same ones in the same order.
class RankGroup
{
public:
  explicit RankGroup(vtkMultiProcessController* controller);

  /// The controller, where there are several ranks and the filter's update asks each of
  /// them for its own piece: then all update together. Null otherwise.
  static vtkMultiProcessController* ControllerOf(vtkAlgorithm* filter);

  int Rank() const;
  int Size() const;
  bool IsFirst() const { return this->Rank() == 0; }

  /// Calls work(), which must not be collective. When it throws on some ranks, all throw a
  /// CollectiveError with the message of the lowest of them.
  void Together(const std::function<void()>& work) const;

  /// Throws a CollectiveError on all ranks if one has a problem, a sentence.
  void Agree(const std::string& problem, ErrorCode code = ErrorCode::BadInput) const;

  /// The lists of all ranks, one after the other. All have the same length.
  std::vector<vtkIdType> All(const std::vector<vtkIdType>& values) const;

  bool Any(bool value) const;

  /// What rank `from` says.
  std::string Tell(const std::string& text, int from) const;

  /// Bytes from each rank to the first: there by ranks, empty elsewhere.
  std::vector<std::vector<char>> ToFirst(std::vector<char> bytes) const;

  /// Bytes from the first rank to each; `bytes` is by ranks there, and not looked at elsewhere.
  std::vector<char> FromFirst(std::vector<std::vector<char>> bytes) const;

private:
  vtkMultiProcessController* Controller;
};
}
