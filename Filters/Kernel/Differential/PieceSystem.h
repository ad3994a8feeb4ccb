// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/DistributedRows.h"
#include "Mesh/TriangleMesh.h"

#include <functional>
#include <memory>
#include <vector>

namespace cartan
{
/// Marks what `seeds` (#V, non-zero at a seed) reach over edges between vertices that may
/// be entered, seeds only where they may be: #V. `passes` (may be empty) tells of each
/// directed edge whether it leads on. With `pieces` (may be nothing) over all of them,
/// collectively: a round of messages for each time that the way changes the rank.
std::vector<char> FloodPieces(const TriangleMesh& mesh, const DistributedRows* pieces,
  const std::vector<char>& seeds, const std::vector<char>& mayEnter,
  const std::function<bool(int edge)>& passes = {});

/// A number for each connected part of the vertices marked, the same on all ranks that have
/// some of it: the lowest name of its vertices (DistributedRows::GetName); -1 at others. #V.
/// Collective.
std::vector<long long> PartNames(
  const TriangleMesh& mesh, const DistributedRows& pieces, const std::vector<char>& isMarked);

/// Solves A x = b for unknowns that lie on several ranks. All functions are collective.
class PieceSystem
{
public:
  /// `lower` is the lower triangle between the `unknowns` (rows of `pieces`) of this rank,
  /// see DistributedRows::MakeSolver. Throws what RequireSolver throws.
  PieceSystem(const std::shared_ptr<const DistributedRows>& pieces,
    const std::vector<int>& unknowns, const SparseMatrix& lower);

  /// #unknowns x k, valid until the next solve. Throws Error(NotPositiveDefinite) when it
  /// is not finite.
  Eigen::Map<const Eigen::MatrixXd> Solve(
    const Eigen::Ref<const Eigen::MatrixXd>& rightHandSide, const ExecutionContext& context) const;

  int GetNumberOfSteps() const { return this->Solver->GetNumberOfSteps(); }
  std::size_t GetBytes() const { return this->Solver->GetBytes(); }

private:
  std::shared_ptr<const DistributedRows> Pieces;
  std::unique_ptr<SymmetricSolver> Solver;
  Eigen::Index TotalNumberOfUnknowns = 0;
};
}
