// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/DeformationInput.h"

#include "Bridge/PieceRegions.h"

#include <algorithm>

namespace cartan
{
DeformationInput ReadDeformationInput(FilterRun& run)
{
  DeformationInput input;
  input.Piece = run.Pieces() ? run.ReadPiece() : nullptr;
  input.TheSurface = input.Piece ? input.Piece->TheSurface : run.ReadSurface();
  return input;
}

std::shared_ptr<const Handles> KeepHandles(
  FilterRun& run, const DeformationInput& input, const std::string& name, const ContentKey& key)
{
  return run.Keep<Handles>(key,
    [&]
    {
      return std::make_unique<Handles>(input.Piece
          ? ReadPieceHandles(run.Input(), *input.Piece, *run.Pieces(), name)
          : ReadHandles(run.Input(), *input.TheSurface->Mesh, name));
    });
}

void RequirePiecesServe(FilterRun& run, const PieceSurface& piece, vtkIdType limit)
{
  RequireNoJoinedPoints(run);
  const std::int64_t slivers = CountSlivers(piece);
  if (slivers == 0)
  {
    return;
  }
  const std::string text = std::to_string(slivers) + " of its triangles are slivers";
  if (piece.TotalNumberOfPoints <= limit)
  {
    run.GatherInstead(text);
  }
  run.Warn("The surface is in pieces, and " + text +
    ", which only whole surfaces go without: the result may be rough around them. Remesh the "
    "surface, or raise GatherLimit if the first rank has the memory.");
}

std::vector<int> MovingHandles(const HandleArrays& arrays, const MotionsById& motions)
{
  std::vector<int> moving = arrays.MovingIds;
  for (const auto& entry : motions)
  {
    moving.push_back(entry.first);
  }
  std::sort(moving.begin(), moving.end());
  moving.erase(std::unique(moving.begin(), moving.end()), moving.end());
  return moving;
}
}
