// SPDX-License-Identifier: BSD-3-Clause
#include "Base/CountingSort.h"
#include "Mesh/TriangleMesh.h"

#include <algorithm>
#include <array>

namespace cartan
{
namespace
{
/// Corner 3 t + c is vertex c of triangle t, and side 3 t + c runs from there to the
/// next corner.
int NextCorner(int corner)
{
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}
int CornerBefore(int corner)
{
  return corner % 3 == 0 ? corner + 2 : corner - 1;
}

/// The side on the other side of each side's edge; -1 at the border: 3 #T.
std::vector<int> FindMates(const TriangleMesh& mesh)
{
  std::vector<int> sideOfEdge(mesh.NumberOfDirectedEdges(), -1);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      const int t = mesh.LeftTriangle(d);
      if (t >= 0)
      {
        const auto corners = mesh.GetTriangles().row(t);
        sideOfEdge[d] = 3 * t + (corners[0] == v ? 0 : corners[1] == v ? 1 : 2);
      }
    }
  }
  std::vector<int> mates(mesh.GetTriangles().size(), -1);
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    if (sideOfEdge[d] >= 0)
    {
      mates[sideOfEdge[d]] = sideOfEdge[mesh.Twin(d)];
    }
  }
  return mates;
}

/// Makes an edge of each two sides of the border, and no third, that run in opposite
/// directions between the same vertices of `triangles`.
void CloseSeams(
  const Triangles& triangles, const std::vector<char>& isJoined, std::vector<int>& mates)
{
  const auto from = [&triangles](int side) { return triangles.data()[side]; };
  const auto to = [&triangles](int side) { return triangles.data()[NextCorner(side)]; };
  std::vector<std::array<int, 3>> border;
  for (int side = 0; side < triangles.size(); ++side)
  {
    if (mates[side] < 0 && (isJoined[from(side)] || isJoined[to(side)]))
    {
      border.push_back({ std::min(from(side), to(side)), std::max(from(side), to(side)), side });
    }
  }
  std::sort(border.begin(), border.end());
  for (std::size_t begin = 0, end = 0; begin < border.size(); begin = end)
  {
    while (end < border.size() && border[end][0] == border[begin][0] &&
      border[end][1] == border[begin][1])
    {
      ++end;
    }
    const int first = border[begin][2];
    const int second = border[end - 1][2];
    if (end - begin == 2 && from(first) == to(second))
    {
      mates[first] = second;
      mates[second] = first;
    }
  }
}
}

/// Adds the fan that begins with the corner `start` to the ring of its vertex.
/// RingTriangles holds corners while rings are made.
void TriangleMesh::AddFan(int start, const std::vector<int>& mates, std::vector<int>& edgeOfCorner)
{
  const int begin = this->NumberOfDirectedEdges();
  int corner = start;
  int last = start;
  do
  {
    edgeOfCorner[corner] = this->NumberOfDirectedEdges();
    this->Neighbors.push_back(this->Corners.data()[NextCorner(corner)]);
    this->RingTriangles.push_back(corner);
    this->NextInFan.push_back(this->NumberOfDirectedEdges());
    last = corner;
    corner = mates[CornerBefore(corner)];
  } while (corner >= 0 && corner != start);
  if (corner < 0)
  {
    this->Neighbors.push_back(this->Corners.data()[CornerBefore(last)]);
    this->RingTriangles.push_back(-1);
    this->NextInFan.push_back(-1);
  }
  else
  {
    this->NextInFan.back() = begin;
  }
}

/// Makes the ring of the next vertex, which has these corners.
void TriangleMesh::AddFans(
  const int* begin, const int* end, const std::vector<int>& mates, std::vector<int>& edgeOfCorner)
{
  constexpr int InOpenFan = -2;
  for (const int* start = begin; start != end; ++start)
  {
    for (int corner = mates[*start] < 0 ? *start : -1; corner >= 0;
         corner = mates[CornerBefore(corner)])
    {
      edgeOfCorner[corner] = InOpenFan;
    }
  }
  for (const int* start = begin; start != end; ++start)
  {
    if (edgeOfCorner[*start] == -1)
    {
      this->AddFan(*start, mates, edgeOfCorner);
    }
  }
  for (const int* start = begin; start != end; ++start)
  {
    if (mates[*start] < 0)
    {
      this->AddFan(*start, mates, edgeOfCorner);
    }
  }
  this->RingOffsets.push_back(this->NumberOfDirectedEdges());
}

TriangleMesh TriangleMesh::Joined(const std::vector<int>& joinedWith) const
{
  TriangleMesh joined;
  joined.Corners = this->Corners;
  std::vector<char> isJoined(joinedWith.size(), 0);
  for (std::size_t v = 0; v < joinedWith.size(); ++v)
  {
    isJoined[joinedWith[v]] = isJoined[joinedWith[v]] || joinedWith[v] != static_cast<int>(v);
  }
  for (int corner = 0; corner < joined.Corners.size(); ++corner)
  {
    joined.Corners.data()[corner] = joinedWith[this->Corners.data()[corner]];
  }
  std::vector<int> mates = FindMates(*this);
  CloseSeams(joined.Corners, isJoined, mates);

  std::vector<int> offsets;
  std::vector<int> corners; // of each vertex
  CountingSort(
    joinedWith.size(),
    [&joined](const auto& visit)
    {
      for (int corner = 0; corner < joined.Corners.size(); ++corner)
      {
        visit(joined.Corners.data()[corner], corner);
      }
    },
    offsets, corners);
  std::vector<int> edgeOfCorner(mates.size(), -1);
  for (std::size_t v = 0; v < joinedWith.size(); ++v)
  {
    joined.AddFans(
      corners.data() + offsets[v], corners.data() + offsets[v + 1], mates, edgeOfCorner);
  }
  joined.Twins.resize(joined.Neighbors.size());
  for (int side = 0; side < static_cast<int>(mates.size()); ++side)
  {
    // At the border, the twin is the last edge of the fan that the side's end is in.
    const int twin =
      mates[side] >= 0 ? edgeOfCorner[mates[side]] : edgeOfCorner[NextCorner(side)] + 1;
    joined.Twins[edgeOfCorner[side]] = twin;
    joined.Twins[twin] = edgeOfCorner[side];
  }
  for (int& corner : joined.RingTriangles)
  {
    corner = corner < 0 ? -1 : corner / 3;
  }
  joined.FindComponents();
  return joined;
}
}
