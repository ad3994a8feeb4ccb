// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Differential/Laplacian.h"

namespace cartan
{
/// What the cotangents of obtuse angles count for, which are negative.
enum class ObtuseAngles
{
  AsTheyAre,
  AsZero ///< no weight is negative, but the operator is not that of the surface there
};

/// The Laplacian of a surface together with the masses of its vertices: what
/// systems of all orders are made of. Powers of L / m are only as good as their
/// largest entries are small, so both are kept within bounds that ordinary meshes
/// never meet; both depend on ratios of lengths alone and not on a unit.
class LaplaceOperator
{
public:
  /// The slack of a triangle, the sum of its two shorter edges minus its longest,
  /// in parts of the longest, from which its angles are used as they are. In a
  /// triangle with less, be it a cap or a needle, each edge counts as longer by
  /// the same length, which gives it this slack (mollification: Sharp and Crane, A
  /// Laplacian for Nonmanifold Triangle Meshes, 2020, section 4.5, here triangle by
  /// triangle). No cotangent is larger than about the inverse.
  static constexpr double SmallestSlack = 1e-3;

  /// The least mass of a vertex in parts of its neighbors'.
  static constexpr double SmallestMassRatio = 1e-2;

  /// The weights are made symmetric; see EdgeWeights for what they are. `obtuse` matters to
  /// cotangent ones only.
  LaplaceOperator(const TriangleMesh& mesh, const Points& points, LaplacianWeights weights,
    const ExecutionContext& context = {}, ObtuseAngles obtuse = ObtuseAngles::AsTheyAre);

  /// w_ij = w_ji: #D.
  const Eigen::VectorXd& GetWeights() const { return this->Weights; }

  /// m_i: the mixed Voronoi areas over their mean, without unit, at least
  /// SmallestMassRatio of each neighbor's; 1 for vertices where there is no area
  /// around, and for all vertices with uniform weights. #V.
  const Eigen::VectorXd& GetMass() const { return this->Mass; }

private:
  Eigen::VectorXd Weights;
  Eigen::VectorXd Mass;
};

/// L (M^-1 L)^(k-1), the symmetric matrix of order k >= 1. Throws Error(TooLarge)
/// before it makes a matrix with more entries than SparseMatrix can index.
SparseMatrix PolyharmonicMatrix(
  const SparseMatrix& laplacian, const Eigen::VectorXd& inverseMass, int order);

/// L x for a symmetric L whose rows sum to zero, as sum_j L_ij (x_j - x_i): large
/// entries meet small differences, so that rounding is in parts of these.
Points ApplyLaplacian(const SparseMatrix& laplacian, const Points& values);
}
