// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "KernelBridge.h"

namespace cartan
{
/// Several surfaces of the same connectivity. Polygons are triangulated by
/// their shape, so all use the triangles of the first one (or of the first with
/// the most triangles, where others have polygons without area that cannot be
/// triangulated).
struct MatchedSurfaces
{
  TriangleMesh Mesh;
  std::vector<long long> CellIds; ///< the first one's cell that each triangle comes from
  std::vector<Points> Positions;  ///< #V x 3 each, about the surface's own origin
  std::vector<Eigen::Vector3d> Origins;
  std::vector<Surface::Source> ReadFrom;
  std::string Warning; ///< of all, as in Surface
};

/// `roles` name the surfaces in messages, `advice` ends those about
/// differences. Throws Error(BadInput) as ReadSurface does, and when a surface
/// and the first differ in their points' number or their cells.
MatchedSurfaces ReadMatchedSurfaces(const std::vector<vtkPolyData*>& surfaces,
  const std::vector<std::string>& roles, const std::string& advice);

/// Two surfaces of the same connectivity.
struct SurfacePair
{
  TriangleMesh Mesh;
  std::vector<long long> CellIds; ///< the current surface's cell of each triangle
  Points Reference;               ///< #V x 3, about the reference's own center
  Points Current;                 ///< #V x 3, about the current surface's own center
  std::string Warning;            ///< of both, as in Surface
};

/// As ReadMatchedSurfaces.
SurfacePair ReadSurfacePair(vtkPolyData* current, vtkPolyData* reference);
}
