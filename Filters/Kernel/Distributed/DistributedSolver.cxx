// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/DistributedSolver.h"

#include "Base/Bytes.h"

#include <limits>
#include <utility>

namespace cartan
{
namespace
{
/// Sums over the ranks of a communicator, which carry along whether one of them was asked
/// to stop.
class StoppableSums
{
public:
  StoppableSums(MPI_Comm communicator, const Ranks& group)
    : Communicator(communicator)
    , Group(group)
  {
  }

  /// In place of ExecutionContext::Report, whose error one rank alone may not throw.
  void Report(const ExecutionContext& context, double fraction)
  {
    try
    {
      context.Report(fraction);
    }
    catch (const Error&)
    {
      this->IsStopped = true;
    }
  }

  double Sum(double part) const
  {
    double values[2] = { part, this->IsStopped ? 1.0 : 0.0 };
    MPI_Allreduce(MPI_IN_PLACE, values, 2, MPI_DOUBLE, MPI_SUM, this->Communicator);
    this->Group.CountMessages(1);
    if (values[1] > 0.0)
    {
      throw Error(ErrorCode::Aborted, "Stopped on request.");
    }
    return values[0];
  }

  double Max(double part) const
  {
    MPI_Allreduce(MPI_IN_PLACE, &part, 1, MPI_DOUBLE, MPI_MAX, this->Communicator);
    this->Group.CountMessages(1);
    return part;
  }

private:
  MPI_Comm Communicator;
  const Ranks& Group;
  bool IsStopped = false;
};

/// The worst that a rank has.
SolverStatus Worst(const Ranks& group, SolverStatus status)
{
  Eigen::VectorXd value = Eigen::VectorXd::Constant(1, static_cast<double>(status));
  group.Max(value);
  return static_cast<SolverStatus>(static_cast<int>(value[0]));
}
}

DistributedSolver::DistributedSolver(std::shared_ptr<const Halo> halo, std::vector<int> rows)
  : Rows(std::move(halo))
  , Unknowns(std::move(rows))
{
  for (std::size_t i = 0; i < this->Unknowns.size(); ++i)
  {
    if (this->Rows->IsOwned(this->Unknowns[i]))
    {
      this->Own.push_back(static_cast<int>(i));
    }
  }
}

DistributedSolver::~DistributedSolver()
{
  this->Release();
}

void DistributedSolver::Release()
{
  const std::lock_guard<std::recursive_mutex> guard(HypreMutex());
  int isFinalized = 0;
  MPI_Finalized(&isFinalized);
  if (isFinalized && this->Levels)
  {
    this->Levels->Abandon();
  }
  this->Levels.reset();
  if (!isFinalized && this->Communicator != MPI_COMM_NULL)
  {
    MPI_Comm_free(&this->Communicator);
  }
}

SolverStatus DistributedSolver::Analyze(const SparseMatrix& lower)
{
  // hypre numbers the unknowns, and counts the entries, of all ranks together with int.
  // Those of ghosts are counted twice.
  Eigen::VectorXd entries = Eigen::VectorXd::Constant(
    1, 2.0 * static_cast<double>(lower.nonZeros()) - static_cast<double>(lower.rows()));
  this->Rows->GetRanks().Sum(entries);
  return entries[0] > std::numeric_limits<int>::max() ? SolverStatus::TooLarge : SolverStatus::Ok;
}

/// Unknowns are numbered rank by rank.
MatrixRows DistributedSolver::OwnRows(const SparseMatrix& lower) const
{
  MatrixRows result;
  result.First = this->Rows->GetRanks().SumBefore(static_cast<std::int64_t>(this->Own.size()));
  Field numbers = Field::Constant(this->Rows->NumberOfRows(), 1, -1.0);
  for (std::size_t k = 0; k < this->Own.size(); ++k)
  {
    numbers(this->Unknowns[this->Own[k]], 0) = static_cast<double>(result.First) + double(k);
  }
  this->Rows->Update(numbers);
  const SparseMatrix whole = lower.selfadjointView<Eigen::Lower>();
  for (const int i : this->Own)
  {
    int count = 0;
    for (SparseMatrix::InnerIterator entry(whole, i); entry; ++entry)
    {
      const double column = numbers(this->Unknowns[static_cast<std::size_t>(entry.row())], 0);
      result.Columns.push_back(static_cast<int>(column));
      result.Values.push_back(entry.value());
      ++count;
    }
    result.Counts.push_back(count);
  }
  return result;
}

SolverStatus DistributedSolver::Factorize(const SparseMatrix& lower)
{
  const Ranks& group = this->Rows->GetRanks();
  const std::lock_guard<std::recursive_mutex> guard(HypreMutex());
  this->Release();
  SolverStatus status = StartHypre() ? SolverStatus::Ok : SolverStatus::Failed;
  MatrixRows rows = this->OwnRows(lower);
  group.Together([&rows] { RequireHypreMemory(rows.Values.size()); });
  MPI_Comm_split(group.GetCommunicator(), this->Own.empty() ? MPI_UNDEFINED : 0, group.GetRank(),
    &this->Communicator);
  group.CountMessages(1);
  if (Worst(group, status) != SolverStatus::Ok)
  {
    return SolverStatus::Failed;
  }
  if (!this->Own.empty())
  {
    this->Levels = std::make_unique<HypreMultigrid>(this->Communicator, std::move(rows));
    this->Entries = this->Levels->CountEntries();
    status = TakeHypreStatus();
  }
  status = Worst(group, status);
  return status == SolverStatus::Ok
    ? this->Solve(ProbeVector(static_cast<Eigen::Index>(this->Unknowns.size())), {})
    : status;
}

MultigridResult DistributedSolver::SolveColumn(const Eigen::VectorXd& rightHandSide,
  Eigen::Ref<Eigen::VectorXd> solution, const ExecutionContext& context)
{
  const Ranks& group = this->Rows->GetRanks();
  StoppableSums sums(this->Communicator, group);
  Reductions reductions;
  reductions.Sum = [&sums](double part) { return sums.Sum(part); };
  reductions.Max = [&sums](double part) { return sums.Max(part); };
  return SolveByMultigrid(
    *this->Levels, rightHandSide, solution,
    [&](double fraction)
    {
      group.CountMessages(2); // hypre's own, at least
      sums.Report(context, fraction);
    },
    reductions);
}

SolverStatus DistributedSolver::Solve(
  const Eigen::Ref<const Eigen::MatrixXd>& rightHandSide, const ExecutionContext& context)
{
  const Ranks& group = this->Rows->GetRanks();
  group.Agree();
  const std::lock_guard<std::recursive_mutex> guard(HypreMutex());
  Field values = Field::Zero(this->Rows->NumberOfRows(), rightHandSide.cols());
  this->Steps = 0;
  SolverStatus status = SolverStatus::Ok;
  Eigen::VectorXd given(static_cast<Eigen::Index>(this->Own.size()));
  Eigen::VectorXd found(given.size());
  for (Eigen::Index column = 0;
       column < rightHandSide.cols() && status == SolverStatus::Ok && !this->Own.empty(); ++column)
  {
    for (std::size_t k = 0; k < this->Own.size(); ++k)
    {
      given[static_cast<Eigen::Index>(k)] = rightHandSide(this->Own[k], column);
    }
    const double size = static_cast<double>(rightHandSide.cols());
    const MultigridResult result = this->SolveColumn(given, found,
      context.Part(static_cast<double>(column) / size, static_cast<double>(column + 1) / size));
    status = result.Status;
    this->Steps = std::max(this->Steps, result.Steps);
    for (std::size_t k = 0; k < this->Own.size(); ++k)
    {
      values(this->Unknowns[this->Own[k]], column) = found[static_cast<Eigen::Index>(k)];
    }
  }
  Eigen::VectorXd outcome(2);
  outcome << static_cast<double>(status), static_cast<double>(this->Steps);
  group.Max(outcome);
  this->Steps = static_cast<int>(outcome[1]);
  this->Rows->Update(values);
  this->Solution.resize(rightHandSide.rows(), rightHandSide.cols());
  for (std::size_t i = 0; i < this->Unknowns.size(); ++i)
  {
    this->Solution.row(static_cast<Eigen::Index>(i)) = values.row(this->Unknowns[i]);
  }
  return static_cast<SolverStatus>(static_cast<int>(outcome[0]));
}

std::size_t DistributedSolver::GetBytes() const
{
  // As of a MultigridSolver, with this rank's share of the entries.
  const double share = this->Entries > 0 ? 1.0 / this->Rows->GetRanks().GetSize() : 0.0;
  return TotalBytes(this->Unknowns, this->Own) + BytesOf(this->Solution) +
    static_cast<std::size_t>(12.0 * share * static_cast<double>(this->Entries)) +
    56 * this->Own.size();
}
}
