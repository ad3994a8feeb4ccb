// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/SurfaceReader.h"
#include "Kernel/Deformation/TetrahedronGraph.h"

#include "vtkType.h"

#include <vector>

class vtkUnstructuredGrid;

namespace cartan
{
/// A mesh of tetrahedra whose skin is a surface. Its nodes are the surface's points,
/// followed by its other points.
struct VolumeMesh
{
  Points Inner;                   ///< the nodes after the surface's, relative to its origin
  Tetrahedra Cells;               ///< #K x 4, nodes
  std::vector<vtkIdType> CellIds; ///< #K, of the data set
  std::vector<int> NodeOfPoint;   ///< of each point of the data set
  ContentKey Key;                 ///< of surface, points and cells

  std::size_t GetBytes() const;
};

/// The key of what ReadVolumeMesh reads.
ContentKey KeyOfVolumeMesh(const Surface& surface, vtkUnstructuredGrid* grid);

/// Reads the tetrahedra; cells of less than three dimensions are left out. Throws
/// Error(BadInput) for other cells, points that are not finite, and points of the
/// surface that are not points of the mesh, or share one.
VolumeMesh ReadVolumeMesh(const Surface& surface, vtkUnstructuredGrid* grid);

/// Makes `output` a shallow copy of `grid` whose points are at `nodes` (#N x 3, relative
/// to the surface's origin), in the same precision.
void WriteVolumeMesh(const Surface& surface, const VolumeMesh& mesh, const Points& nodes,
  vtkUnstructuredGrid* grid, vtkUnstructuredGrid* output);
}
