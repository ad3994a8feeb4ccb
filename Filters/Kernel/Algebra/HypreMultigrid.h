// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/SymmetricSolver.h"

#include <mpi.h>

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

/// hypre behind a door: only files that are compiled with it include this.
namespace cartan
{
/// hypre's errors and MPI's state belong to the process. A progress callback that runs
/// another solver between two steps comes back on the same thread.
std::recursive_mutex& HypreMutex();

/// Whether MPI and hypre are running, after an attempt to start them.
bool StartHypre();

/// What hypre's calls since the last status came to.
SolverStatus TakeHypreStatus();

/// Rows First, First + 1, ... of a square matrix, one after the other: how many entries
/// each has, and of each entry the column and the value.
struct MatrixRows
{
  std::int64_t First = 0;
  std::vector<int> Counts;
  std::vector<int> Columns;
  std::vector<double> Values;
};

/// The rows of a symmetric matrix of which the lower triangle is given.
MatrixRows RowsOfSymmetric(const SparseMatrix& lower);

/// Throws std::bad_alloc where there is not the memory that the levels of a matrix with so
/// many entries in this process take.
void RequireHypreMemory(std::size_t entries);

/// A symmetric positive definite matrix, of which each process of a communicator has some
/// rows, none may have no row, with the coarser levels of BoomerAMG. All functions are
/// called by all of the processes.
class HypreMultigrid
{
public:
  /// `rows` are released on the way. Where memory is missing, hypre ends the process: see
  /// RequireHypreMemory.
  HypreMultigrid(MPI_Comm communicator, MatrixRows&& rows);
  ~HypreMultigrid();

  /// A v.
  Eigen::VectorXd Apply(const Eigen::VectorXd& vector);

  /// A V-cycle for A x = r from x = 0.
  Eigen::VectorXd Precondition(const Eigen::VectorXd& residual);

  /// Of the matrices on all levels, and of this process' interpolations.
  std::int64_t CountEntries() const;

  /// Forgets hypre's objects, whose communicators are gone after MPI_Finalize.
  void Abandon();

private:
  class Objects;
  std::unique_ptr<Objects> Levels;
};

/// What several processes have of a number, put together; of one process, the number.
struct Reductions
{
  std::function<double(double)> Sum = [](double part) { return part; };
  std::function<double(double)> Max = [](double part) { return part; };
};

struct MultigridResult
{
  SolverStatus Status;
  int Steps; ///< of conjugate gradients
};

/// Solves A x = b by conjugate gradients with a V-cycle in each step, as MakeMultigridSolver
/// has it. `report` gets a fraction after each step.
MultigridResult SolveByMultigrid(HypreMultigrid& matrix, const Eigen::VectorXd& rightHandSide,
  Eigen::Ref<Eigen::VectorXd> solution, const std::function<void(double)>& report,
  const Reductions& reductions = {});

/// A vector with a part of each eigenvector, to try a matrix on: random numbers, the same
/// everywhere.
Eigen::VectorXd ProbeVector(Eigen::Index size);
}
