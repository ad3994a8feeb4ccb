// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/DistributedMesh.h"

#include "Base/Bytes.h"
#include "Distributed/DistributedSolver.h"
#include "Distributed/PieceMesh.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace cartan
{
DistributedMesh::DistributedMesh(const SurfacePiece& piece)
  : Names(piece.GlobalIds.begin(), piece.GlobalIds.end())
{
  const Ranks& group = *piece.Group;
  group.Together(
    [&]
    {
      PieceMesh triangles = MakePieceMesh(piece);
      this->CopyOf = triangles.CopyOf;
      this->Rows = std::make_shared<const Halo>(piece, std::move(triangles.CopyOf));
      this->Mesh = std::make_shared<const TriangleMesh>(
        this->NumberOfVertices(), std::move(triangles.Corners));
      this->Place(piece.Positions);
    });
}

/// A box of the points in triangles, as one process has it.
void DistributedMesh::Place(const Points& positions)
{
  constexpr double Infinity = std::numeric_limits<double>::infinity();
  Eigen::VectorXd extremes = Eigen::VectorXd::Constant(6, -Infinity); // of x and -x
  Eigen::VectorXd count = Eigen::VectorXd::Zero(1);
  for (int v = 0; v < this->NumberOfPoints(); ++v)
  {
    if (this->Mesh->IsUsed(v))
    {
      const Eigen::Vector3d point = positions.row(v);
      extremes.head<3>() = extremes.head<3>().cwiseMax(point);
      extremes.tail<3>() = extremes.tail<3>().cwiseMax(-point);
    }
    count[0] += this->IsOwned(v) ? 1.0 : 0.0;
  }
  this->Max(extremes);
  this->Sum(count);
  this->TotalNumberOfPoints = static_cast<std::int64_t>(count[0]);
  if (extremes[0] > -Infinity)
  {
    this->Origin = 0.5 * (extremes.head<3>() - extremes.tail<3>());
    this->Diagonal = (extremes.head<3>() + extremes.tail<3>()).norm();
  }
  auto centered = std::make_shared<Points>(Points::Zero(this->NumberOfVertices(), 3));
  for (int v = 0; v < this->NumberOfVertices(); ++v)
  {
    if (this->Mesh->IsUsed(v))
    {
      centered->row(v) = positions.row(this->Point(v)) - this->Origin.transpose();
    }
  }
  this->Positions = std::move(centered);
}

std::unique_ptr<SymmetricSolver> DistributedMesh::MakeSolver(const std::vector<int>& rows) const
{
  return std::make_unique<DistributedSolver>(this->Rows, rows);
}

std::size_t DistributedMesh::GetBytes() const
{
  return TotalBytes(this->Names, this->CopyOf, *this->Positions) + this->Rows->GetBytes() +
    this->Mesh->GetBytes();
}
}
