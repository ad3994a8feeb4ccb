// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/DistributedRows.h"
#include "Base/Bytes.h"
#include "Mesh/TriangleMesh.h"

namespace cartan
{
/// The connected components of a surface that is whole or in pieces, numbered from 0 in the
/// order of their first vertices, of pieces by the names of these: the same on all ranks. Sums
/// over a surface in pieces count each vertex, edge and triangle on one of the ranks that have
/// it. Mesh and pieces must outlive it.
class SurfaceComponents
{
public:
  explicit SurfaceComponents(const TriangleMesh& mesh)
    : Mesh(mesh)
    , Count(mesh.NumberOfComponents())
  {
  }

  /// Collective with `pieces`, which may be nothing.
  SurfaceComponents(const TriangleMesh& mesh, const DistributedRows* pieces);

  /// Of the whole.
  int GetCount() const { return this->Count; }

  /// The component of a vertex, -1 for unused ones.
  int OfVertex(int v) const { return this->Pieces ? this->Numbers[v] : this->Mesh.Component(v); }
  int OfTriangle(int t) const { return this->OfVertex(this->Mesh.GetTriangles()(t, 0)); }

  /// Whether sums count it here. A triangle is counted by the owner of its corner with the lowest
  /// name.
  bool CountsVertex(int v) const
  {
    return this->Mesh.IsUsed(v) && (!this->Pieces || this->Pieces->IsOwned(v));
  }
  bool CountsTriangle(int t) const;

  /// Over all ranks, entry by entry; the values themselves where the surface is whole. Collective.
  void Sum(Eigen::Ref<Eigen::VectorXd> values) const;
  void Max(Eigen::Ref<Eigen::VectorXd> values) const;

  std::size_t GetBytes() const { return TotalBytes(this->Numbers); }

private:
  const TriangleMesh& Mesh;
  const DistributedRows* Pieces = nullptr;
  int Count;
  std::vector<int> Numbers; // #V, of pieces
};
}
