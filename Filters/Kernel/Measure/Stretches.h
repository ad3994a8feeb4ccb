// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Bytes.h"
#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

#include <memory>
#include <vector>

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
class RingStretches
{
public:
  /// What holds for all current surfaces: with M = sum_j p_j p_j^T / |p_j|^2 and orthonormal
  /// tangents t_i the images A t_i are sum_j q_j (p_j . w_i) / |p_j|^2, w_i = M^-1 t_i.
  RingStretches(std::shared_ptr<const TriangleMesh> mesh, std::shared_ptr<const Points> reference,
    const ExecutionContext& context = {});

  Stretches Measure(const Points& current, const ExecutionContext& context = {}) const;

  /// Without mesh and reference, which others hold too.
  std::size_t GetBytes() const { return BytesOf(this->Duals); }

private:
  std::shared_ptr<const TriangleMesh> Mesh;
  std::shared_ptr<const Points> Reference;
  std::vector<Eigen::Matrix<double, 3, 2>> Duals; // w_1 and w_2; zero: none
};

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
