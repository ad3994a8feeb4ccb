// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

namespace cartan
{
/// How a surface is stretched at several places: the singular values of the linear map from
/// the tangent plane in the reference to space, and where its directions are now.
struct Stretches
{
  Eigen::VectorXd Larger;  ///< new length / old length in the direction of most stretch, >= Smaller
  Eigen::VectorXd Smaller; ///< perpendicular to that, >= 0
  /// Unit vectors on the current surface, rows x 3. Zero where both stretches are the same to
  /// 1e-12, so that all directions are alike, and where there is no stretch.
  Points LargerDirections;
  Points SmallerDirections;
};

/// Of each triangle: #T. NaN where the reference has no area.
Stretches TriangleStretches(const TriangleMesh& mesh, const Points& reference,
  const Points& current, const ExecutionContext& context = {});

/// Of each vertex: #V. The linear map takes the edges p_j of its one-ring in the reference
/// closest to the current ones q_j,
///
///   min over A of sum_j |q_j - A p_j|^2 / |p_j|^2,
///
/// and is looked at in the tangent plane of the vertex normal: where A maps the surface, it is
/// found exactly, also where the ring is curved. 1 at unused vertices, NaN where the ring has
/// no area.
Stretches VertexStretches(const TriangleMesh& mesh, const Points& reference, const Points& current,
  const ExecutionContext& context = {});

/// What is made of a stretch s (Holzapfel, Nonlinear Solid Mechanics, 2000, section 2.5).
enum class StrainMeasure
{
  Biot,          ///< s - 1, also called engineering strain
  GreenLagrange, ///< (s^2 - 1) / 2
  Hencky,        ///< ln s, also called true or logarithmic strain; minus infinity for 0
  EulerAlmansi   ///< (1 - s^-2) / 2; minus infinity for 0
};
Eigen::VectorXd Strains(const Eigen::VectorXd& stretches, StrainMeasure measure);
}
