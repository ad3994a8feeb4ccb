// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/PieceSystem.h"

#include "Base/DisjointSets.h"

#include <algorithm>

namespace cartan
{
namespace
{
bool AnyOnRanks(const DistributedRows& pieces, bool value)
{
  Eigen::VectorXd flag = Eigen::VectorXd::Constant(1, value ? 1.0 : 0.0);
  pieces.Max(flag);
  return flag[0] > 0.0;
}

/// Of the vertices that other ranks have reached, those that are new here.
std::vector<int> ReachedElsewhere(const DistributedRows& pieces, const std::vector<char>& isReached)
{
  Field flags(static_cast<Eigen::Index>(isReached.size()), 1);
  std::copy(isReached.begin(), isReached.end(), flags.data());
  pieces.UpdateGhosts(flags);
  std::vector<int> fresh;
  for (std::size_t v = 0; v < isReached.size(); ++v)
  {
    if (!isReached[v] && flags.data()[v] > 0.0)
    {
      fresh.push_back(static_cast<int>(v));
    }
  }
  return fresh;
}
}

std::vector<char> FloodPieces(const TriangleMesh& mesh, const DistributedRows* pieces,
  const std::vector<char>& seeds, const std::vector<char>& mayEnter,
  const std::function<bool(int edge)>& passes)
{
  std::vector<char> isReached(seeds.size(), 0);
  std::vector<int> stack;
  const auto reach = [&](int v)
  {
    if (mayEnter[v] && !isReached[v])
    {
      isReached[v] = 1;
      stack.push_back(v);
    }
  };
  for (std::size_t v = 0; v < seeds.size(); ++v)
  {
    if (seeds[v])
    {
      reach(static_cast<int>(v));
    }
  }
  for (bool goesOn = true; goesOn;)
  {
    while (!stack.empty())
    {
      const int v = stack.back();
      stack.pop_back();
      for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
      {
        if (!passes || passes(d))
        {
          reach(mesh.Neighbor(d));
        }
      }
    }
    if (pieces)
    {
      for (const int v : ReachedElsewhere(*pieces, isReached))
      {
        reach(v);
      }
    }
    goesOn = pieces && AnyOnRanks(*pieces, !stack.empty());
  }
  return isReached;
}

std::vector<long long> PartNames(
  const TriangleMesh& mesh, const DistributedRows& pieces, const std::vector<char>& isMarked)
{
  const int numberOfVertices = mesh.NumberOfVertices();
  DisjointSets parts(numberOfVertices);
  for (int v = 0; v < numberOfVertices; ++v)
  {
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v) && isMarked[v]; ++d)
    {
      if (isMarked[mesh.Neighbor(d)])
      {
        parts.Join(v, mesh.Neighbor(d));
      }
    }
  }
  Field names(numberOfVertices, 1);
  for (int v = 0; v < numberOfVertices; ++v)
  {
    names(v, 0) = static_cast<double>(pieces.GetName(v));
  }
  std::vector<double> lowest(static_cast<std::size_t>(numberOfVertices));
  for (bool goesOn = true; goesOn;)
  {
    const Field before = names;
    std::copy(names.data(), names.data() + names.size(), lowest.begin());
    for (int v = 0; v < numberOfVertices; ++v)
    {
      double& ofPart = lowest[parts.Find(v)];
      ofPart = std::min(ofPart, names(v, 0));
    }
    for (int v = 0; v < numberOfVertices; ++v)
    {
      names(v, 0) = lowest[parts.Find(v)];
    }
    pieces.UpdateGhosts(names);
    goesOn = AnyOnRanks(pieces, names != before);
  }
  std::vector<long long> result(static_cast<std::size_t>(numberOfVertices), -1);
  for (int v = 0; v < numberOfVertices; ++v)
  {
    result[v] = isMarked[v] ? static_cast<long long>(names(v, 0)) : -1;
  }
  return result;
}

PieceSystem::PieceSystem(const std::shared_ptr<const DistributedRows>& pieces,
  const std::vector<int>& unknowns, const SparseMatrix& lower)
  : Pieces(pieces)
  , Solver(pieces->MakeSolver(unknowns))
{
  Eigen::VectorXd count = Eigen::VectorXd::Zero(1);
  for (const int v : unknowns)
  {
    count[0] += pieces->IsOwned(v) ? 1.0 : 0.0;
  }
  pieces->Sum(count);
  this->TotalNumberOfUnknowns = static_cast<Eigen::Index>(count[0]);
  RequireSolver(this->Solver->Analyze(lower), this->TotalNumberOfUnknowns);
  RequireSolver(this->Solver->Factorize(lower), this->TotalNumberOfUnknowns);
}

Eigen::Map<const Eigen::MatrixXd> PieceSystem::Solve(
  const Eigen::Ref<const Eigen::MatrixXd>& rightHandSide, const ExecutionContext& context) const
{
  RequireSolver(this->Solver->Solve(rightHandSide, context), this->TotalNumberOfUnknowns);
  if (AnyOnRanks(*this->Pieces, !this->Solver->GetSolution().allFinite()))
  {
    throw Error(ErrorCode::NotPositiveDefinite,
      "The system of " + std::to_string(this->TotalNumberOfUnknowns) +
        " unknowns has no finite solution: it is singular up to rounding.");
  }
  return this->Solver->GetSolution();
}
}
