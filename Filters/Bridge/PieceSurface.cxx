// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/PieceSurface.h"

#include "Bridge/HandleMotions.h"
#include "Bridge/PointArrays.h"
#include "Bridge/PolygonTriangles.h"
#include "Kernel/Deformation/Slivers.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#ifdef CARTAN_HAVE_PIECES
#include "Kernel/Distributed/DistributedMesh.h"
#include "Kernel/Distributed/LoosePiece.h"
#include "Kernel/Distributed/WidePiece.h"
#endif

#include <algorithm>
#include <array>
#include <map>

namespace cartan
{
std::size_t PieceSurface::GetBytes() const
{
  return this->TheSurface->GetBytes() + this->TheSurface->Mesh->GetBytes();
}

ContentKey KeyOfPiece(vtkPolyData* piece)
{
  ContentKey key = KeyOfSurface(piece);
  key.Add(KeyOfArray(piece->GetPointData()->GetGlobalIds()).GetValue());
  key.Add(
    KeyOfArray(piece->GetCellData()->GetArray(vtkDataSetAttributes::GhostArrayName())).GetValue());
  return key;
}

#ifdef CARTAN_HAVE_PIECES
namespace
{
/// The triangles of a piece, those of ghost cells apart.
struct PieceTriangles
{
  std::vector<int> Corners; ///< 3 #T
  std::vector<long long> CellIds;
  std::vector<int> GhostCorners;
  std::vector<long long> GhostCellIds;
  std::size_t Repeated = 0;
};

PieceTriangles CollectPieceTriangles(vtkPolyData* piece, const std::string& role)
{
  PieceTriangles triangles;
  if (piece->GetNumberOfPolys() + piece->GetNumberOfStrips() == 0)
  {
    return triangles;
  }
  auto* ghosts = vtkUnsignedCharArray::SafeDownCast(
    piece->GetCellData()->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
  const auto isGhost = [&](long long cell)
  {
    return ghosts && cell < ghosts->GetNumberOfTuples() &&
      (ghosts->GetValue(cell) & vtkDataSetAttributes::DUPLICATECELL) != 0;
  };
  const CellTriangles all = CollectTriangles(piece, role);
  triangles.Repeated = all.Repeated.GetCount();
  for (std::size_t t = 0; t < all.CellIds.size(); ++t)
  {
    const bool ghost = isGhost(all.CellIds[t]);
    std::vector<int>& corners = ghost ? triangles.GhostCorners : triangles.Corners;
    corners.insert(corners.end(), all.Corners.data() + 3 * t, all.Corners.data() + 3 * t + 3);
    (ghost ? triangles.GhostCellIds : triangles.CellIds).push_back(all.CellIds[t]);
  }
  return triangles;
}

LoosePiece MakeLoosePiece(
  vtkPolyData* piece, const PieceTriangles& triangles, const PieceGroup& group)
{
  LoosePiece loose;
  loose.Group = group.GetRanks();
  loose.Positions = piece->GetNumberOfPoints() > 0 ? ReadPoints(piece) : Points(Points::Zero(0, 3));
  loose.Corners = Eigen::Map<const Triangles>(
    triangles.Corners.data(), static_cast<Eigen::Index>(triangles.CellIds.size()), 3);
  vtkDataArray* ids = piece->GetPointData()->GetGlobalIds();
  if (ids && ids->GetNumberOfTuples() == piece->GetNumberOfPoints())
  {
    for (vtkIdType v = 0; v < ids->GetNumberOfTuples(); ++v)
    {
      loose.GlobalIds.push_back(static_cast<std::int64_t>(ids->GetTuple1(v)));
    }
  }
  return loose;
}

/// The cell of each triangle: own ones first, then those of other ranks.
std::vector<long long> CellsOfTriangles(
  vtkPolyData* piece, const PieceTriangles& triangles, const SurfacePiece& fitted)
{
  const auto keyOf = [&](const int* corners)
  {
    std::array<std::int64_t, 3> key{};
    for (int c = 0; c < 3; ++c)
    {
      key[c] = fitted.GlobalIds[corners[c]];
    }
    std::sort(key.begin(), key.end());
    return key;
  };
  std::map<std::array<std::int64_t, 3>, long long> ghosts;
  for (std::size_t t = 0; t < triangles.GhostCellIds.size(); ++t)
  {
    ghosts[keyOf(triangles.GhostCorners.data() + 3 * t)] = triangles.GhostCellIds[t];
  }
  std::vector<long long> cells = triangles.CellIds;
  for (auto t = static_cast<Eigen::Index>(cells.size()); t < fitted.Corners.rows(); ++t)
  {
    const auto found = ghosts.find(keyOf(fitted.Corners.data() + 3 * t));
    cells.push_back(found == ghosts.end() ? piece->GetNumberOfCells() : found->second);
  }
  return cells;
}

std::string DescribeOddCells(
  const std::string& role, std::size_t repeated, std::size_t withoutArea, const Ranks& ranks)
{
  Eigen::VectorXd counts(2);
  counts << static_cast<double>(repeated), static_cast<double>(withoutArea);
  ranks.Sum(counts);
  std::string text;
  const auto add = [&](double count, const std::string& what)
  {
    if (count > 0.0)
    {
      const auto number = static_cast<long long>(count);
      text += (text.empty() ? "The " : " The ") + role + " has " + std::to_string(number) +
        (number == 1 ? " cell" : " cells") + what;
    }
  };
  add(counts[0], " using a point twice; ignored.");
  add(counts[1], " without area.");
  return text;
}
}

std::unique_ptr<PieceSurface> ReadPiece(vtkPolyData* piece, const std::string& role,
  const PieceGroup& group, const VerticesLookedAt& reach, std::string& numbering,
  std::string& obstacle)
{
  const Ranks& ranks = *group.GetRanks();
  PieceTriangles triangles;
  LoosePiece loose;
  group.TogetherByRank(
    [&]
    {
      triangles = CollectPieceTriangles(piece, role);
      loose = MakeLoosePiece(piece, triangles, group);
    });
  const bool hasTriangles = ranks.Any(!triangles.CellIds.empty());
  ranks.Together(
    [&]
    {
      if (!hasTriangles)
      {
        CollectTriangles(nullptr, role);
      }
    });
  FittedPiece fitted = FitPiece(loose);
  numbering = fitted.HasGivenIds
    ? "Ids of points are their global ids."
    : "Ids count the points rank by rank: the pieces have no global ids.";
  obstacle = fitted.Obstacle;
  if (!obstacle.empty())
  {
    return nullptr;
  }
  auto mesh = std::make_shared<const DistributedMesh>(fitted.Piece);
  if (reach)
  {
    mesh = WidenPiece(fitted.Piece, mesh, reach);
  }
  auto cells = std::make_shared<Connectivity>();
  cells->CellIds = CellsOfTriangles(piece, triangles, fitted.Piece);
  auto surface = std::make_shared<Surface>();
  surface->Cells = cells;
  surface->Mesh = mesh->GetMesh();
  surface->Positions = mesh->GetPositions();
  surface->Origin = mesh->GetOrigin();
  surface->Key = KeyOfPiece(piece);
  MeshReport report;
  const auto ownTriangles = static_cast<Eigen::Index>(triangles.CellIds.size());
  CheckPositions(
    *surface->Positions, Triangles(surface->Mesh->GetTriangles().topRows(ownTriangles)), report);
  auto result = std::make_unique<PieceSurface>();
  result->Numbering = numbering;
  result->TheSurface = surface;
  result->Rows = mesh;
  result->Diagonal = mesh->GetDiagonal();
  result->TotalNumberOfPoints = mesh->GetTotalNumberOfPoints();
  result->Warning = DescribeOddCells(role, triangles.Repeated, report.ZeroArea.GetCount(), ranks);
  return result;
}

#else

// There is no group.
std::unique_ptr<PieceSurface> ReadPiece(vtkPolyData*, const std::string&, const PieceGroup&,
  const VerticesLookedAt&, std::string&, std::string&)
{
  return nullptr;
}

#endif

Handles ReadPieceHandles(
  vtkPolyData* piece, const PieceSurface& surface, const PieceGroup& group, const std::string& name)
{
  const TriangleMesh& mesh = *surface.TheSurface->Mesh;
  Handles handles;
  group.TogetherByRank(
    [&]
    {
      if (piece->GetNumberOfPoints() > 0)
      {
        handles = ReadHandles(piece, mesh, name);
      }
    });
  handles.OfVertex.resize(static_cast<std::size_t>(mesh.NumberOfVertices()), 0);
  Field values(mesh.NumberOfVertices(), 1);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    values(v, 0) = handles.OfVertex[v];
  }
  surface.Rows->UpdateGhosts(values);
  std::vector<std::int64_t> ids;
  Handles complete;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    complete.OfVertex.push_back(mesh.IsUsed(v) ? static_cast<int>(values(v, 0)) : 0);
    if (complete.OfVertex[v] > 0 && (ids.empty() || ids.back() != complete.OfVertex[v]))
    {
      ids.push_back(complete.OfVertex[v]);
    }
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  ids = surface.Rows->Gather(ids);
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  complete.Ids.assign(ids.begin(), ids.end());
  complete.GroupPoints();
  return complete;
}

Eigen::VectorXd ReadPieceWeights(vtkPolyData* piece, const PieceSurface& surface,
  const PieceGroup& group, const std::string& name, const Handles& handles)
{
  Field weights = Field::Zero(surface.TheSurface->Mesh->NumberOfVertices(), 1);
  group.TogetherByRank(
    [&]
    {
      if (piece->GetNumberOfPoints() > 0)
      {
        weights.col(0) = ReadSoftWeights(piece, name, handles);
      }
    });
  surface.Rows->UpdateGhosts(weights);
  return weights.col(0);
}

std::int64_t CountSlivers(const PieceSurface& surface)
{
  const TriangleMesh& mesh = *surface.TheSurface->Mesh;
  Eigen::VectorXd count = Eigen::VectorXd::Zero(1);
  for (const Sliver& sliver : FindSlivers(mesh, *surface.TheSurface->Positions))
  {
    // The owner of an end sees all triangles of the edge.
    count[0] +=
      surface.Rows->IsOwned(sliver.Vertex) || surface.Rows->IsOwned(mesh.Neighbor(sliver.Edge))
      ? 1.0
      : 0.0;
  }
  surface.Rows->Sum(count);
  return static_cast<std::int64_t>(count[0]);
}
}
