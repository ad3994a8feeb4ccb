// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/WidePiece.h"

#include "Distributed/TriangleMessages.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace cartan
{
namespace
{
/// Asks the owners of ghosts for all triangles around these; collective.
void AddTrianglesAround(SurfacePiece& piece, const std::vector<int>& ghosts)
{
  const auto size = static_cast<std::size_t>(piece.Group->GetSize());
  std::vector<std::vector<std::int64_t>> wanted(size);
  for (const int ghost : ghosts)
  {
    wanted[static_cast<std::size_t>(piece.Owners[ghost])].push_back(piece.GlobalIds[ghost]);
  }
  std::vector<std::vector<std::int64_t>> asked = piece.Group->Exchange(wanted);
  std::unordered_map<std::int64_t, std::vector<int>> ranksOfId;
  for (std::size_t rank = 0; rank < size; ++rank)
  {
    for (const std::int64_t id : asked[rank])
    {
      ranksOfId[id].push_back(static_cast<int>(rank));
    }
  }
  std::vector<std::vector<std::int64_t>> answers(size);
  std::vector<int> ranks;
  for (Eigen::Index t = 0; t < piece.Corners.rows(); ++t)
  {
    ranks.clear();
    for (int c = 0; c < 3; ++c)
    {
      const auto found = ranksOfId.find(piece.GlobalIds[piece.Corners(t, c)]);
      if (found != ranksOfId.end())
      {
        ranks.insert(ranks.end(), found->second.begin(), found->second.end());
      }
    }
    std::sort(ranks.begin(), ranks.end());
    ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
    for (const int rank : ranks)
    {
      AppendTriangle(piece, t, answers[rank]);
    }
  }
  std::vector<int> points(piece.GlobalIds.size());
  std::iota(points.begin(), points.end(), 0);
  TriangleReceiver(piece, points, true).Add(piece.Group->Exchange(answers));
}
}

std::shared_ptr<const DistributedMesh> WidenPiece(
  SurfacePiece& piece, std::shared_ptr<const DistributedMesh> mesh, const VerticesLookedAt& reach)
{
  std::vector<int> open; // owned vertices that may look at more than there is
  for (int v = 0; v < mesh->NumberOfPoints(); ++v)
  {
    if (mesh->IsOwned(v) && mesh->GetMesh()->IsUsed(v))
    {
      open.push_back(v);
    }
  }
  std::vector<char> isComplete;
  while (true)
  {
    isComplete.resize(static_cast<std::size_t>(mesh->NumberOfPoints()), 0);
    std::vector<int> wanted;
    std::vector<int> stillOpen;
    for (const int v : open)
    {
      const std::size_t before = wanted.size();
      for (const int w : reach(*mesh->GetMesh(), *mesh->GetPositions(), v))
      {
        const int point = mesh->Point(w);
        if (!mesh->IsOwned(point) && !isComplete[point])
        {
          wanted.push_back(point);
        }
      }
      if (wanted.size() > before)
      {
        stillOpen.push_back(v);
      }
    }
    open.swap(stillOpen);
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    if (!piece.Group->Any(!wanted.empty()))
    {
      return mesh;
    }
    AddTrianglesAround(piece, wanted);
    for (const int point : wanted)
    {
      isComplete[point] = 1;
    }
    mesh = std::make_shared<const DistributedMesh>(piece);
  }
}
}
