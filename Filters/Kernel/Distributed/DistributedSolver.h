// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/HypreMultigrid.h"
#include "Distributed/Halo.h"

namespace cartan
{
/// Conjugate gradients with hypre's multigrid, as MakeMultigridSolver has them, for rows on
/// several ranks, which may have none. All functions but the getters are collective. An
/// abort on one rank ends a solve on all after the next step.
class DistributedSolver : public SymmetricSolver
{
public:
  /// `rows` of the halo's tables are the unknowns, owned ones and ghosts.
  DistributedSolver(std::shared_ptr<const Halo> halo, std::vector<int> rows);
  ~DistributedSolver() override;
  DistributedSolver(const DistributedSolver&) = delete;
  DistributedSolver& operator=(const DistributedSolver&) = delete;

  SolverStatus Analyze(const SparseMatrix& lower) override;
  SolverStatus Factorize(const SparseMatrix& lower) override;
  SolverStatus Solve(const Eigen::Ref<const Eigen::MatrixXd>& rightHandSide,
    const ExecutionContext& context = {}) override;
  Eigen::Map<const Eigen::MatrixXd> GetSolution() const override
  {
    return { this->Solution.data(), this->Solution.rows(), this->Solution.cols() };
  }
  std::int64_t GetNumberOfEntries() const override { return this->Entries; }
  std::size_t GetBytes() const override;
  int GetNumberOfSteps() const override { return this->Steps; }

private:
  void Release();
  MatrixRows OwnRows(const SparseMatrix& lower) const;
  MultigridResult SolveColumn(const Eigen::VectorXd& rightHandSide,
    Eigen::Ref<Eigen::VectorXd> solution, const ExecutionContext& context);

  std::shared_ptr<const Halo> Rows;
  std::vector<int> Unknowns;
  std::vector<int> Own;                  ///< which of the unknowns this rank owns
  MPI_Comm Communicator = MPI_COMM_NULL; ///< of the ranks that own unknowns
  std::unique_ptr<HypreMultigrid> Levels;
  std::int64_t Entries = 0;
  int Steps = 0;
  Eigen::MatrixXd Solution;
};
}
