// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/ContentKey.h"
#include "Kernel/Base/ExecutionContext.h"
#include "Kernel/Mesh/CoincidentBorders.h"
#include "Kernel/Mesh/TriangleMesh.h"

#include <memory>
#include <string>
#include <vector>

class vtkPolyData;

/// Where VTK data become kernel data and back. Private to the filters, not
/// installed.
namespace cartan
{
/// The triangles of a vtkPolyData. Surfaces of equal cells share one.
struct Connectivity
{
  TriangleMesh Mesh;
  std::vector<long long> CellIds; ///< the cell that each triangle comes from
  IdSample Repeated;              ///< cells whose triangle names a point twice: left out

  std::size_t GetBytes() const;
};

/// A vtkPolyData as the kernel sees it. Rows are point ids, so every id in a
/// kernel message is one the user knows.
struct Surface
{
  std::shared_ptr<const Connectivity> Cells;
  std::shared_ptr<const TriangleMesh> Mesh; ///< that of Cells
  /// #V x 3, relative to Origin, the center of the bounding box of the used
  /// points: a surface far from the world's origin keeps its digits. Zero for
  /// unused points, whatever they hold.
  std::shared_ptr<const Points> Positions;
  Eigen::Vector3d Origin = Eigen::Vector3d::Zero();
  IdSample ZeroArea;         ///< cells with a triangle without area
  CoincidentBorders Borders; ///< where it looks closed and is not
  ContentKey Key;            ///< of points and cells

  /// What is odd but no obstacle, in sentences; empty if nothing is. `role` names
  /// the surface ("input", "reference"). Borders that Prepare Surface has left as
  /// they are are not odd any more.
  std::string Describe(const std::string& role, vtkPolyData* readFrom) const;

  /// With the mesh, although others may hold it too.
  std::size_t GetBytes() const;
};

/// Triangles as they are, other polygons and strips triangulated, vertices and
/// lines left out, triangles that name a point twice dropped. While some filter
/// keeps a surface of the same contents, that one is returned without looking at
/// a cell. Throws Error(BadInput) when there is no triangle, a used point is not
/// finite, or the triangles are not an oriented manifold.
std::shared_ptr<const Surface> ReadSurface(
  vtkPolyData* input, const std::string& role = "input", const ExecutionContext& context = {});

/// The triangles of a surface that need not be a manifold, nor oriented.
struct TriangleSoup
{
  Triangles Faces;                ///< #T x 3, point ids
  Points Positions;               ///< #V x 3, as they are
  std::vector<long long> CellIds; ///< the cell that each triangle comes from
  IdSample Repeated;              ///< cells with a triangle that names a point twice, left out
};

/// As ReadSurface, but accepts whatever the triangles are. Throws Error(BadInput)
/// when there is none, or a cell uses a point that does not exist.
TriangleSoup ReadTriangles(
  vtkPolyData* input, const std::string& role = "input", const ExecutionContext& context = {});

/// The triangles alone, with all positions at the origin: for filters that do
/// not look at coordinates and so cannot triangulate. Throws Error(BadInput) as
/// ReadSurface does, and for polygons that are not triangles.
std::shared_ptr<const Surface> ReadConnectivity(
  vtkPolyData* input, const std::string& role = "input");
}
