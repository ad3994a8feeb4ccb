// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/HandleArrays.h"
#include "Bridge/PieceGroup.h"
#include "Bridge/SurfaceReader.h"
#include "Kernel/Algebra/DistributedRows.h"
#include "Kernel/Mesh/VerticesLookedAt.h"

#include <cstdint>
#include <memory>
#include <string>

class vtkPolyData;

namespace cartan
{
/// One of several pieces of a surface as the kernel sees it.
///
/// The vertices are the points of the vtkPolyData in their order, then points of other ranks
/// around them, so that each point has all of its triangles, and copies where these make
/// several fans (DistributedMesh). Ghost cells are left out; they are known from other ranks.
struct PieceSurface
{
  /// As of a whole surface; its origin is that of the whole. Triangles of other ranks have the
  /// id of the ghost cell that they are, or the number of cells.
  std::shared_ptr<const Surface> TheSurface;
  std::shared_ptr<const DistributedRows> Rows;
  double Diagonal = 0.0; ///< of the box around the whole
  std::int64_t TotalNumberOfPoints = 0;
  std::string Warning;   ///< the same on all ranks
  std::string Numbering; ///< what ids in messages mean, a sentence

  std::size_t GetBytes() const;
};

/// Collective. Nothing, and why in `obstacle`, where it cannot be told which points of several
/// ranks are one. With `reach` there are more triangles of other ranks: all around each vertex
/// that owned ones look at. `numbering` becomes a sentence that tells what ids in messages mean.
/// Throws on all ranks what ReadSurface throws, with ids of all pieces.
std::unique_ptr<PieceSurface> ReadPiece(vtkPolyData* piece, const std::string& role,
  const PieceGroup& group, const VerticesLookedAt& reach, std::string& numbering,
  std::string& obstacle);

/// Of the input and what ReadPiece looks at beside it.
ContentKey KeyOfPiece(vtkPolyData* piece);

/// Collective. The handles of all pieces: Ids are those of the whole, Points this rank's.
Handles ReadPieceHandles(vtkPolyData* piece, const PieceSurface& surface, const PieceGroup& group,
  const std::string& name);

/// Collective. ReadSoftWeights() for handles of ReadPieceHandles().
Eigen::VectorXd ReadPieceWeights(vtkPolyData* piece, const PieceSurface& surface,
  const PieceGroup& group, const std::string& name, const Handles& handles);

/// Collective. How many triangles of the whole are slivers (FindSlivers), at most: one between
/// ranks may count twice.
std::int64_t CountSlivers(const PieceSurface& surface);
}
