// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/PieceRegions.h"

#include "Bridge/PreparedSurface.h"

#include "vtkPolyData.h"

#include <algorithm>

namespace cartan
{
void RequireNoJoinedPoints(FilterRun& run)
{
  if (run.Pieces()->Any(ReadJoinedPoints(run.Input()).size() > 0))
  {
    run.GatherInstead(std::string("points are held together (") + JoinedPoints + ")");
  }
}

void GrowOverPieces(FilterRun& run, int rings, PointMask& mask)
{
  if (rings == 0 || !run.Pieces()->Any(std::count(mask.begin(), mask.end(), 1) > 0))
  {
    return;
  }
  RequireNoJoinedPoints(run);
  const auto piece = run.ReadPiece();
  const TriangleMesh& mesh = *piece->TheSurface->Mesh;
  Field isMarked = Field::Zero(mesh.NumberOfVertices(), 1);
  for (std::size_t v = 0; v < mask.size(); ++v)
  {
    isMarked(static_cast<Eigen::Index>(v), 0) = mask[v];
  }
  piece->Rows->UpdateGhosts(isMarked);
  // One ring at a time, as each may lead to another rank.
  for (int ring = 0; ring < rings; ++ring)
  {
    const Field before = isMarked;
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
      {
        isMarked(v, 0) = std::max(isMarked(v, 0), before(mesh.Neighbor(d), 0));
      }
    }
    piece->Rows->UpdateGhosts(isMarked); // their owners see whole rings
  }
  for (std::size_t v = 0; v < mask.size(); ++v)
  {
    mask[v] |= isMarked(static_cast<Eigen::Index>(v), 0) > 0.0 ? 1 : 0;
  }
}
}
