// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/MatchedPieces.h"

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
  const std::vector<std::int64_t>& names, const std::string& role, const std::string& what)
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
          "The " + role + " has " + bad.Describe("point", "points") + " " + what);
      }
    });
}

/// The places of the model's vertices in another surface of its points, those of ghosts as their
/// owners have them, about `origin`, which becomes the middle of the box around the whole.
std::shared_ptr<const Points> PlacesOf(vtkPolyData* surface, const std::string& role,
  const PieceSurface& piece, const PieceGroup& group, Eigen::Vector3d& origin)
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
    group, rows, notFinite, role, "with a NaN or infinite coordinate: repair or remove them.");
  rows.Max(extremes);
  const double size = (extremes.head<3>() + extremes.tail<3>()).norm();
  origin = 0.5 * (extremes.head<3>() - extremes.tail<3>());
  std::vector<std::int64_t> apart;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const bool isUsed = mesh.IsUsed(v);
    if (isUsed && v < own.rows() && !((places->row(v) - own.row(v)).norm() <= SamePointPart * size))
    {
      apart.push_back(rows.GetName(v));
    }
    places->row(v) =
      isUsed ? Eigen::RowVector3d(places->row(v) - origin.transpose()) : Eigen::RowVector3d::Zero();
  }
  RequireNoPoints(group, rows, apart, role,
    "in different places on several ranks: move the copies of a point together.");
  return places;
}
}

MatchedPieces ReadMatchedPieces(FilterRun& run, const std::vector<vtkPolyData*>& surfaces,
  const std::vector<std::string>& roles, std::size_t model, const VerticesLookedAt& reach,
  const std::string& advice)
{
  const PieceGroup& group = *run.Pieces();
  group.TogetherByRank(
    [&]
    {
      for (std::size_t k = 1; k < surfaces.size(); ++k)
      {
        RequireSameCells(surfaces[0], roles[0], surfaces[k], roles[k], advice);
      }
    });
  if (group.Any(!HasTrianglesAlone(surfaces[0])))
  {
    run.GatherInstead("some of its cells are not triangles");
  }
  MatchedPieces pieces;
  pieces.Model = run.ReadPiece(surfaces[model], roles[model], reach);
  const Surface& surface = *pieces.Model->TheSurface;
  MatchedSurfaces& matched = pieces.Matched;
  matched.Mesh = surface.Mesh;
  matched.Cells = surface.Cells;
  for (std::size_t k = 0; k < surfaces.size(); ++k)
  {
    Eigen::Vector3d origin = surface.Origin;
    matched.Positions.push_back(k == model
        ? surface.Positions
        : PlacesOf(surfaces[k], roles[k], *pieces.Model, group, origin));
    matched.Origins.push_back(origin);
  }
  return pieces;
}
}
