// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Base/Error.h"

#include <string>
#include <vector>

class vtkPolyData;

namespace cartan
{
/// The triangles of a polydata and the cell that each comes from.
struct CellTriangles
{
  std::vector<int> Corners; ///< 3 #T
  std::vector<long long> CellIds;
  IdSample Repeated; ///< cells whose triangle names a point twice: left out
};

/// Whether the surface has triangles only, so that its points do not matter for
/// its connectivity.
bool HasOnlyTriangles(vtkPolyData* input);

/// Throws Error(BadInput) when there are no polygons, too many points, or ids of
/// points that do not exist.
CellTriangles CollectTriangles(vtkPolyData* input, const std::string& role);

/// Throws Error(BadInput) for cells that are not triangles.
void RequireOnlyTriangles(vtkPolyData* input, const std::string& role);
}
