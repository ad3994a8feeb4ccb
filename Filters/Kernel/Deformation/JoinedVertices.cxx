// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/JoinedVertices.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>

namespace cartan
{
namespace
{
/// Leaves those alone that have one of the same group as a neighbor: their triangle
/// would vanish.
void PartNeighbors(const TriangleMesh& mesh, std::vector<int>& joinedWith)
{
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      const int w = mesh.Neighbor(d);
      if (joinedWith[v] == joinedWith[w])
      {
        const int alone = joinedWith[v] == v ? w : v;
        joinedWith[alone] = alone;
      }
    }
  }
}

/// The vertices with an id in an order that puts those together that are one, the one
/// that stands for them first.
class Order
{
public:
  Order(const Eigen::VectorXd& ids, const HandleProblem& problem)
    : Ids(ids)
    , Problem(problem)
  {
    for (int v = 0; v < static_cast<int>(ids.size()); ++v)
    {
      if (ids[v] >= 0.0 && problem.Mesh->IsUsed(v))
      {
        this->Vertices.push_back(v);
      }
    }
    std::sort(this->Vertices.begin(), this->Vertices.end(),
      [this](int v, int w) { return this->Key(v) < this->Key(w); });
  }

  const std::vector<int>& GetVertices() const { return this->Vertices; }

  bool AreOne(int v, int w) const
  {
    return this->Ids[v] == this->Ids[w] && this->Problem.Rest->row(v) == this->Problem.Rest->row(w);
  }

private:
  std::array<double, 6> Key(int v) const
  {
    const auto place = this->Problem.Rest->row(v);
    const double isFree = this->Problem.Handle[v] > 0 ? 0.0 : 1.0;
    return { this->Ids[v], place[0], place[1], place[2], isFree, static_cast<double>(v) };
  }

  const Eigen::VectorXd& Ids;
  const HandleProblem& Problem;
  std::vector<int> Vertices;
};

/// Puts all that are held together into the handle of the first.
void ShareHandles(HandleProblem& problem)
{
  std::set<int> contested;
  for (std::size_t v = 0; v < problem.JoinedWith.size(); ++v)
  {
    const int first = problem.JoinedWith[v];
    if (problem.Handle[v] > 0 && problem.Handle[v] != problem.Handle[first])
    {
      contested.insert({ first, static_cast<int>(v) });
    }
    problem.Handle[v] = problem.Handle[first];
    if (problem.SoftWeights.size())
    {
      double& weight = problem.SoftWeights[first];
      weight = std::max(weight, problem.SoftWeights[static_cast<Eigen::Index>(v)]);
    }
  }
  if (!contested.empty())
  {
    IdSample sample;
    for (const int v : contested)
    {
      sample.Add(v);
    }
    throw Error(ErrorCode::BadInput,
      "Several handles have " + sample.Describe("point", "points") +
        " that JoinedPoints holds together: mark all copies of a point (equal CopyOf) with one "
        "handle, or turn JoinCopies of Prepare Surface off.");
  }
}
}

void HoldTogether(const Eigen::VectorXd& ids, HandleProblem& problem)
{
  const Order order(ids, problem);
  std::vector<int> joinedWith(problem.Handle.size());
  std::iota(joinedWith.begin(), joinedWith.end(), 0);
  bool isAnyJoined = false;
  for (std::size_t i = 1; i < order.GetVertices().size(); ++i)
  {
    const int before = order.GetVertices()[i - 1];
    const int v = order.GetVertices()[i];
    if (order.AreOne(before, v))
    {
      joinedWith[v] = joinedWith[before];
      isAnyJoined = true;
    }
  }
  if (isAnyJoined)
  {
    PartNeighbors(*problem.Mesh, joinedWith);
    problem.JoinedWith = std::move(joinedWith);
    ShareHandles(problem);
  }
}

void AddShares(const std::vector<int>& joinedWith, Eigen::VectorXd& shares)
{
  for (std::size_t v = 0; v < joinedWith.size(); ++v)
  {
    if (joinedWith[v] != static_cast<int>(v))
    {
      shares[joinedWith[v]] += shares[static_cast<Eigen::Index>(v)];
    }
  }
}

void ShareEvenly(const std::vector<int>& joinedWith, Eigen::VectorXd& values)
{
  Eigen::VectorXd copies = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(joinedWith.size()));
  AddShares(joinedWith, copies);
  for (std::size_t v = 0; v < joinedWith.size(); ++v)
  {
    if (joinedWith[v] != static_cast<int>(v))
    {
      values[static_cast<Eigen::Index>(v)] = values[joinedWith[v]] / copies[joinedWith[v]];
    }
  }
  for (Eigen::Index v = 0; v < copies.size(); ++v)
  {
    values[v] /= joinedWith[static_cast<std::size_t>(v)] == v ? copies[v] : 1.0;
  }
}

HandleProblem WithJoinedVertices(HandleProblem problem)
{
  if (problem.JoinedWith.empty())
  {
    return problem;
  }
  PartNeighbors(*problem.Mesh, problem.JoinedWith);
  problem.Parted = problem.Mesh;
  problem.Mesh = std::make_shared<const TriangleMesh>(problem.Parted->Joined(problem.JoinedWith));
  return problem;
}
}
