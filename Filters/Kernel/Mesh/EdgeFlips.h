// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Base/Types.h"

namespace cartan
{
struct FlipOptions
{
  /// How far the normals of two triangles, before and after, may be apart, in
  /// radians. What is sharper is an edge of the shape and stays.
  double MaximumAngle = 0.1745; // 10 degrees
  /// Of triangles whose height over the longest edge is below this part of it
  /// the normal says nothing and is not asked: caps, as the tessellation of CAD
  /// models leaves them, may be flipped away even where they stand askew. The
  /// surface moves by no more than that height.
  double CapHeight = 1e-3;
};

/// Whether a flip of the edge from a to b, with c on its left and d on its right,
/// to one from d to c makes the smallest of the six angles at it larger, by more
/// than rounding, and turns no normal farther than the options allow.
bool FlipImproves(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
  const Eigen::Vector3d& d, const FlipOptions& options);

/// Flips inner edges while that makes the smallest of the six angles at the edge
/// larger, which in the plane leads to a Delaunay triangulation (Lawson, Software
/// for C1 Surface Interpolation, Mathematical Software III, 1977) and takes caps
/// away. Vertices stay where they are; no flip makes an edge that exists, or
/// turns a triangle over. Changes `triangles`, an oriented manifold, and returns
/// the number of flips. Each flip raises the smallest angle around it, so it
/// ends. Throws Error(Aborted).
int FlipEdges(Triangles& triangles, const Points& points, const FlipOptions& options = {},
  const ExecutionContext& context = {});
}
