// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace cartan
{
enum class ErrorCode
{
  BadInput,            ///< the input breaks a documented precondition
  SingularSystem,      ///< the constraints do not determine a solution
  NotPositiveDefinite, ///< a matrix, up to rounding
  NotConverged,        ///< an iteration stopped short of its tolerance
  TooLarge,            ///< more entries than indices can count
  OutOfMemory,         ///< the memory does not suffice
  SolverFailed,        ///< a library failed without saying why
  Aborted              ///< the caller asked to stop
};

/// The one exception of the kernel. what() is a sentence for the user: what is
/// wrong, how many, the first ids, what to do.
class Error : public std::runtime_error
{
public:
  Error(ErrorCode code, const std::string& message)
    : std::runtime_error(message)
    , Code(code)
  {
  }
  ErrorCode GetCode() const { return this->Code; }

private:
  ErrorCode Code;
};

/// Ids of something that was counted: how many there are and the first few.
/// Collecting all would cost memory and help nobody.
class IdSample
{
public:
  static constexpr std::size_t Kept = 5;

  void Add(long long id)
  {
    if (this->First.size() < Kept)
    {
      this->First.push_back(id);
    }
    ++this->Count;
  }
  std::size_t GetCount() const { return this->Count; }
  bool IsEmpty() const { return this->Count == 0; }
  const std::vector<long long>& GetFirst() const { return this->First; }

  /// The same sample with its ids looked up in `names`; unchanged when empty.
  IdSample Renamed(const std::vector<long long>& names) const
  {
    IdSample renamed = *this;
    for (long long& id : renamed.First)
    {
      id = names.empty() ? id : names[id];
    }
    return renamed;
  }

  /// "7 points (ids 1, 2, 3, 4, 5, ...)"; singular becomes "1 point (id 3)".
  std::string Describe(const std::string& singular, const std::string& plural) const
  {
    std::string text = std::to_string(this->Count) + " " + (this->Count == 1 ? singular : plural);
    text += this->Count == 1 ? " (id " : " (ids ";
    for (std::size_t i = 0; i < this->First.size(); ++i)
    {
      text += (i ? ", " : "") + std::to_string(this->First[i]);
    }
    return text + (this->Count > this->First.size() ? ", ...)" : ")");
  }

private:
  std::vector<long long> First;
  std::size_t Count = 0;
};
}
