// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Error.h"
#include "Base/Types.h"

#include <mpi.h>

#include <cstdint>
#include <functional>
#include <vector>

namespace cartan
{
/// The processes (*ranks*) that hold a surface in pieces, and what they do together.
///
/// All functions but the first few are *collective*: all ranks call the same ones in the
/// same order. A rank that cannot go on throws inside of Together(); then whatever the
/// others call next throws, too, so that none waits for it.
class Ranks
{
public:
  /// Duplicates the communicator; collective.
  explicit Ranks(MPI_Comm communicator);
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int GetRank() const { return this->Rank; }
  int GetSize() const { return this->Size; }
  MPI_Comm GetCommunicator() const { return this->Communicator; }

  /// How often this rank has called MPI to tell others something, or to be told.
  std::int64_t GetNumberOfMessages() const { return this->Messages; }

  /// Calls work(), which may call collective functions. When it throws on some ranks,
  /// all throw the same Error: that of the lowest of them, which tells how many others
  /// have failed for another reason. What work() leaves half done is the caller's.
  void Together(const std::function<void()>& work) const;

  /// Whether Together() has thrown this error on all ranks. Then one of them reports it.
  static bool IsShared(const Error& error);

  /// Entry by entry over all ranks; all get the result, the same bits.
  void Sum(Eigen::Ref<Eigen::VectorXd> values) const;
  void Max(Eigen::Ref<Eigen::VectorXd> values) const;
  bool Any(bool value) const;

  /// The lists of all ranks, one after the other.
  std::vector<std::int64_t> Gather(const std::vector<std::int64_t>& values) const;

  /// How many ids all ranks have, and the smallest of them.
  IdSample Sample(std::vector<std::int64_t> ids) const;

  /// The sum over the ranks before this one.
  std::int64_t SumBefore(std::int64_t value) const;

  /// Gives `lists[r]` to rank r; returns what each rank has given to this one.
  std::vector<std::vector<std::int64_t>> Exchange(
    const std::vector<std::vector<std::int64_t>>& lists) const;

  /// Returns where all ranks get here, and throws where one has failed; every collective
  /// function begins with it. For those who call MPI themselves.
  void Agree() const;

  /// For the same: counts calls.
  void CountMessages(std::int64_t count) const { this->Messages += count; }

private:
  [[noreturn]] void ThrowShared(const Error* own) const;
  [[noreturn]] void Fail(const Error& error) const;

  MPI_Comm Communicator = MPI_COMM_NULL;
  int Rank = 0;
  int Size = 1;
  mutable std::int64_t Messages = 0;
};
}
