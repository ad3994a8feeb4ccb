// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/PieceMesh.h"

#include "Base/DisjointSets.h"
#include "Mesh/EdgeTable.h"
#include "Mesh/MeshCheck.h"

#include <algorithm>

namespace cartan
{
namespace
{
/// Global ids of what is wrong with this rank's own points and edges.
struct OwnDefects
{
  std::vector<std::int64_t> NonManifoldEdges;
  std::vector<std::int64_t> InconsistentEdges;
  std::vector<std::int64_t> NonManifoldVertices;
  std::vector<std::int64_t> NonFinite;
};

void RequireInRange(const SurfacePiece& piece)
{
  const std::string rank = "The piece of rank " + std::to_string(piece.Group->GetRank());
  const auto size = static_cast<std::size_t>(piece.Positions.rows());
  if (piece.GlobalIds.size() != size || piece.Owners.size() != size)
  {
    throw Error(
      ErrorCode::BadInput, rank + " needs a global id and an owner for each of its points.");
  }
  IdSample bad;
  for (std::size_t i = 0; i < size; ++i)
  {
    if (piece.GlobalIds[i] < 0 || piece.Owners[i] < 0 || piece.Owners[i] >= piece.Group->GetSize())
    {
      bad.Add(piece.GlobalIds[i]);
    }
  }
  for (Eigen::Index t = 0; t < piece.Corners.rows(); ++t)
  {
    const auto corners = piece.Corners.row(t);
    if (corners.minCoeff() < 0 || corners.maxCoeff() >= piece.Positions.rows() ||
      corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
    {
      throw Error(ErrorCode::BadInput,
        rank + " has triangles that use a point twice, or one that is not there.");
    }
  }
  if (!bad.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      rank + " has " + bad.Describe("point", "points") + " with no valid global id or owner.");
  }
}

/// Joins the corners at both ends of an edge over which the surface goes on.
void JoinOver(const EdgeTable& edges, int edge, DisjointSets& classes)
{
  const auto next = [](int corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; };
  const int a = edges.Begin(edge)[0];
  const int b = edges.Begin(edge)[1];
  classes.Join(a, next(b));
  classes.Join(next(a), b);
}

/// Finds bad edges, and the points at them; joins the corners over all others.
void CheckEdges(const SurfacePiece& piece, const std::vector<char>& isOwned, DisjointSets& classes,
  std::vector<char>& isAtBadEdge, OwnDefects& defects)
{
  const EdgeTable edges(static_cast<int>(piece.Positions.rows()), piece.Corners);
  for (int edge = 0; edge < edges.NumberOfEdges(); ++edge)
  {
    const int* sides = edges.Begin(edge);
    const int count = edges.NumberOfSides(edge);
    const int u = SideFrom(piece.Corners, sides[0]);
    const int v = SideTo(piece.Corners, sides[0]);
    const bool isContradiction = count == 2 && SideFrom(piece.Corners, sides[1]) == u;
    if (count == 2 && !isContradiction)
    {
      JoinOver(edges, edge, classes);
    }
    else if (count > 1)
    {
      isAtBadEdge[u] = 1;
      isAtBadEdge[v] = 1;
      const int first = piece.GlobalIds[u] < piece.GlobalIds[v] ? u : v;
      if (isOwned[first])
      {
        (isContradiction ? defects.InconsistentEdges : defects.NonManifoldEdges)
          .push_back(piece.GlobalIds[first]);
      }
    }
  }
}

/// The same message on all ranks.
void RequireNoDefects(const Ranks& group, const OwnDefects& defects)
{
  if (!group.Any(!defects.NonManifoldEdges.empty() || !defects.InconsistentEdges.empty() ||
        !defects.NonManifoldVertices.empty() || !defects.NonFinite.empty()))
  {
    return;
  }
  MeshReport report;
  report.NonManifoldEdges = group.Sample(defects.NonManifoldEdges);
  report.InconsistentEdges = group.Sample(defects.InconsistentEdges);
  report.NonManifoldVertices = group.Sample(defects.NonManifoldVertices);
  report.NonFinite = group.Sample(defects.NonFinite);
  group.Together(
    [&report]
    {
      throw Error(ErrorCode::BadInput,
        "The surface, whose points have global ids here, has " + report.DescribeErrors());
    });
}
}

PieceMesh MakePieceMesh(const SurfacePiece& piece)
{
  piece.Group->Together([&piece] { RequireInRange(piece); });
  const auto numberOfPoints = static_cast<std::size_t>(piece.Positions.rows());
  std::vector<char> isOwned(numberOfPoints);
  OwnDefects defects;
  for (std::size_t i = 0; i < numberOfPoints; ++i)
  {
    isOwned[i] = piece.Owners[i] == piece.Group->GetRank();
    if (isOwned[i] && !piece.Positions.row(static_cast<Eigen::Index>(i)).allFinite())
    {
      defects.NonFinite.push_back(piece.GlobalIds[i]);
    }
  }
  std::vector<char> isAtBadEdge(numberOfPoints, 0);
  DisjointSets classes(static_cast<int>(piece.Corners.size()));
  CheckEdges(piece, isOwned, classes, isAtBadEdge, defects);

  PieceMesh mesh{ piece.Corners, {} };
  std::vector<char> isTaken(numberOfPoints, 0);
  std::vector<int> idOfClass(static_cast<std::size_t>(piece.Corners.size()), -1);
  for (int corner = 0; corner < static_cast<int>(piece.Corners.size()); ++corner)
  {
    const int v = piece.Corners.data()[corner];
    int& id = idOfClass[classes.Find(corner)];
    if (id < 0 && !isTaken[v])
    {
      isTaken[v] = 1;
      id = v;
    }
    else if (id < 0)
    {
      id = static_cast<int>(numberOfPoints + mesh.CopyOf.size());
      mesh.CopyOf.push_back(v);
      if (isOwned[v] && !isAtBadEdge[v])
      {
        defects.NonManifoldVertices.push_back(piece.GlobalIds[v]);
        isAtBadEdge[v] = 1; // told once
      }
    }
    mesh.Corners.data()[corner] = id;
  }
  RequireNoDefects(*piece.Group, defects);
  return mesh;
}
}
