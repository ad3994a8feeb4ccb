// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

namespace cartan
{
/// Twice the area times the unit normal of each triangle, by the right-hand
/// rule: #T x 3.
Points TriangleAreaVectors(
  const Points& points, const Triangles& triangles, const ExecutionContext& context = {});

/// Unit vertex normals, the area-weighted mean of the adjacent triangles'
/// normals (Lipman et al., Linear Rotation-invariant Coordinates for Meshes,
/// 2005, section 2): #V x 3. Zero where there is no normal: at unused vertices
/// and where the area vectors cancel to below 1e-12 of their sizes' sum.
Points VertexNormals(
  const TriangleMesh& mesh, const Points& points, const ExecutionContext& context = {});

/// The mixed Voronoi area of each vertex (Meyer et al., Discrete
/// Differential-Geometry Operators for Triangulated 2-Manifolds, 2002): the
/// Voronoi area inside non-obtuse triangles, half or a quarter of an obtuse
/// one. Never negative; sums to the surface's area. #V, in squared length
/// units.
Eigen::VectorXd MixedVoronoiAreas(
  const TriangleMesh& mesh, const Points& points, const ExecutionContext& context = {});

/// Whether the volume of a closed surface of this area is more than rounding, which
/// that of a sheet with two sides is: above 1e-12 of area^(3/2). A sphere has .094.
bool EnclosesVolume(double volume, double area);

/// The length of the bounding box's diagonal; of all points, and of those that
/// triangles use.
double BoundingDiagonal(const Points& points);
double BoundingDiagonal(const Points& points, const Triangles& triangles);
}
