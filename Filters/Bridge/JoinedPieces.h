// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/PointJoin.h"

/// A surface in pieces becomes one again. Private to the filters, not installed.
namespace cartan
{
/// A surface made of pieces, and what has become of their points and cells.
struct JoinedPieces
{
  vtkSmartPointer<vtkPolyData> Whole;
  PiecePoints Points;
  /// By piece: the cell of the whole, of a ghost that of which it is a copy; -1 where there is
  /// none.
  std::vector<std::vector<vtkIdType>> Cells;
};

/// Joins pieces, see JoinPiecePoints; with a `model`, made of pieces that have the same cells,
/// as its points are joined. Ghost cells are left out. Arrays that all pieces have are kept,
/// with the value of the rank that owns a point (vtkGhostType), or else of the first.
JoinedPieces JoinPieces(const SurfacePieces& pieces, const JoinedPieces* model = nullptr);

/// Whether pieces have the same cells and as many points.
bool AreAlike(const SurfacePieces& pieces, const SurfacePieces& others);
}
