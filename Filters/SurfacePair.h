// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "KernelBridge.h"

namespace cartan
{
/// Two surfaces of the same connectivity. Polygons are triangulated by their
/// shape, so both use the triangles of the
/// reference (or of the current surface, where those of the reference have
/// polygons without area that cannot be triangulated).
struct SurfacePair
{
  TriangleMesh Mesh;
  std::vector<long long> CellIds; ///< the cell that each triangle comes from
  Points Reference;               ///< #V x 3, about the reference's own center
  Points Current;                 ///< #V x 3, about the current surface's own center
  std::string Warning;            ///< of both, as in Surface
};

/// Throws Error(BadInput) as ReadSurface does, and when the two differ in their
/// points' number or their cells.
SurfacePair ReadSurfacePair(vtkPolyData* current, vtkPolyData* reference);
}
