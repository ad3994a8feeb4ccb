// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/DataBytes.h"
#include "Bridge/JoinedPieces.h"

/// What a filter has made of a joined surface goes back to the pieces. Private to the filters,
/// not installed.
namespace cartan
{
/// Whether the result has the points and cells of the whole, in their order.
bool IsOfPieces(vtkPolyData* result, vtkPolyData* whole);

/// What differs between a result of IsOfPieces() and the whole that it was made from: points,
/// arrays, which of them are active. Only for the points and cells of the piece of one rank.
void WriteDifference(
  vtkPolyData* result, const JoinedPieces& joined, std::size_t rank, ByteWriter& bytes);

/// The piece with this difference: its own cells, ghosts and arrays otherwise.
void ApplyDifference(vtkPolyData* piece, ByteReader& bytes, vtkPolyData* output);
}
