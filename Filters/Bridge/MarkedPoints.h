// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/SelectionReader.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <string>
#include <vector>

class vtkDataObject;
class vtkIntArray;

namespace cartan
{
/// Throws Error(BadInput) for ids that are not in [0, numberOfPoints).
void RequirePointIds(const std::vector<vtkIdType>& ids, vtkIdType numberOfPoints);

/// Adds the ids of the block whose points are numbered from `firstPoint` on.
void AddPointIds(const std::vector<vtkIdType>& ids, vtkIdType firstPoint, PointMask& mask);

/// A new array with the handle ids that `input` has already; all free if it has no such
/// array. Throws Error(BadInput) if it is not a list of handle ids.
vtkSmartPointer<vtkIntArray> CopyHandles(vtkPolyData* input, const std::string& name);

/// Gives the points in `mask` the id; returns how many of them have it then.
vtkIdType Mark(vtkIntArray* handles, const PointMask& mask, int id, bool overwrite);

/// The points of handle `id` > 0 in a marked surface, or in all blocks of a composite
/// data set, counted on from block to block.
std::vector<vtkIdType> FindMarked(vtkDataObject* surfaces, const std::string& name, int id);
}
