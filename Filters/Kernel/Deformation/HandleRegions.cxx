// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/HandleRegions.h"

#include "Base/FloodFill.h"
#include "Deformation/HandleLaplacian.h"

#include <algorithm>

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
}

bool HasPinnedHandle(const HandleProblem& problem)
{
  const std::vector<int> moving = MovingHandleOfVertices(problem);
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
}
