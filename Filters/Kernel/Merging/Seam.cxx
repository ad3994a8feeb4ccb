// SPDX-License-Identifier: BSD-3-Clause
#include "Merging/Seam.h"

#include "Base/Error.h"
#include "Mesh/Geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace cartan
{
namespace
{
/// A vertex of the common refinement of two polygons.
struct SeamNode
{
  double Place;    ///< along the target's polygon, in segments
  int Source = -1; ///< index in SeamLoop::Source, -1: none
  int Target = -1; ///< index in SeamLoop::Target, -1: none
};

/// In the order of the loop.
std::vector<SeamNode> CommonRefinement(const SeamLoop& loop)
{
  const std::vector<int> snapped = SnappedVertices(loop);
  std::vector<SeamNode> nodes;
  for (std::size_t t = 0; t < loop.Target.size(); ++t)
  {
    nodes.push_back({ static_cast<double>(t), -1, static_cast<int>(t) });
  }
  for (std::size_t s = 0; s < loop.Source.size(); ++s)
  {
    if (snapped[s] >= 0)
    {
      nodes[snapped[s]].Source = static_cast<int>(s);
    }
    else
    {
      const CurvePlace& place = loop.Places[s];
      nodes.push_back({ place.Segment + place.Fraction, static_cast<int>(s), -1 });
    }
  }
  std::stable_sort(nodes.begin(), nodes.end(),
    [](const SeamNode& a, const SeamNode& b) { return a.Place < b.Place; });
  return nodes;
}

/// The triangles of one side, split at their boundary edges.
class SplitFaces
{
public:
  SplitFaces(const TriangleMesh& mesh, const std::vector<int>& joinedIds)
    : Mesh(mesh)
  {
    const Triangles& triangles = mesh.GetTriangles();
    for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    {
      this->Faces.push_back(
        { joinedIds[triangles(t, 0)], joinedIds[triangles(t, 1)], joinedIds[triangles(t, 2)] });
      this->Originals.push_back(static_cast<int>(t));
    }
  }

  /// Splits the triangle at the boundary edge of `vertex` that has it on the left, which
  /// runs from one joined vertex to another, at those in between.
  void Split(int vertex, int from, int to, const std::vector<int>& between)
  {
    if (between.empty())
    {
      return;
    }
    const int triangle = this->Mesh.LeftTriangle(this->Mesh.RingBegin(vertex));
    std::vector<int>& parts = this->Parts.try_emplace(triangle, 1, triangle).first->second;
    // At the tip of an ear two edges of one triangle are split, one after the other.
    for (const int part : parts)
    {
      std::array<int, 3>& face = this->Faces[part];
      const auto corner =
        static_cast<std::size_t>(std::find(face.begin(), face.end(), from) - face.begin());
      if (corner < 3 && face[(corner + 1) % 3] == to)
      {
        const int apex = face[(corner + 2) % 3];
        face = { from, between[0], apex };
        for (std::size_t i = 0; i < between.size(); ++i)
        {
          parts.push_back(static_cast<int>(this->Faces.size()));
          this->Faces.push_back({ between[i], i + 1 < between.size() ? between[i + 1] : to, apex });
          this->Originals.push_back(triangle);
        }
        return;
      }
    }
  }

  std::vector<std::array<int, 3>> Faces;
  std::vector<int> Originals;

private:
  const TriangleMesh& Mesh;
  std::unordered_map<int, std::vector<int>> Parts; // of the triangles that were split
};

/// Splits the source's boundary edges, which run with the loop, at the vertices that are
/// the target's alone, and the target's, which run against it, at the source's.
void SplitAlong(const SeamLoop& loop, const std::vector<int>& joinedOfSource, SplitFaces& source,
  SplitFaces& target)
{
  const std::vector<SeamNode> nodes = CommonRefinement(loop);
  const auto size = static_cast<int>(nodes.size());
  const auto joined = [&](const SeamNode& node) {
    return node.Target >= 0 ? loop.Target[node.Target] : joinedOfSource[loop.Source[node.Source]];
  };
  for (int i = 0; i < size; ++i)
  {
    const auto nodesBetween = [&](int SeamNode::*side, int& end)
    {
      std::vector<int> between;
      for (end = (i + 1) % size; nodes[end].*side < 0; end = (end + 1) % size)
      {
        between.push_back(joined(nodes[end]));
      }
      return between;
    };
    int end = 0;
    if (nodes[i].Source >= 0)
    {
      const std::vector<int> between = nodesBetween(&SeamNode::Source, end);
      source.Split(loop.Source[nodes[i].Source], joined(nodes[i]), joined(nodes[end]), between);
    }
    if (nodes[i].Target >= 0)
    {
      std::vector<int> between = nodesBetween(&SeamNode::Target, end);
      std::reverse(between.begin(), between.end());
      target.Split(loop.Target[nodes[end].Target], joined(nodes[end]), joined(nodes[i]), between);
    }
  }
}

void RequireManifold(const JoinedSurface& joined)
{
  Triangles faces = joined.Faces;
  MeshReport report;
  TriangleMesh::Build(joined.NumberOfVertices(), std::move(faces), report);
  if (!report.IsManifold())
  {
    const std::string what = report.NonManifoldEdges.IsEmpty()
      ? report.NonManifoldVertices.Describe("point", "points") + " would not have one fan of"
      : report.NonManifoldEdges.Describe("edge", "edges") + " would have more than two";
    throw Error(ErrorCode::BadInput,
      "The surfaces cannot be sewn together: on the seam " + what +
        " triangles, because both surfaces cut the same corner there. Refine them at the boundary "
        "(Subdivide), or move the keys.");
  }
}

/// The vertices of both; `joinedOfSource` gets the numbers of the source's.
JoinedSurface JoinVertices(int numberOfTarget, int numberOfSource,
  const std::vector<SeamLoop>& loops, std::vector<int>& joinedOfSource)
{
  JoinedSurface joined;
  for (int v = 0; v < numberOfTarget; ++v)
  {
    joined.TargetVertices.push_back(v);
  }
  joined.SourceVertices.assign(numberOfTarget, -1);
  joined.IsSeam.assign(numberOfTarget, 0);
  joinedOfSource.assign(numberOfSource, -1);
  std::vector<char> isOnSeam(numberOfSource, 0);
  for (const SeamLoop& loop : loops)
  {
    const std::vector<int> snapped = SnappedVertices(loop);
    for (std::size_t s = 0; s < snapped.size(); ++s)
    {
      isOnSeam[loop.Source[s]] = 1;
      if (snapped[s] >= 0)
      {
        joinedOfSource[loop.Source[s]] = loop.Target[snapped[s]];
        joined.SourceVertices[loop.Target[snapped[s]]] = loop.Source[s];
      }
    }
    for (const int v : loop.Target)
    {
      joined.IsSeam[v] = 1;
    }
  }
  for (int v = 0; v < numberOfSource; ++v)
  {
    if (joinedOfSource[v] < 0)
    {
      joinedOfSource[v] = joined.NumberOfVertices();
      joined.TargetVertices.push_back(-1);
      joined.SourceVertices.push_back(v);
      joined.IsSeam.push_back(isOnSeam[v]);
    }
  }
  return joined;
}
}

std::vector<int> SnappedVertices(const SeamLoop& loop)
{
  const auto size = static_cast<int>(loop.Target.size());
  std::vector<int> takers(loop.Target.size(), -1);
  std::vector<double> distances(loop.Target.size(), SnapPart);
  for (std::size_t s = 0; s < loop.Places.size(); ++s)
  {
    const CurvePlace& place = loop.Places[s];
    const bool isNext = place.Fraction > 0.5;
    const int vertex = isNext ? (place.Segment + 1) % size : place.Segment;
    const double distance = isNext ? 1.0 - place.Fraction : place.Fraction;
    if (distance < distances[vertex])
    {
      distances[vertex] = distance;
      takers[vertex] = static_cast<int>(s);
    }
  }
  std::vector<int> snapped(loop.Places.size(), -1);
  for (int t = 0; t < size; ++t)
  {
    if (takers[t] >= 0)
    {
      snapped[takers[t]] = t;
    }
  }
  return snapped;
}

JoinedSurface JoinSurfaces(
  const TriangleMesh& target, const TriangleMesh& source, const std::vector<SeamLoop>& loops)
{
  std::vector<int> joinedOfSource;
  JoinedSurface joined =
    JoinVertices(target.NumberOfVertices(), source.NumberOfVertices(), loops, joinedOfSource);
  SplitFaces targetFaces(target, joined.TargetVertices);
  SplitFaces sourceFaces(source, joinedOfSource);
  for (const SeamLoop& loop : loops)
  {
    SplitAlong(loop, joinedOfSource, sourceFaces, targetFaces);
  }
  for (const SplitFaces* side : { &targetFaces, &sourceFaces })
  {
    const Eigen::Index before = joined.Faces.rows();
    joined.Faces.conservativeResize(before + static_cast<Eigen::Index>(side->Faces.size()), 3);
    for (std::size_t f = 0; f < side->Faces.size(); ++f)
    {
      const auto& [a, b, c] = side->Faces[f];
      joined.Faces.row(before + static_cast<Eigen::Index>(f)) << a, b, c;
      joined.IsSourceFace.push_back(side == &sourceFaces);
      joined.OriginalFaces.push_back(side->Originals[f]);
    }
  }
  RequireManifold(joined);
  return joined;
}

std::vector<int> SeamVertices(const JoinedSurface& joined)
{
  std::vector<int> vertices;
  for (int v = 0; v < joined.NumberOfVertices(); ++v)
  {
    if (joined.IsSeam[v])
    {
      vertices.push_back(v);
    }
  }
  return vertices;
}

SeamAngles MeasureSeam(const JoinedSurface& joined, const TriangleMesh& mesh, const Points& points)
{
  const Points areaVectors = TriangleAreaVectors(points, joined.Faces);
  SeamAngles angles;
  int count = 0;
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    const int left = mesh.LeftTriangle(d);
    const int right = mesh.LeftTriangle(mesh.Twin(d));
    if (left >= 0 && right >= 0 && joined.IsSourceFace[left] && !joined.IsSourceFace[right])
    {
      const Eigen::Vector3d a = areaVectors.row(left).transpose();
      const Eigen::Vector3d b = areaVectors.row(right).transpose();
      const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
      angles.Mean += angle;
      angles.Maximum = std::max(angles.Maximum, angle);
      ++count;
    }
  }
  angles.Mean /= std::max(count, 1);
  return angles;
}
}
