// SPDX-License-Identifier: BSD-3-Clause
#include "Algebra/ConstrainedSolver.h"

#include "Base/Bytes.h"
#include "Base/FloodFill.h"
#include "Base/FreedMemory.h"

#include <new>
#include <set>

namespace cartan
{
namespace
{
/// The part of the free unknowns that `seed` is connected with through entries
/// other than zero, and whether something determines it.
bool GatherPart(const SparseMatrix& matrix, const std::vector<char>& isFixed,
  const Eigen::VectorXd& stiffness, int seed, std::vector<char>& visited, std::vector<int>& part)
{
  bool isConstrained = false;
  part = FloodFill(
    { seed },
    [&](int unknown)
    {
      isConstrained = isConstrained || isFixed[unknown];
      const bool isNew = !isFixed[unknown] && !visited[unknown];
      visited[unknown] = 1;
      return isNew;
    },
    [&](int unknown, const auto& reach)
    {
      isConstrained = isConstrained || (stiffness.size() && stiffness[unknown] > 0.0);
      for (SparseMatrix::InnerIterator entry(matrix, unknown); entry; ++entry)
      {
        if (entry.value() != 0.0)
        {
          reach(static_cast<int>(entry.index()));
        }
      }
    });
  return isConstrained;
}

/// Refuses parts of the free unknowns that nothing determines.
void RequireConstraints(const SparseMatrix& matrix, const std::vector<char>& isFixed,
  const Eigen::VectorXd& stiffness, const std::vector<int>& vertices)
{
  const int size = static_cast<int>(matrix.rows());
  std::vector<char> visited(size, 0);
  std::vector<int> part;
  std::set<int> unconstrained; // a vertex may have unknowns in several parts
  int parts = 0;
  for (int seed = 0; seed < size; ++seed)
  {
    if (isFixed[seed] || visited[seed] ||
      GatherPart(matrix, isFixed, stiffness, seed, visited, part))
    {
      continue;
    }
    ++parts;
    for (const int unknown : part)
    {
      unconstrained.insert(vertices.empty() ? unknown : vertices[unknown]);
    }
  }
  if (parts > 0)
  {
    IdSample sample;
    for (const int vertex : unconstrained)
    {
      sample.Add(vertex);
    }
    throw Error(ErrorCode::SingularSystem,
      "The system is singular: " + sample.Describe("point", "points") + " in " +
        std::to_string(parts) +
        (parts == 1 ? " connected part have no constraint. Fix"
                    : " connected parts have no constraint. In each part, fix") +
        " at least one point.");
  }
}

/// The status of a solver's step, which may also run out of memory.
template <typename Action>
SolverStatus RunStep(const Action& action)
{
  try
  {
    return action();
  }
  catch (const std::bad_alloc&)
  {
    return SolverStatus::OutOfMemory;
  }
}

SolverBackend DirectUnlessNamed(SolverBackend backend)
{
  return backend != SolverBackend::Automatic ? backend
    : HasCholmod()                           ? SolverBackend::Cholmod
                                             : SolverBackend::Eigen;
}

/// A number that differs where the pattern of a matrix does, but for one in 2^64, and is not
/// 0. The pattern itself would take a tenth of the factor's memory.
std::uint64_t FingerprintOf(const SparseMatrix& matrix)
{
  std::uint64_t fingerprint = static_cast<std::uint64_t>(matrix.rows());
  const auto add = [&fingerprint](const int* values, Eigen::Index count)
  {
    for (Eigen::Index i = 0; i < count; ++i)
    {
      // An odd number near 2^64 over the golden ratio; the shift brings high bits down.
      fingerprint = (fingerprint ^ static_cast<std::uint64_t>(values[i])) * 0x9e3779b97f4a7c15;
      fingerprint ^= fingerprint >> 32;
    }
  };
  add(matrix.outerIndexPtr(), matrix.outerSize() + 1);
  add(matrix.innerIndexPtr(), matrix.nonZeros());
  return fingerprint | 1;
}
}

ConstrainedSolver::ConstrainedSolver(SolverBackend backend, const FactorLimits& limits)
  : Asked(backend)
  , Limits(limits)
  , Backend(DirectUnlessNamed(backend))
  , Solver(MakeSymmetricSolver(backend, limits))
{
}

ConstrainedSolver::~ConstrainedSolver() = default;
ConstrainedSolver::ConstrainedSolver(ConstrainedSolver&&) noexcept = default;
ConstrainedSolver& ConstrainedSolver::operator=(ConstrainedSolver&&) noexcept = default;

void ConstrainedSolver::NumberFree(const std::vector<char>& isFixed)
{
  this->Free.clear();
  this->FreeIndex.assign(isFixed.size(), -1);
  for (std::size_t unknown = 0; unknown < isFixed.size(); ++unknown)
  {
    if (!isFixed[unknown])
    {
      this->FreeIndex[unknown] = static_cast<int>(this->Free.size());
      this->Free.push_back(static_cast<int>(unknown));
    }
  }
}

/// The lower triangle of A_ff + diag s_f; keeps A_fc. Both are column by
/// column with sorted rows, ready to use.
SparseMatrix ConstrainedSolver::SplitBlocks(
  const SparseMatrix& matrix, const Eigen::VectorXd& stiffness)
{
  const auto numberOfFree = static_cast<Eigen::Index>(this->Free.size());
  SparseMatrix block(numberOfFree, numberOfFree);
  block.reserve(matrix.nonZeros() / 2 + numberOfFree);
  this->Coupling = SparseMatrix(numberOfFree, matrix.cols());
  for (Eigen::Index column = 0; column < matrix.cols(); ++column)
  {
    const int freeColumn = this->FreeIndex[column];
    if (freeColumn >= 0)
    {
      block.startVec(freeColumn);
    }
    this->Coupling.startVec(column);
    for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry)
    {
      const int freeRow = this->FreeIndex[entry.index()];
      if (freeRow < 0)
      {
        continue;
      }
      if (freeColumn < 0)
      {
        this->Coupling.insertBack(freeRow, column) = entry.value();
      }
      else if (entry.index() >= column)
      {
        const bool onDiagonal = entry.index() == column;
        block.insertBack(freeRow, freeColumn) =
          entry.value() + (onDiagonal && stiffness.size() ? stiffness[column] : 0.0);
      }
    }
  }
  block.finalize();
  this->Coupling.finalize();
  return block;
}

SolverStatus ConstrainedSolver::FactorizeAs(SolverBackend backend, const SparseMatrix& block,
  bool isAnalyzed, const ExecutionContext& context)
{
  if (backend != this->Backend)
  {
    this->Solver = MakeSymmetricSolver(backend, this->Limits);
    this->Backend = backend;
    isAnalyzed = false;
  }
  SolverStatus status = SolverStatus::Ok;
  if (!isAnalyzed)
  {
    ++this->Analyses;
    status =
      RunStep([&]() { return block.rows() > 0 ? this->Solver->Analyze(block) : SolverStatus::Ok; });
  }
  context.Report(0.4);
  if (status != SolverStatus::Ok)
  {
    return status;
  }
  ++this->Factorizations;
  return RunStep(
    [&]() { return block.rows() > 0 ? this->Solver->Factorize(block) : SolverStatus::Ok; });
}

void ConstrainedSolver::Factorize(const SparseMatrix& matrix, const std::vector<char>& isFixed,
  const Eigen::VectorXd& stiffness, const std::vector<int>& vertices,
  const ExecutionContext& context)
{
  RequireConstraints(matrix, isFixed, stiffness, vertices);
  context.Report(0.1);
  this->NumberFree(isFixed);
  this->FactorizeFree(this->SplitBlocks(matrix, stiffness), context);
}

void ConstrainedSolver::Factorize(SparseMatrix&& matrix, const std::vector<char>& isFixed,
  const Eigen::VectorXd& stiffness, const std::vector<int>& vertices,
  const ExecutionContext& context)
{
  RequireConstraints(matrix, isFixed, stiffness, vertices);
  context.Report(0.1);
  this->NumberFree(isFixed);
  const SparseMatrix block = this->SplitBlocks(matrix, stiffness);
  SparseMatrix().swap(matrix); // Eigen has no move of sparse matrices
  this->FactorizeFree(block, context);
}

/// `block` is the lower triangle of A_ff + diag s_f.
void ConstrainedSolver::FactorizeFree(const SparseMatrix& block, const ExecutionContext& context)
{
  const Eigen::Index numberOfFree = block.rows();
  constexpr Eigen::Index large = 1000000; // whose factorization takes much longer
  if (block.nonZeros() > large)
  {
    ReturnFreedMemory();
  }
  const std::uint64_t pattern = FingerprintOf(block);
  const bool isAnalyzed = pattern == this->Pattern;
  // None until it is factorized: the next call must not reuse what a failure
  // leaves behind.
  this->Pattern = 0;
  const bool isLarge = this->Asked == SolverBackend::Automatic && HasHypre() &&
    numberOfFree > this->Limits.DirectUnknowns;
  SolverStatus status = SolverStatus::NotConverged;
  if (isLarge)
  {
    status = this->FactorizeAs(SolverBackend::ConjugateGradients, block, isAnalyzed, context);
  }
  // Also where the iteration does not solve such a matrix. Factors take more memory.
  if (status != SolverStatus::Ok && status != SolverStatus::OutOfMemory)
  {
    status = this->FactorizeAs(DirectUnlessNamed(this->Asked), block, isAnalyzed, context);
  }
  RequireSolver(status, numberOfFree);
  this->Pattern = pattern;
  context.Report(1.0);
}

std::size_t ConstrainedSolver::GetBytes() const
{
  return (this->Solver ? this->Solver->GetBytes() : 0) +
    TotalBytes(this->Free, this->FreeIndex, this->Coupling);
}

Eigen::Map<const Eigen::MatrixXd> ConstrainedSolver::SolveFree(
  const Eigen::Ref<const Eigen::MatrixXd>& rightHandSide, const ExecutionContext& context) const
{
  if (this->Free.empty())
  {
    return { nullptr, 0, rightHandSide.cols() };
  }
  RequireSolver(
    RunStep([&]() { return this->Solver->Solve(rightHandSide, context); }), rightHandSide.rows());
  if (!this->Solver->GetSolution().allFinite())
  {
    throw Error(ErrorCode::NotPositiveDefinite,
      "The system of " + std::to_string(this->Free.size()) +
        " unknowns has no finite solution: it is singular up to rounding.");
  }
  return this->Solver->GetSolution();
}

void ConstrainedSolver::Solve(const Eigen::Ref<const Field>& rightHandSide,
  Eigen::Ref<Field> values, const ExecutionContext& context) const
{
  Eigen::MatrixXd reduced = -(this->Coupling * values);
  for (std::size_t i = 0; rightHandSide.size() && i < this->Free.size(); ++i)
  {
    reduced.row(i) += rightHandSide.row(this->Free[i]);
  }
  const Eigen::Map<const Eigen::MatrixXd> solution = this->SolveFree(reduced, context);
  for (std::size_t i = 0; i < this->Free.size(); ++i)
  {
    values.row(this->Free[i]) = solution.row(i);
  }
}
}
