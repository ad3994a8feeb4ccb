// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/HandleRegions.h"

#include "Base/FloodFill.h"
#include "Deformation/HandleLaplacian.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

namespace cartan
{
namespace
{
/// Whether a vertex's handle holds it at all.
bool IsHeld(const HandleProblem& problem, int v)
{
  return problem.Handle[v] > 0 && problem.Mesh->IsUsed(v) &&
    (problem.SoftWeights.size() == 0 || problem.SoftWeights[v] > 0.0);
}

/// Whether a pinned handle holds anything that a moving handle's vertices reach over
/// any pieces.
bool HasPinnedHandleOnPieces(const HandleProblem& problem, const std::vector<int>& moving)
{
  const TriangleMesh& mesh = *problem.Mesh;
  std::vector<char> seeds(moving.size(), 0);
  std::vector<char> isUsed(moving.size(), 0);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    isUsed[v] = mesh.IsUsed(v);
    seeds[v] = isUsed[v] && moving[v] >= 0;
  }
  const std::vector<char> isReached = FloodPieces(mesh, problem.Pieces.get(), seeds, isUsed);
  Eigen::VectorXd hasPinned = Eigen::VectorXd::Zero(1);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (isReached[v] && moving[v] < 0 && IsHeld(problem, v))
    {
      hasPinned[0] = 1.0;
    }
  }
  problem.Pieces->Max(hasPinned);
  return hasPinned[0] > 0.0;
}
}

bool HasPinnedHandle(const HandleProblem& problem)
{
  const std::vector<int> moving = MovingHandleOfVertices(problem);
  if (problem.Pieces)
  {
    return HasPinnedHandleOnPieces(problem, moving);
  }
  const TriangleMesh& mesh = *problem.Mesh;
  std::vector<char> hasMoving(mesh.NumberOfComponents(), 0);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (moving[v] >= 0 && mesh.IsUsed(v))
    {
      hasMoving[mesh.Component(v)] = 1;
    }
  }
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (moving[v] < 0 && IsHeld(problem, v) && hasMoving[mesh.Component(v)])
    {
      return true;
    }
  }
  return false;
}

HandleRegions::HandleRegions(const HandleProblem& problem)
  : Regions(problem.Handle.size(), -1)
  , Moving(MovingHandleOfVertices(problem))
{
  const TriangleMesh& mesh = *problem.Mesh;
  const std::vector<char> isUnknown = UnknownVertices(problem, Hold::AllHandles);
  if (problem.Pieces)
  {
    this->FindOnPieces(problem, isUnknown);
    return;
  }
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (!isUnknown[v] || this->Regions[v] >= 0)
    {
      continue;
    }
    const int region = this->NumberOfRegions();
    std::vector<int> seen;
    const auto see = [&](int w)
    {
      if (IsHeld(problem, w) && (seen.empty() || seen.back() != this->Moving[w]))
      {
        seen.push_back(this->Moving[w]); // -1 is Pinned
      }
    };
    FloodFill(
      { v },
      [&](int w)
      {
        see(w);
        const bool isNew = isUnknown[w] && this->Regions[w] < 0;
        this->Regions[w] = isNew ? region : this->Regions[w];
        return isNew;
      },
      [&](int w, const auto& reach)
      {
        for (int d = mesh.RingBegin(w); d < mesh.RingEnd(w); ++d)
        {
          reach(mesh.Neighbor(d));
        }
      });
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    this->Handles.push_back(std::move(seen));
  }
}
/// Regions are numbered by the names of their parts, alike on all ranks.
void HandleRegions::FindOnPieces(const HandleProblem& problem, const std::vector<char>& isUnknown)
{
  const TriangleMesh& mesh = *problem.Mesh;
  const std::vector<long long> names = PartNames(mesh, *problem.Pieces, isUnknown);
  constexpr int NoHandle = Pinned - 1; // that a region is there
  std::set<std::pair<long long, int>> seen;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (names[v] < 0)
    {
      continue;
    }
    seen.emplace(names[v], NoHandle);
    const auto see = [&](int w)
    {
      if (IsHeld(problem, w))
      {
        seen.emplace(names[v], this->Moving[w]); // -1 is Pinned
      }
    };
    see(v);
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      see(mesh.Neighbor(d));
    }
  }
  std::vector<std::int64_t> pairs;
  for (const auto& [name, handle] : seen)
  {
    pairs.push_back(name);
    pairs.push_back(handle);
  }
  pairs = problem.Pieces->Gather(pairs);
  for (std::size_t i = 0; i < pairs.size(); i += 2)
  {
    seen.emplace(pairs[i], static_cast<int>(pairs[i + 1]));
  }
  std::map<long long, int> numbers;
  for (const auto& [name, handle] : seen)
  {
    if (handle == NoHandle)
    {
      numbers[name] = this->NumberOfRegions();
      this->Handles.emplace_back();
    }
    else
    {
      this->Handles.back().push_back(handle);
    }
  }
  for (std::size_t v = 0; v < names.size(); ++v)
  {
    this->Regions[v] = names[v] < 0 ? -1 : numbers[names[v]];
  }
}
}
