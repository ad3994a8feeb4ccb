// SPDX-License-Identifier: BSD-3-Clause
#include "Compression/TraversalOrder.h"

namespace cartan
{
namespace
{
class Walk
{
public:
  explicit Walk(const TriangleMesh& mesh)
    : Mesh(mesh)
    , IsDone(mesh.NumberOfTriangles(), 0)
    , Numbers(mesh.NumberOfVertices(), -1)
  {
    this->Order.Faces.resize(mesh.NumberOfTriangles(), 3);
    this->Order.Vertices.reserve(mesh.NumberOfVertices());
  }

  /// The component of the triangle on the left of `start`.
  void Visit(int start)
  {
    std::vector<int> passed = { start };
    while (!passed.empty())
    {
      int gate = passed.back();
      passed.pop_back();
      while (this->IsOpen(gate))
      {
        this->Add(gate);
        const int left = this->Mesh.Next(gate);
        const int right = this->Mesh.Next(this->Mesh.Twin(left));
        if (this->IsOpen(right) && this->IsOpen(left))
        {
          passed.push_back(left);
        }
        gate = this->IsOpen(right) ? right : left;
      }
    }
  }

  /// The order, with vertices in no triangle at its end.
  TraversalOrder Finish()
  {
    this->Order.NumberOfUsed = static_cast<int>(this->Order.Vertices.size());
    for (int v = 0; v < this->Mesh.NumberOfVertices(); ++v)
    {
      this->NumberOf(v);
    }
    return std::move(this->Order);
  }

private:
  /// Whether there is a triangle beyond the directed edge, not yet visited.
  bool IsOpen(int gate) const
  {
    const int triangle = this->Mesh.LeftTriangle(gate);
    return triangle >= 0 && !this->IsDone[triangle];
  }

  void Add(int gate)
  {
    this->IsDone[this->Mesh.LeftTriangle(gate)] = 1;
    const int from = this->NumberOf(this->Mesh.Origin(gate));
    const int to = this->NumberOf(this->Mesh.Neighbor(gate));
    const int apex = this->NumberOf(this->Mesh.Opposite(gate));
    this->Order.Faces.row(this->Count++) << from, to, apex;
  }

  int NumberOf(int v)
  {
    if (this->Numbers[v] < 0)
    {
      this->Numbers[v] = static_cast<int>(this->Order.Vertices.size());
      this->Order.Vertices.push_back(v);
    }
    return this->Numbers[v];
  }

  const TriangleMesh& Mesh;
  std::vector<char> IsDone;
  std::vector<int> Numbers;
  TraversalOrder Order;
  int Count = 0;
};
}

TraversalOrder OrderByTraversal(const TriangleMesh& mesh)
{
  Walk walk(mesh);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      walk.Visit(d);
    }
  }
  return walk.Finish();
}

Points TraversalOrder::Reordered(const Points& values) const
{
  Points reordered(values.rows(), 3);
  for (std::size_t i = 0; i < this->Vertices.size(); ++i)
  {
    reordered.row(static_cast<Eigen::Index>(i)) = values.row(this->Vertices[i]);
  }
  return reordered;
}
}
