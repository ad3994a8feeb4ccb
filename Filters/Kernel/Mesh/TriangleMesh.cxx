// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/TriangleMesh.h"

#include "Base/Bytes.h"
#include "Base/FloodFill.h"

#include <algorithm>

namespace cartan
{
namespace
{
/// Corner 3 t + c is vertex c of triangle t. These are the two vertices that
/// follow a corner's vertex in its triangle.
int FirstAfter(const Triangles& triangles, int corner)
{
  return triangles.data()[corner % 3 == 2 ? corner - 2 : corner + 1];
}
int SecondAfter(const Triangles& triangles, int corner)
{
  return triangles.data()[corner % 3 == 0 ? corner + 2 : corner - 1];
}

/// The corners of each vertex as a list: `last` (#V) has its last corner, and
/// `before` (3 #T) for each corner the one before it; -1 where there is none.
void ListCorners(
  const Triangles& triangles, std::vector<int>& last, std::vector<int>& before, MeshReport& report)
{
  const int numberOfVertices = static_cast<int>(last.size());
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    const auto corners = triangles.row(t);
    if (corners.minCoeff() < 0 || corners.maxCoeff() >= numberOfVertices)
    {
      report.OutOfRange.Add(t);
      continue;
    }
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
    {
      report.RepeatedVertex.Add(t);
    }
    for (int c = 0; c < 3; ++c)
    {
      const int corner = static_cast<int>(3 * t) + c;
      before[corner] = last[corners[c]];
      last[corners[c]] = corner;
    }
  }
}

/// A corner, and the two vertices that follow its vertex in its triangle.
struct Wedge
{
  int Corner;
  int First;
  int Second;
};

/// Walks the fan of triangles around one vertex after the other. The scratch
/// array makes each vertex cost its valence, however large, without hashing.
class FanWalker
{
public:
  FanWalker(int numberOfVertices, const Triangles& triangles)
    : Mesh(triangles)
    , Ends(numberOfVertices)
  {
  }

  /// Puts the corners of v, a list that ends with `last`, into counter-clockwise
  /// order, from the boundary edge with a triangle on its left, else from the
  /// first triangle. Adds to `report` the edges from v to larger vertices that
  /// have more than two triangles or two of the same direction, or v itself
  /// where its triangles are several fans. GetFan() means nothing then.
  void Walk(int v, int last, const std::vector<int>& before, MeshReport& report)
  {
    this->Unsorted.clear();
    for (int corner = last; corner >= 0; corner = before[corner])
    {
      this->Unsorted.push_back(
        { corner, FirstAfter(this->Mesh, corner), SecondAfter(this->Mesh, corner) });
    }
    std::reverse(this->Unsorted.begin(), this->Unsorted.end());
    for (std::size_t i = 0; i < this->Unsorted.size(); ++i)
    {
      End& first = this->Ends[this->Unsorted[i].First];
      End& second = this->Ends[this->Unsorted[i].Second];
      first.Place = static_cast<int>(i);
      first.Outgoing = Counted(first.Outgoing);
      second.Incoming = Counted(second.Incoming);
    }
    this->Order();
    if (!this->CheckEdges(v, report) && this->Fan.size() != this->Unsorted.size())
    {
      report.NonManifoldVertices.Add(v);
    }
  }

  const std::vector<Wedge>& GetFan() const { return this->Fan; }
  bool IsBoundary() const { return this->IsOpen; }

private:
  /// The edge to a neighbor of the vertex in question, as its triangles have it.
  struct End
  {
    int Place = -1;             // of the wedge on the edge's left
    unsigned char Outgoing = 0; // triangles that run through it from the vertex, up to 3
    unsigned char Incoming = 0; // and towards it
  };

  static unsigned char Counted(unsigned char count)
  {
    return static_cast<unsigned char>(std::min(count + 1, 3));
  }

  void Order()
  {
    const auto open = std::find_if(this->Unsorted.begin(), this->Unsorted.end(),
      [this](const Wedge& wedge) { return !this->Ends[wedge.First].Incoming; });
    this->IsOpen = open != this->Unsorted.end();
    const int start = this->IsOpen ? static_cast<int>(open - this->Unsorted.begin()) : 0;
    this->Fan.clear();
    for (int i = start; i >= 0 && this->Fan.size() < this->Unsorted.size();)
    {
      this->Fan.push_back(this->Unsorted[i]);
      i = this->Ends[this->Unsorted[i].Second].Place;
      if (i == start)
      {
        break;
      }
    }
  }

  /// Reports each bad edge once, at its smaller vertex, and clears the scratch
  /// array. Returns whether there is one at v.
  bool CheckEdges(int v, MeshReport& report)
  {
    bool isAnyBad = false;
    for (const Wedge& wedge : this->Unsorted)
    {
      for (const int w : { wedge.First, wedge.Second })
      {
        const End end = this->Ends[w];
        const int total = end.Outgoing + end.Incoming;
        if (total > 2 || end.Outgoing == 2 || end.Incoming == 2)
        {
          isAnyBad = true;
          if (v < w)
          {
            (total > 2 ? report.NonManifoldEdges : report.InconsistentEdges).Add(v);
          }
        }
        this->Ends[w] = {};
      }
    }
    return isAnyBad;
  }

  const Triangles& Mesh;
  std::vector<End> Ends; // #V, cleared outside of Walk
  std::vector<Wedge> Unsorted;
  std::vector<Wedge> Fan;
  bool IsOpen = false;
};
}

TriangleMesh TriangleMesh::Build(int numberOfVertices, Triangles&& triangles, MeshReport& report)
{
  if (triangles.rows() > MostTriangles)
  {
    report.TooManyTriangles = triangles.rows();
    return {};
  }
  std::vector<int> lastCorners(numberOfVertices, -1);
  std::vector<int> corners(triangles.size());
  ListCorners(triangles, lastCorners, corners, report);
  TriangleMesh mesh;
  if (report.OutOfRange.IsEmpty() && report.RepeatedVertex.IsEmpty())
  {
    mesh.MakeRings(corners, lastCorners, triangles, report);
  }
  if (!report.IsManifold())
  {
    return {};
  }
  mesh.MakeTwins(corners);
  mesh.FindComponents();
  mesh.Corners = std::move(triangles);
  return mesh;
}

TriangleMesh::TriangleMesh(int numberOfVertices, Triangles triangles)
{
  MeshReport report;
  *this = Build(numberOfVertices, std::move(triangles), report);
  if (!report.IsManifold())
  {
    throw Error(ErrorCode::BadInput, report.DescribeErrors());
  }
}

MeshReport TriangleMesh::Check(const Points& points, Triangles triangles)
{
  MeshReport report;
  CheckPositions(points, triangles, report);
  Build(static_cast<int>(points.rows()), std::move(triangles), report);
  return report;
}

/// While a vertex's ring is made, its corners' places in `corners` turn from a
/// list into the directed edges that leave from them, and RingTriangles holds
/// corners, for MakeTwins.
void TriangleMesh::MakeRings(std::vector<int>& corners, const std::vector<int>& lastCorners,
  const Triangles& triangles, MeshReport& report)
{
  const int numberOfVertices = static_cast<int>(lastCorners.size());
  this->RingOffsets.assign(1, 0);
  this->RingOffsets.reserve(static_cast<std::size_t>(numberOfVertices) + 1);
  this->Neighbors.reserve(triangles.size());
  this->RingTriangles.reserve(triangles.size());
  FanWalker walker(numberOfVertices, triangles);
  for (int v = 0; v < numberOfVertices; ++v)
  {
    if (lastCorners[v] < 0)
    {
      report.Unused.Add(v);
    }
    else
    {
      walker.Walk(v, lastCorners[v], corners, report);
      for (const Wedge& wedge : walker.GetFan())
      {
        corners[wedge.Corner] = this->NumberOfDirectedEdges();
        this->Neighbors.push_back(wedge.First);
        this->RingTriangles.push_back(wedge.Corner);
      }
      if (walker.IsBoundary())
      {
        this->Neighbors.push_back(walker.GetFan().back().Second);
        this->RingTriangles.push_back(-1);
      }
    }
    this->RingOffsets.push_back(this->NumberOfDirectedEdges());
  }
  this->Neighbors.shrink_to_fit();
  this->RingTriangles.shrink_to_fit();
}

/// The twin of v -> w leaves from w's corner in the triangle on the right, which
/// is the one before v's; without a triangle there it is the last edge of w.
void TriangleMesh::MakeTwins(const std::vector<int>& edgeOfCorner)
{
  this->Twins.resize(this->Neighbors.size());
  for (int v = 0; v < this->NumberOfVertices(); ++v)
  {
    int previous = this->IsUsed(v) ? this->RingTriangles[this->RingEnd(v) - 1] : -1;
    for (int d = this->RingBegin(v); d < this->RingEnd(v); ++d)
    {
      const int twinCorner = previous % 3 == 0 ? previous + 2 : previous - 1;
      this->Twins[d] =
        previous < 0 ? this->RingEnd(this->Neighbors[d]) - 1 : edgeOfCorner[twinCorner];
      previous = this->RingTriangles[d];
    }
  }
  for (int& corner : this->RingTriangles)
  {
    corner = corner < 0 ? -1 : corner / 3;
  }
}

void TriangleMesh::FindComponents()
{
  this->Components.assign(this->NumberOfVertices(), -1);
  for (int seed = 0; seed < this->NumberOfVertices(); ++seed)
  {
    if (!this->IsUsed(seed) || this->Components[seed] >= 0)
    {
      continue;
    }
    FloodFill(
      { seed },
      [this](int v)
      {
        const bool isNew = this->Components[v] < 0;
        this->Components[v] = isNew ? this->ComponentCount : this->Components[v];
        return isNew;
      },
      [this](int v, const auto& reach)
      {
        for (int d = this->RingBegin(v); d < this->RingEnd(v); ++d)
        {
          reach(this->Neighbors[d]);
        }
      });
    ++this->ComponentCount;
  }
}

std::size_t TriangleMesh::GetBytes() const
{
  return TotalBytes(this->Corners, this->RingOffsets, this->Neighbors, this->RingTriangles,
    this->Twins, this->NextInFan, this->Components);
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
