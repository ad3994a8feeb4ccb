// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Ranks.h"

#include <algorithm>
#include <limits>
#include <new>
#include <numeric>
#include <string>

namespace cartan
{
namespace
{
/// What all ranks throw: nobody needs to be told of it.
class SharedError : public Error
{
public:
  using Error::Error;
};

static_assert(sizeof(long long) == sizeof(std::int64_t), "MPI_LONG_LONG is what is sent");

/// Where each part begins in all of them together.
std::vector<int> Offsets(const std::vector<int>& counts)
{
  std::vector<int> offsets(counts.size() + 1, 0);
  const std::int64_t total = std::accumulate(counts.begin(), counts.end(), std::int64_t{ 0 });
  if (total > std::numeric_limits<int>::max())
  {
    throw Error(ErrorCode::TooLarge,
      "The pieces of a surface tell each other more than MPI can count: use more ranks.");
  }
  std::partial_sum(counts.begin(), counts.end(), offsets.begin() + 1);
  return offsets;
}
}

Ranks::Ranks(MPI_Comm communicator)
{
  MPI_Comm_dup(communicator, &this->Communicator);
  MPI_Comm_rank(this->Communicator, &this->Rank);
  MPI_Comm_size(this->Communicator, &this->Size);
}

Ranks::~Ranks()
{
  int isFinalized = 0;
  MPI_Finalized(&isFinalized);
  if (!isFinalized)
  {
    MPI_Comm_free(&this->Communicator);
  }
}

bool Ranks::IsShared(const Error& error)
{
  return dynamic_cast<const SharedError*>(&error) != nullptr;
}

void Ranks::Agree() const
{
  int hasFailed = 0;
  ++this->Messages;
  MPI_Allreduce(MPI_IN_PLACE, &hasFailed, 1, MPI_INT, MPI_MAX, this->Communicator);
  if (hasFailed)
  {
    this->ThrowShared(nullptr);
  }
}

void Ranks::Fail(const Error& error) const
{
  int hasFailed = 1;
  ++this->Messages;
  MPI_Allreduce(MPI_IN_PLACE, &hasFailed, 1, MPI_INT, MPI_MAX, this->Communicator);
  this->ThrowShared(&error);
}

/// The error of the lowest rank that has one.
void Ranks::ThrowShared(const Error* own) const
{
  const std::string text = own ? own->what() : "";
  int lengths[2] = { own ? static_cast<int>(text.size()) : -1,
    own ? static_cast<int>(own->GetCode()) : 0 };
  std::vector<int> all(2 * static_cast<std::size_t>(this->Size));
  MPI_Allgather(lengths, 2, MPI_INT, all.data(), 2, MPI_INT, this->Communicator);
  int lowest = -1;
  for (int rank = this->Size - 1; rank >= 0; --rank)
  {
    lowest = all[2 * static_cast<std::size_t>(rank)] >= 0 ? rank : lowest;
  }
  std::string message = text;
  message.resize(static_cast<std::size_t>(all[2 * static_cast<std::size_t>(lowest)]));
  if (this->Rank == lowest)
  {
    message = text;
  }
  MPI_Bcast(message.data(), static_cast<int>(message.size()), MPI_CHAR, lowest, this->Communicator);
  int others = own && text != message ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &others, 1, MPI_INT, MPI_SUM, this->Communicator);
  this->Messages += 3;
  if (others > 0)
  {
    message += " (And " + std::to_string(others) + (others == 1 ? " rank has" : " ranks have") +
      " another problem.)";
  }
  throw SharedError(static_cast<ErrorCode>(all[2 * static_cast<std::size_t>(lowest) + 1]), message);
}

void Ranks::Together(const std::function<void()>& work) const
{
  try
  {
    work();
    this->Agree();
  }
  catch (const SharedError&)
  {
    throw;
  }
  catch (const Error& error)
  {
    this->Fail(error);
  }
  catch (const std::bad_alloc&)
  {
    this->Fail(Error(ErrorCode::OutOfMemory,
      "The memory of rank " + std::to_string(this->Rank) + " does not suffice: use more ranks."));
  }
  catch (const std::exception& error)
  {
    this->Fail(Error(ErrorCode::SolverFailed, error.what()));
  }
}

void Ranks::Sum(Eigen::Ref<Eigen::VectorXd> values) const
{
  this->Agree();
  ++this->Messages;
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM,
    this->Communicator);
}

void Ranks::Max(Eigen::Ref<Eigen::VectorXd> values) const
{
  this->Agree();
  ++this->Messages;
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_MAX,
    this->Communicator);
}

bool Ranks::Any(bool value) const
{
  this->Agree();
  int flag = value ? 1 : 0;
  ++this->Messages;
  MPI_Allreduce(MPI_IN_PLACE, &flag, 1, MPI_INT, MPI_MAX, this->Communicator);
  return flag != 0;
}

std::vector<std::int64_t> Ranks::Gather(const std::vector<std::int64_t>& values) const
{
  this->Agree();
  const int count = static_cast<int>(values.size());
  std::vector<int> counts(static_cast<std::size_t>(this->Size));
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, this->Communicator);
  // The same on all ranks, so that all throw or none does.
  const std::vector<int> offsets = Offsets(counts);
  std::vector<std::int64_t> all(static_cast<std::size_t>(offsets.back()));
  MPI_Allgatherv(values.data(), count, MPI_LONG_LONG, all.data(), counts.data(), offsets.data(),
    MPI_LONG_LONG, this->Communicator);
  this->Messages += 2;
  return all;
}

IdSample Ranks::Sample(std::vector<std::int64_t> ids) const
{
  std::sort(ids.begin(), ids.end());
  Eigen::VectorXd count(1);
  count[0] = static_cast<double>(ids.size());
  this->Sum(count);
  ids.resize(std::min(ids.size(), IdSample::Kept));
  std::vector<std::int64_t> all = this->Gather(ids);
  std::sort(all.begin(), all.end());
  IdSample sample;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count[0]); ++i)
  {
    sample.Add(i < all.size() ? all[i] : 0);
  }
  return sample;
}

std::int64_t Ranks::SumBefore(std::int64_t value) const
{
  this->Agree();
  std::int64_t sum = 0;
  ++this->Messages;
  MPI_Exscan(&value, &sum, 1, MPI_LONG_LONG, MPI_SUM, this->Communicator);
  return this->Rank == 0 ? 0 : sum; // MPI leaves that of the first open
}

std::vector<std::vector<std::int64_t>> Ranks::Exchange(
  const std::vector<std::vector<std::int64_t>>& lists) const
{
  this->Agree();
  const auto size = static_cast<std::size_t>(this->Size);
  std::vector<int> given(size);
  std::vector<int> taken(size);
  for (std::size_t rank = 0; rank < size; ++rank)
  {
    given[rank] = static_cast<int>(lists[rank].size());
  }
  MPI_Alltoall(given.data(), 1, MPI_INT, taken.data(), 1, MPI_INT, this->Communicator);
  ++this->Messages;
  std::vector<int> givenOffsets;
  std::vector<int> takenOffsets;
  this->Together(
    [&]
    {
      givenOffsets = Offsets(given);
      takenOffsets = Offsets(taken);
    });
  std::vector<std::int64_t> out;
  for (const std::vector<std::int64_t>& list : lists)
  {
    out.insert(out.end(), list.begin(), list.end());
  }
  std::vector<std::int64_t> in(static_cast<std::size_t>(takenOffsets.back()));
  MPI_Alltoallv(out.data(), given.data(), givenOffsets.data(), MPI_LONG_LONG, in.data(),
    taken.data(), takenOffsets.data(), MPI_LONG_LONG, this->Communicator);
  ++this->Messages;
  std::vector<std::vector<std::int64_t>> result(size);
  for (std::size_t rank = 0; rank < size; ++rank)
  {
    result[rank].assign(in.begin() + takenOffsets[rank], in.begin() + takenOffsets[rank + 1]);
  }
  return result;
}
}
