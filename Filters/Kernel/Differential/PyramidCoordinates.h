// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

/// Pyramid coordinates of Sheffer and Kraevoy, Pyramid Coordinates for Morphing and
/// Deformation, 2004, as Sorkine, Differential Representations for Mesh Processing, 2006,
/// section 4.3 has them: a one-ring is projected on the plane normal to the mean of its
/// triangles' normals. The lengths of the projected edges and the angles between them are
/// its tangential components, the heights over the plane its normal ones.
namespace cartan
{
/// A frame per one-ring, right-handed and orthonormal, whose third vector is the mean by
/// area of the normals around: #V x 9. The identity for a ring without a normal.
Matrices PyramidFrames(
  const TriangleMesh& mesh, const Points& points, const ExecutionContext& context = {});

/// Each directed edge i -> j in the frame of i: #D x 3, the projected edge and its height.
/// Lengths and angles in the plane are those of the first two components.
Points PyramidCoordinates(const TriangleMesh& mesh, const Points& points, const Matrices& frames,
  const ExecutionContext& context = {});

/// sum_j w_j (x_j - x_v) p_vj^T over the one-ring of v: rotations R that make
/// <R, sum> largest make sum_j w_j |x_j - x_v - R p_vj|^2 least. `rings` (#D x 3) are
/// coordinates, `weights` are #D.
Eigen::Matrix3d RingProduct(const TriangleMesh& mesh, const Points& points, const Points& rings,
  const Eigen::VectorXd& weights, int v);

/// sum_j w_j |x_j - x_v - R p_vj|^2.
double RingResidual(const TriangleMesh& mesh, const Points& points, const Points& rings,
  const Eigen::VectorXd& weights, int v, const Eigen::Matrix3d& rotation);

/// The sum of the area vectors of the triangles around v: the direction is its normal. Zero
/// where triangles cancel each other to rounding.
Eigen::Vector3d RingAreaVector(const TriangleMesh& mesh, const Points& points, int v);

/// The fit of a pyramid to a one-ring whose plane its positions make.
struct PyramidFit
{
  Eigen::Matrix3d Frame; ///< R, its third vector is the normal
  /// The derivative of <R, sum> by the area vector, with R the best for each: the plane
  /// tilts as the positions tell.
  Eigen::Vector3d SlopeOfArea;
};

/// Of the rotations R that take the third axis to the normal, the one that makes <R, M>
/// largest for the RingProduct M: with M = [a b c] and the normal n,
///
///   R = [r, n x r, n],  r = (a - (a . n) n + b x n) / |...|.
///
/// `areaVector` is not zero. Where no r is better than others it is that of `guess`, turned
/// on to the normal.
PyramidFit FitPyramid(
  const Eigen::Matrix3d& product, const Eigen::Vector3d& areaVector, const Eigen::Matrix3d& guess);
}
