// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/PiecePair.h"

#include "Bridge/MatchedSurfaces.h"
#include "Bridge/PointArrays.h"

#include "vtkCellArray.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <limits>

namespace cartan
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();

/// Places of a point that ranks have may differ by this part of the size, as single precision
/// makes them.
constexpr double SamePointPart = 1e-5;

bool HasTrianglesAlone(vtkPolyData* surface)
{
  return surface->GetPolys()->GetMaxCellSize() <= 3 && surface->GetNumberOfStrips() == 0;
}

/// Throws on all ranks where some have found points of these names.
void RequireNoPoints(const PieceGroup& group, const DistributedRows& rows,
  const std::vector<std::int64_t>& names, const std::string& what, const std::string& advice)
{
  std::vector<std::int64_t> all = rows.Gather(names);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  IdSample bad;
  for (const std::int64_t name : all)
  {
    bad.Add(name);
  }
  group.Together(
    [&]
    {
      if (!bad.IsEmpty())
      {
        throw Error(ErrorCode::BadInput,
          "The input has " + bad.Describe("point", "points") + " " + what + ": " + advice);
      }
    });
}

/// The places of a piece's vertices in another surface of its points, those of ghosts as their
/// owners have them, about the middle of the box around the whole.
std::shared_ptr<const Points> PlacesOf(
  vtkPolyData* surface, const PieceSurface& piece, const PieceGroup& group)
{
  const TriangleMesh& mesh = *piece.TheSurface->Mesh;
  const DistributedRows& rows = *piece.Rows;
  const Points own = surface->GetNumberOfPoints() > 0 ? ReadPoints(surface) : Points::Zero(0, 3);
  auto places = std::make_shared<Points>(Points::Zero(mesh.NumberOfVertices(), 3));
  places->topRows(own.rows()) = own;
  rows.UpdateGhosts(*places);
  std::vector<std::int64_t> notFinite;
  Eigen::VectorXd extremes = Eigen::VectorXd::Constant(6, -Infinity); // of x and -x
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const Eigen::Vector3d place = places->row(v).transpose();
    if (mesh.IsUsed(v) && rows.IsOwned(v) && !place.allFinite())
    {
      notFinite.push_back(rows.GetName(v));
    }
    else if (mesh.IsUsed(v))
    {
      extremes.head<3>() = extremes.head<3>().cwiseMax(place);
      extremes.tail<3>() = extremes.tail<3>().cwiseMax(-place);
    }
  }
  RequireNoPoints(
    group, rows, notFinite, "with a NaN or infinite coordinate", "repair or remove them.");
  rows.Max(extremes);
  const double size = (extremes.head<3>() + extremes.tail<3>()).norm();
  const Eigen::RowVector3d center = 0.5 * (extremes.head<3>() - extremes.tail<3>()).transpose();
  std::vector<std::int64_t> apart;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const bool isUsed = mesh.IsUsed(v);
    if (isUsed && v < own.rows() && !((places->row(v) - own.row(v)).norm() <= SamePointPart * size))
    {
      apart.push_back(rows.GetName(v));
    }
    places->row(v) =
      isUsed ? Eigen::RowVector3d(places->row(v) - center) : Eigen::RowVector3d::Zero();
  }
  RequireNoPoints(group, rows, apart, "in different places on several ranks",
    "move the copies of a point together.");
  return places;
}
}

SurfacePair ReadPiecePair(FilterRun& run, const VerticesLookedAt& reach, const std::string& advice)
{
  const PieceGroup& group = *run.Pieces();
  vtkPolyData* input = run.Input(0);
  vtkPolyData* reference = run.Input(1);
  group.TogetherByRank([&] { RequireSameCells(input, "input", reference, "reference", advice); });
  if (group.Any(!HasTrianglesAlone(input)))
  {
    run.GatherInstead("some of its cells are not triangles");
  }
  const auto piece = run.ReadPiece(1, "reference", reach);
  const Surface& surface = *piece->TheSurface;
  return { surface.Mesh, surface.Cells, surface.Positions, PlacesOf(input, *piece, group),
    surface.Borders, surface.Key, piece->Rows };
}
}
