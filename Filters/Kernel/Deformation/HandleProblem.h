// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/DistributedRows.h"
#include "Base/Bytes.h"
#include "Deformation/Riders.h"
#include "Differential/Laplacian.h"

#include <algorithm>
#include <memory>
#include <vector>

namespace cartan
{
/// What stays the same while handles are dragged. A *handle* k >= 1 is the set
/// of vertices that a user holds as one.
struct HandleProblem
{
  std::shared_ptr<const TriangleMesh> Mesh;
  /// The mesh with its slivers, for what is measured on it; nothing when Mesh is
  /// that (see WithoutSlivers).
  std::shared_ptr<const TriangleMesh> Whole;
  std::vector<Rider> Riders; ///< vertices of Whole that are in no triangle of Mesh
  /// Empty, or the vertex that each one is held together with as one unknown: itself
  /// where it stands for others, or alone (see HoldTogether). #V.
  std::vector<int> JoinedWith;
  /// Mesh with its joined vertices apart, a manifold; nothing when Mesh is that (see
  /// WithJoinedVertices).
  std::shared_ptr<const TriangleMesh> Parted;
  std::shared_ptr<const Points> Rest; ///< #V x 3, best centered on the origin
  std::vector<int> Handle;            ///< #V, the handle of each vertex; 0 is free
  /// The handles that may move, in increasing order. The others keep their
  /// place: they are pinned.
  std::vector<int> Moving;
  /// Empty, or #V weights of the handles' vertices: 0 leaves them free, infinity
  /// fixes them exactly, w in between adds w^2 |value - target|^2 to the sum of
  /// squared residuals over both directions of each edge.
  Eigen::VectorXd SoftWeights;
  /// Of the fields that spread from handle to handle, such as frames.
  LaplacianWeights Weights = LaplacianWeights::Cotangent;
  /// Of the positions. The same as Weights need one factorization less.
  LaplacianWeights PositionWeights = LaplacianWeights::Cotangent;
  /// Whether negative weights of edges count as zero.
  bool ClampWeights = false;
  /// Off: the frames of moving handles follow their motions, and the surface
  /// finds its place from the pinned ones alone.
  bool ConstrainPositions = true;
  /// Up to so many handles methods keep a field per handle, so that a motion is
  /// a sum over them; with more, each motion is solved for. At 20K points the
  /// fields of 64 double the memory of similarity editing and take the time of 60
  /// solves, and a sum over 256 takes as long as a solve.
  int StoredHandles = 64;
  /// Nothing, or how the ranks reach each other when Mesh is one piece of several of a
  /// surface; its rows are the vertices. Then all ranks make a deformer together and give
  /// it the same motions, and it works on all pieces at once (see SurfaceDeformer). Moving
  /// is the same on all ranks, slivers and joined vertices are not removed.
  std::shared_ptr<const DistributedRows> Pieces;

  const std::shared_ptr<const TriangleMesh>& GetWhole() const
  {
    return this->Whole ? this->Whole : this->GetParted();
  }

  const std::shared_ptr<const TriangleMesh>& GetParted() const
  {
    return this->Parted ? this->Parted : this->Mesh;
  }

  /// The memory that it holds, without the whole mesh and the rest positions.
  std::size_t GetBytes() const
  {
    return TotalBytes(
             this->Handle, this->Moving, this->SoftWeights, this->Riders, this->JoinedWith) +
      (this->Whole ? this->GetParted()->GetBytes() : 0) +
      (this->Parted ? this->Mesh->GetBytes() : 0);
  }
};

/// x -> Linear x + Translation for one handle.
struct HandleMotion
{
  Eigen::Matrix3d Linear = Eigen::Matrix3d::Identity();
  Eigen::Vector3d Translation = Eigen::Vector3d::Zero();
  /// Axis times angle in radians of the rotation in Linear, of any length: more
  /// than 2 pi means full turns. Used by methods that see rotations as angles.
  Eigen::Vector3d RotationVector = Eigen::Vector3d::Zero();
  /// Whether RotationVector, or HandleTargets::RotationVectors at this handle, is
  /// as the user gave it. Off: it was found from a matrix, and other vectors of
  /// the same rotation, whole turns apart, mean the same (see CommonMotion).
  bool CountsTurns = true;
};

/// What changes from one motion to the next.
struct HandleTargets
{
  std::vector<HandleMotion> Motions; ///< one per HandleProblem::Moving
  /// Instead of Motions, vertex by vertex: the vertices that have rows, in
  /// increasing order, among them all of moving handles; and empty or a row for
  /// each of them. Positions replace where a motion moves a vertex, Transforms its
  /// linear part; RotationVectors, in radians, replace Transforms for methods that
  /// see rotations as angles.
  std::vector<int> Vertices;
  Points Positions;
  Matrices Transforms;
  Points RotationVectors;

  /// The row of one of Vertices.
  Eigen::Index Row(int vertex) const
  {
    return std::lower_bound(this->Vertices.begin(), this->Vertices.end(), vertex) -
      this->Vertices.begin();
  }

  bool IsPerVertex() const { return this->Positions.rows() || this->Transforms.rows(); }
};

struct DeformedSurface
{
  Points Positions; ///< #V x 3
  /// The linear map that each vertex's neighborhood went through: #V x 9,
  /// filled on request. The identity where nothing moves.
  Matrices Transforms;
  /// The factors of the frames by a volume correction: #V, 1 where there is none.
  Eigen::VectorXd FrameScale;
};
}
