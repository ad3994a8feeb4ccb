// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/SymmetricSolver.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace cartan
{
/// A table, such as one with a row per vertex, of which each of several processes
/// (*ranks*) has some rows: those that it owns, each of which has one owner, and copies
/// (*ghosts*) of others. What uses it computes on the rows that it has, and asks for the rest
/// here.
///
/// All functions but the first two are collective: all ranks call the same ones in the same
/// order, and where one cannot, all throw. They are how ranks wait for each other; nothing
/// else is.
class DistributedRows
{
public:
  virtual ~DistributedRows() = default;

  virtual bool IsOwned(int row) const = 0;

  /// The number of a row that all ranks know, for messages.
  virtual long long GetName(int row) const = 0;

  /// Gives ghosts the values that their owners have.
  virtual void UpdateGhosts(Eigen::Ref<Field> values) const = 0;

  /// Entry by entry over all ranks.
  virtual void Sum(Eigen::Ref<Eigen::VectorXd> values) const = 0;
  virtual void Max(Eigen::Ref<Eigen::VectorXd> values) const = 0;

  /// The lists of all ranks, one after the other.
  virtual std::vector<std::int64_t> Gather(const std::vector<std::int64_t>& values) const = 0;

  /// Solves for `rows` of this rank and those that others give. The matrices that it gets
  /// are between these rows: the owned ones must be complete, of ghosts nothing but their
  /// entries with owned ones matters. The same for right-hand sides; solutions are right
  /// at ghosts, too.
  virtual std::unique_ptr<SymmetricSolver> MakeSolver(const std::vector<int>& rows) const = 0;
};
}
