// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/CoincidentBorders.h"

#include "Mesh/CoincidentPoints.h"
#include "Mesh/Geometry.h"

#include <algorithm>
#include <array>
#include <vector>

namespace cartan
{
namespace
{
/// A border edge by the places of its ends, the smaller first.
struct BorderEdge
{
  std::array<int, 2> Places;
  std::array<int, 2> Ends;

  bool IsWith(const BorderEdge& other) const { return this->Places == other.Places; }
};

std::vector<int> BorderVertices(const TriangleMesh& mesh)
{
  std::vector<int> border;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsBoundary(v))
    {
      border.push_back(v);
    }
  }
  return border;
}

/// Of each of the vertices the first one in the same place: #V, -1 at the others.
std::vector<int> FindPlaces(const TriangleMesh& mesh, const Points& points,
  const std::vector<int>& vertices, const ExecutionContext& context)
{
  Points positions(static_cast<Eigen::Index>(vertices.size()), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    positions.row(static_cast<Eigen::Index>(i)) = points.row(vertices[i]);
  }
  const std::vector<int> first =
    FindCoincidentPoints(positions, std::vector<char>(vertices.size(), 1),
      CoincidentBorders::SamePlace * BoundingDiagonal(points, mesh.GetTriangles()), context);
  std::vector<int> place(mesh.NumberOfVertices(), -1);
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    place[vertices[i]] = vertices[first[i]];
  }
  return place;
}

/// Those with a length, sorted: edges in the same place follow one another.
std::vector<BorderEdge> SortBorderEdges(
  const TriangleMesh& mesh, const std::vector<int>& border, const std::vector<int>& place)
{
  std::vector<BorderEdge> edges;
  for (const int v : border)
  {
    // The ring's last edge has no triangle on its left, so the border goes along it.
    const int w = mesh.Neighbor(mesh.RingEnd(v) - 1);
    if (place[v] != place[w])
    {
      edges.push_back(place[v] < place[w] ? BorderEdge{ { place[v], place[w] }, { v, w } }
                                          : BorderEdge{ { place[w], place[v] }, { w, v } });
    }
  }
  std::sort(edges.begin(), edges.end(),
    [](const BorderEdge& a, const BorderEdge& b)
    { return a.Places != b.Places ? a.Places < b.Places : a.Ends < b.Ends; });
  return edges;
}
}

CoincidentBorders FindCoincidentBorders(
  const TriangleMesh& mesh, const Points& points, const ExecutionContext& context)
{
  CoincidentBorders result;
  const std::vector<int> border = BorderVertices(mesh);
  if (border.empty())
  {
    return result;
  }
  const std::vector<int> place = FindPlaces(mesh, points, border, context);
  const std::vector<BorderEdge> edges = SortBorderEdges(mesh, border, place);
  std::vector<char> isFound(mesh.NumberOfVertices(), 0);
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end)
  {
    for (end = i + 1; end < edges.size() && edges[end].IsWith(edges[i]);)
    {
      ++end;
    }
    if (end - i != 2)
    {
      continue;
    }
    result.NumberOfEdges += 2;
    for (int k = 0; k < 2; ++k)
    {
      if (edges[i].Ends[k] == edges[i + 1].Ends[k])
      {
        continue; // the tip of a slit
      }
      for (const int v : { edges[i].Ends[k], edges[i + 1].Ends[k] })
      {
        isFound[v] = 1;
        if (points.row(v) != points.row(place[v]))
        {
          result.RelativeTolerance = CoincidentBorders::SamePlace;
        }
      }
    }
  }
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (isFound[v])
    {
      result.Points.Add(v);
    }
  }
  return result;
}
}
