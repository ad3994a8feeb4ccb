// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/TriangleMesh.h"

#include "Base/Bytes.h"
#include "Mesh/Geometry.h"

#include <limits>

namespace cartan
{
namespace
{
/// The corners of all triangles, grouped by vertex with a counting sort. Corner
/// 3 t + c is vertex c of triangle t.
struct CornersByVertex
{
  CornersByVertex(int numberOfVertices, const Triangles& triangles)
    : Offsets(numberOfVertices + 1, 0)
    , Corners(triangles.size())
  {
    for (Eigen::Index corner = 0; corner < triangles.size(); ++corner)
    {
      ++this->Offsets[triangles.data()[corner] + 1];
    }
    for (int v = 0; v < numberOfVertices; ++v)
    {
      this->Offsets[v + 1] += this->Offsets[v];
    }
    std::vector<int> cursor(this->Offsets.begin(), this->Offsets.end() - 1);
    for (Eigen::Index corner = 0; corner < triangles.size(); ++corner)
    {
      this->Corners[cursor[triangles.data()[corner]]++] = static_cast<int>(corner);
    }
  }

  std::vector<int> Offsets; // #V + 1
  std::vector<int> Corners; // 3 #T
};

/// The two vertices that follow a corner's vertex in its triangle.
int FirstAfter(const Triangles& triangles, int corner)
{
  return triangles.data()[corner % 3 == 2 ? corner - 2 : corner + 1];
}
int SecondAfter(const Triangles& triangles, int corner)
{
  return triangles.data()[corner % 3 == 0 ? corner + 2 : corner - 1];
}

/// Walks the fan of triangles around one vertex after the other. The scratch
/// array makes each vertex cost its valence, however large, without hashing.
class FanWalker
{
public:
  FanWalker(int numberOfVertices, const Triangles& triangles)
    : Mesh(triangles)
    , Sorted(numberOfVertices, triangles)
    , CornerByFirst(numberOfVertices, -1)
    , IsSecond(numberOfVertices, 0)
  {
  }

  int CornerCount(int v) const { return this->Sorted.Offsets[v + 1] - this->Sorted.Offsets[v]; }

  /// Puts the corners of v into counter-clockwise order, from the boundary edge
  /// with a triangle on its left, else from the first triangle. The fan is
  /// shorter than CornerCount(v) when the triangles form several fans or an
  /// edge is used twice in one direction.
  void Walk(int v, std::vector<int>& fan, bool& isBoundary)
  {
    const int begin = this->Sorted.Offsets[v];
    const int end = this->Sorted.Offsets[v + 1];
    for (int i = begin; i < end; ++i)
    {
      const int corner = this->Sorted.Corners[i];
      this->CornerByFirst[FirstAfter(this->Mesh, corner)] = corner;
      this->IsSecond[SecondAfter(this->Mesh, corner)] = 1;
    }
    int start = this->Sorted.Corners[begin];
    isBoundary = false;
    for (int i = begin; i < end && !isBoundary; ++i)
    {
      const int corner = this->Sorted.Corners[i];
      if (!this->IsSecond[FirstAfter(this->Mesh, corner)])
      {
        start = corner;
        isBoundary = true;
      }
    }
    fan.clear();
    for (int corner = start; corner >= 0 && static_cast<int>(fan.size()) < end - begin;)
    {
      fan.push_back(corner);
      corner = this->CornerByFirst[SecondAfter(this->Mesh, corner)];
      if (corner == start)
      {
        break;
      }
    }
    for (int i = begin; i < end; ++i)
    {
      const int corner = this->Sorted.Corners[i];
      this->CornerByFirst[FirstAfter(this->Mesh, corner)] = -1;
      this->IsSecond[SecondAfter(this->Mesh, corner)] = 0;
    }
  }

  const CornersByVertex& GetSorted() const { return this->Sorted; }

private:
  const Triangles& Mesh;
  CornersByVertex Sorted;
  std::vector<int> CornerByFirst; // #V, -1 outside of Walk
  std::vector<char> IsSecond;     // #V, 0 outside of Walk
};

/// Counts, for each edge once (at its smaller vertex), its triangles and their
/// directions. Returns the vertices that touch a defective edge.
std::vector<char> CheckEdges(
  const CornersByVertex& sorted, const Triangles& triangles, MeshReport& report)
{
  const int numberOfVertices = static_cast<int>(sorted.Offsets.size()) - 1;
  std::vector<char> touched(numberOfVertices, 0);
  std::vector<int> outgoing(numberOfVertices, 0);
  std::vector<int> incoming(numberOfVertices, 0);
  for (int v = 0; v < numberOfVertices; ++v)
  {
    for (int i = sorted.Offsets[v]; i < sorted.Offsets[v + 1]; ++i)
    {
      ++outgoing[FirstAfter(triangles, sorted.Corners[i])];
      ++incoming[SecondAfter(triangles, sorted.Corners[i])];
    }
    for (int i = sorted.Offsets[v]; i < sorted.Offsets[v + 1]; ++i)
    {
      for (const int w :
        { FirstAfter(triangles, sorted.Corners[i]), SecondAfter(triangles, sorted.Corners[i]) })
      {
        const int total = outgoing[w] + incoming[w];
        if (total > 2 || outgoing[w] == 2 || incoming[w] == 2)
        {
          touched[v] = 1;
          if (v < w)
          {
            (total > 2 ? report.NonManifoldEdges : report.InconsistentEdges).Add(v);
          }
        }
        outgoing[w] = incoming[w] = 0;
      }
    }
  }
  return touched;
}

void CheckTopology(int numberOfVertices, const Triangles& triangles, MeshReport& report)
{
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    const auto corners = triangles.row(t);
    if (corners.minCoeff() < 0 || corners.maxCoeff() >= numberOfVertices)
    {
      report.OutOfRange.Add(t);
    }
    else if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
    {
      report.RepeatedVertex.Add(t);
    }
  }
  if (!report.OutOfRange.IsEmpty() || !report.RepeatedVertex.IsEmpty())
  {
    return;
  }
  FanWalker walker(numberOfVertices, triangles);
  const std::vector<char> touched = CheckEdges(walker.GetSorted(), triangles, report);
  std::vector<int> fan;
  bool isBoundary = false;
  for (int v = 0; v < numberOfVertices; ++v)
  {
    if (walker.CornerCount(v) == 0)
    {
      report.Unused.Add(v);
    }
    else if (!touched[v])
    {
      walker.Walk(v, fan, isBoundary);
      if (static_cast<int>(fan.size()) != walker.CornerCount(v))
      {
        report.NonManifoldVertices.Add(v);
      }
    }
  }
}

void CheckGeometry(const Points& points, const Triangles& triangles, MeshReport& report)
{
  for (Eigen::Index v = 0; v < points.rows(); ++v)
  {
    if (!points.row(v).allFinite())
    {
      report.NonFinite.Add(v);
    }
  }
  if (!report.OutOfRange.IsEmpty())
  {
    return;
  }
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    const Eigen::Vector3d a = points.row(triangles(t, 0));
    const Eigen::Vector3d b = points.row(triangles(t, 1));
    const Eigen::Vector3d c = points.row(triangles(t, 2));
    if (!HasArea((b - a).cross(c - a).norm(), LongestEdgeSquared(a, b, c)))
    {
      report.ZeroArea.Add(t);
    }
  }
}
}

bool MeshReport::IsUsable() const
{
  return this->OutOfRange.IsEmpty() && this->RepeatedVertex.IsEmpty() &&
    this->NonManifoldEdges.IsEmpty() && this->InconsistentEdges.IsEmpty() &&
    this->NonManifoldVertices.IsEmpty() && this->NonFinite.IsEmpty();
}

std::string MeshReport::DescribeErrors(const std::vector<long long>& cellIds) const
{
  std::string text;
  const auto add = [&text](const IdSample& sample, const char* singular, const char* plural,
                     const std::string& problem)
  {
    if (!sample.IsEmpty())
    {
      text += (text.empty() ? "" : " ") + sample.Describe(singular, plural) + problem;
    }
  };
  add(this->OutOfRange.Renamed(cellIds), "triangle", "triangles",
    " using a point that does not exist: repair the cells.");
  add(this->RepeatedVertex.Renamed(cellIds), "triangle", "triangles",
    " using a point twice: remove them, for example with the Clean filter.");
  add(this->NonFinite, "point", "points",
    " with a NaN or infinite coordinate: repair or remove them.");
  add(this->NonManifoldEdges, "edge", "edges",
    " with more than two triangles, ids of the first end points: split the surface there or "
    "remove the extra triangles.");
  add(this->InconsistentEdges, "edge", "edges",
    " between triangles of opposite orientation, ids of the first end points: orient the surface "
    "consistently, for example with Surface Normals (Consistency on).");
  add(this->NonManifoldVertices, "point", "points",
    " where several fans of triangles meet: duplicate these points, one for each fan.");
  return text;
}

MeshReport TriangleMesh::Check(const Points& points, const Triangles& triangles)
{
  MeshReport report;
  CheckTopology(static_cast<int>(points.rows()), triangles, report);
  CheckGeometry(points, triangles, report);
  return report;
}

TriangleMesh::TriangleMesh(int numberOfVertices, Triangles triangles)
  : Corners(std::move(triangles))
{
  // A triangle has three edges of two directions each when none is shared.
  if (this->Corners.rows() > std::numeric_limits<int>::max() / 6)
  {
    throw Error(ErrorCode::BadInput,
      "The surface has " + std::to_string(this->Corners.rows()) + " triangles; at most " +
        std::to_string(std::numeric_limits<int>::max() / 6) +
        " are supported: decimate or split it.");
  }
  MeshReport report;
  CheckTopology(numberOfVertices, this->Corners, report);
  if (!report.IsUsable())
  {
    throw Error(ErrorCode::BadInput, report.DescribeErrors());
  }

  this->RingOffsets.assign(1, 0);
  this->RingOffsets.reserve(numberOfVertices + 1);
  this->Neighbors.reserve(this->Corners.size());
  this->RingTriangles.reserve(this->Corners.size());
  FanWalker walker(numberOfVertices, this->Corners);
  std::vector<int> fan;
  for (int v = 0; v < numberOfVertices; ++v)
  {
    if (walker.CornerCount(v) > 0)
    {
      bool isBoundary = false;
      walker.Walk(v, fan, isBoundary);
      for (const int corner : fan)
      {
        this->Neighbors.push_back(FirstAfter(this->Corners, corner));
        this->RingTriangles.push_back(corner / 3);
      }
      if (isBoundary)
      {
        this->Neighbors.push_back(SecondAfter(this->Corners, fan.back()));
        this->RingTriangles.push_back(-1);
      }
    }
    this->RingOffsets.push_back(static_cast<int>(this->Neighbors.size()));
  }

  // Twins: group the directed edges by where they end; then, vertex by vertex,
  // meet them with the outgoing ones through a scratch array.
  const int numberOfDirectedEdges = this->NumberOfDirectedEdges();
  std::vector<int> incomingOffsets(numberOfVertices + 1, 0);
  for (const int neighbor : this->Neighbors)
  {
    ++incomingOffsets[neighbor + 1];
  }
  for (int v = 0; v < numberOfVertices; ++v)
  {
    incomingOffsets[v + 1] += incomingOffsets[v];
  }
  std::vector<int> incoming(numberOfDirectedEdges);
  std::vector<int> incomingOrigin(numberOfDirectedEdges);
  std::vector<int> cursor(incomingOffsets.begin(), incomingOffsets.end() - 1);
  for (int v = 0; v < numberOfVertices; ++v)
  {
    for (int d = this->RingBegin(v); d < this->RingEnd(v); ++d)
    {
      const int slot = cursor[this->Neighbors[d]]++;
      incoming[slot] = d;
      incomingOrigin[slot] = v;
    }
  }
  this->Twins.resize(numberOfDirectedEdges);
  std::vector<int> outgoing(numberOfVertices, -1);
  for (int v = 0; v < numberOfVertices; ++v)
  {
    for (int d = this->RingBegin(v); d < this->RingEnd(v); ++d)
    {
      outgoing[this->Neighbors[d]] = d;
    }
    for (int slot = incomingOffsets[v]; slot < incomingOffsets[v + 1]; ++slot)
    {
      this->Twins[incoming[slot]] = outgoing[incomingOrigin[slot]];
    }
  }

  this->Components.assign(numberOfVertices, -1);
  std::vector<int> stack;
  for (int seed = 0; seed < numberOfVertices; ++seed)
  {
    if (!this->IsUsed(seed) || this->Components[seed] >= 0)
    {
      continue;
    }
    this->Components[seed] = this->ComponentCount;
    stack.push_back(seed);
    while (!stack.empty())
    {
      const int v = stack.back();
      stack.pop_back();
      for (int d = this->RingBegin(v); d < this->RingEnd(v); ++d)
      {
        if (this->Components[this->Neighbors[d]] < 0)
        {
          this->Components[this->Neighbors[d]] = this->ComponentCount;
          stack.push_back(this->Neighbors[d]);
        }
      }
    }
    ++this->ComponentCount;
  }
}

std::size_t TriangleMesh::GetBytes() const
{
  return TotalBytes(this->Corners, this->RingOffsets, this->Neighbors, this->RingTriangles,
    this->Twins, this->Components);
}

std::vector<char> TriangleMesh::Grounded() const
{
  std::vector<char> isGrounded(this->Components.size());
  int next = 0;
  for (std::size_t v = 0; v < isGrounded.size(); ++v)
  {
    const bool isFirst = this->Components[v] == next;
    next += isFirst;
    isGrounded[v] = isFirst || this->Components[v] < 0;
  }
  return isGrounded;
}
}
