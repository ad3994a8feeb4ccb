// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/SurfaceReader.h"

namespace cartan
{
/// Several surfaces of the same connectivity. Polygons are triangulated by their
/// shape, so all use the triangles of the first one (or of the first with the most
/// triangles, where others have polygons without area that cannot be
/// triangulated).
struct MatchedSurfaces
{
  std::shared_ptr<const Connectivity> Cells; ///< with the first one's cell ids
  std::shared_ptr<const TriangleMesh> Mesh;
  /// #V x 3 each, about the surface's own origin.
  std::vector<std::shared_ptr<const Points>> Positions;
  std::vector<Eigen::Vector3d> Origins;
  std::vector<std::shared_ptr<const Surface>> Surfaces; ///< as they were read
  std::string Warning;                                  ///< of all, as Surface::Describe

  /// The first surface, with the triangles that all use.
  Surface First() const;
};

/// Throws Error(BadInput) where two surfaces differ in their points' number or their cells;
/// `firstRole` and `otherRole` name them in messages.
void RequireSameCells(vtkPolyData* first, const std::string& firstRole, vtkPolyData* other,
  const std::string& otherRole, const std::string& advice);

/// `roles` name the surfaces in messages, `advice` ends those about differences.
/// Throws Error(BadInput) as ReadSurface does, and when a surface and the first
/// differ in their points' number or their cells.
MatchedSurfaces ReadMatchedSurfaces(const std::vector<vtkPolyData*>& surfaces,
  const std::vector<std::string>& roles, const std::string& advice,
  const ExecutionContext& context = {});
}
