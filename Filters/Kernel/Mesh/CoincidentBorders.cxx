// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/CoincidentBorders.h"

#include "Mesh/CoincidentPoints.h"

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

double UsedDiagonal(const TriangleMesh& mesh, const Points& points)
{
  Eigen::AlignedBox3d box;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v))
    {
      box.extend(points.row(v).transpose());
    }
  }
  return box.diagonal().norm();
}

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
  Points positions(static_cast<Eigen::Index>(border.size()), 3);
  for (std::size_t i = 0; i < border.size(); ++i)
  {
    positions.row(static_cast<Eigen::Index>(i)) = points.row(border[i]);
  }
  const std::vector<int> first =
    FindCoincidentPoints(positions, std::vector<char>(border.size(), 1),
      CoincidentBorders::SamePlace * UsedDiagonal(mesh, points), context);
  std::vector<int> place(mesh.NumberOfVertices(), -1);
  for (std::size_t i = 0; i < border.size(); ++i)
  {
    place[border[i]] = border[first[i]];
  }

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
