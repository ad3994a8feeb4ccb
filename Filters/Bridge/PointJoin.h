// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <string>
#include <vector>

class vtkPolyData;

/// Private to the filters, not installed.
namespace cartan
{
/// One of each rank, some of them empty.
using SurfacePieces = std::vector<vtkSmartPointer<vtkPolyData>>;

/// A point or a cell of one piece.
struct PiecePlace
{
  int Rank;
  vtkIdType Id;
};

/// Which points of several pieces are one.
struct PiecePoints
{
  std::vector<std::vector<vtkIdType>> OfPieces; ///< by piece: the point of the whole
  std::string Numbering;                        ///< what ids in messages mean, a sentence
};

/// Points of several pieces are one if they have the same global id, numbered in the order of
/// these ids; without global ids, if they are in the same place, numbered in the order of the
/// pieces. Points of one piece stay apart. Throws Error(BadInput) when a global id is in
/// different places, and when it is open which points belong together.
PiecePoints JoinPiecePoints(const SurfacePieces& pieces);
}
