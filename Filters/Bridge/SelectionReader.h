// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSmartPointer.h"

#include <vector>

class vtkAlgorithm;
class vtkDataObject;
class vtkExtractSelection;
class vtkPolyData;
class vtkSelection;

namespace cartan
{
/// Whether a point is in a region, per point.
using PointMask = std::vector<unsigned char>;

/// The data with arrays that say which points or cells are selected; a block in
/// which nothing is selected may be missing. Nothing of `input` or `selection`
/// changes: vtkExtractSelection removes other ranks' nodes from what it is given.
/// `kind` is the class of extractor, null for VTK's; `filter` asks for a piece.
/// Throws Error(BadInput) for selections that cannot be evaluated.
vtkSmartPointer<vtkDataObject> EvaluateSelection(
  vtkDataObject* input, vtkSelection* selection, vtkExtractSelection* kind, vtkAlgorithm* filter);

/// Adds the points, and those of the cells, that `evaluated` says are selected.
void AddSelected(vtkPolyData* evaluated, vtkPolyData* input, PointMask& mask);

/// Whether ids are those of one rank, as where points are picked in a view.
bool IsOfRanks(vtkSelection* selection);
}
