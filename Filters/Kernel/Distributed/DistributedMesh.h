// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/DistributedRows.h"
#include "Distributed/Halo.h"
#include "Mesh/TriangleMesh.h"

namespace cartan
{
/// A surface in pieces: this rank's piece as a mesh, and the rows of tables with a row per
/// vertex of it. The piece's points are the first vertices, in their order; vertices after
/// them repeat ghosts around which the piece has several fans of triangles.
///
/// What a sum over the ring of a vertex needs is here for each owned vertex.
class DistributedMesh : public DistributedRows
{
public:
  /// Collective. Throws on all ranks, with one message that names global ids, where the
  /// pieces do not make an oriented manifold (see MakePieceMesh).
  explicit DistributedMesh(const SurfacePiece& piece);

  const std::shared_ptr<const TriangleMesh>& GetMesh() const { return this->Mesh; }

  /// Relative to the origin: #V x 3. Those of points in no triangle are zero.
  const std::shared_ptr<const Points>& GetPositions() const { return this->Positions; }

  /// The middle of the box around the whole surface.
  const Eigen::Vector3d& GetOrigin() const { return this->Origin; }

  /// The diagonal of that box.
  double GetDiagonal() const { return this->Diagonal; }

  int NumberOfVertices() const { return this->Rows->NumberOfRows(); }
  int NumberOfPoints() const { return static_cast<int>(this->Names.size()); }

  /// The point of the piece that a vertex is.
  int Point(int vertex) const
  {
    return vertex < this->NumberOfPoints()
      ? vertex
      : this->CopyOf[static_cast<std::size_t>(vertex - this->NumberOfPoints())];
  }

  /// Of all ranks.
  std::int64_t GetTotalNumberOfPoints() const { return this->TotalNumberOfPoints; }

  const Ranks& GetRanks() const { return this->Rows->GetRanks(); }

  bool IsOwned(int row) const override { return this->Rows->IsOwned(row); }
  long long GetName(int row) const override
  {
    return this->Names[static_cast<std::size_t>(this->Point(row))];
  }
  void UpdateGhosts(Eigen::Ref<Field> values) const override { this->Rows->Update(values); }
  void Sum(Eigen::Ref<Eigen::VectorXd> values) const override { this->GetRanks().Sum(values); }
  void Max(Eigen::Ref<Eigen::VectorXd> values) const override { this->GetRanks().Max(values); }
  std::vector<std::int64_t> Gather(const std::vector<std::int64_t>& values) const override
  {
    return this->GetRanks().Gather(values);
  }
  std::unique_ptr<SymmetricSolver> MakeSolver(const std::vector<int>& rows) const override;

  std::size_t GetBytes() const;

private:
  void Place(const Points& positions);

  std::vector<long long> Names; ///< global ids of the piece's points
  std::vector<int> CopyOf;
  std::shared_ptr<const Halo> Rows;
  std::shared_ptr<const TriangleMesh> Mesh;
  std::shared_ptr<const Points> Positions;
  Eigen::Vector3d Origin = Eigen::Vector3d::Zero();
  double Diagonal = 0.0;
  std::int64_t TotalNumberOfPoints = 0;
};
}
