// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Differential/Laplacian.h"

namespace cartan
{
/// The Laplacian of a surface together with the masses of its vertices: what
/// systems of all orders are made of.
class LaplaceOperator
{
public:
  /// The weights are made symmetric; see EdgeWeights for what they are.
  LaplaceOperator(const TriangleMesh& mesh, const Points& points, LaplacianWeights weights,
    const ExecutionContext& context = {});

  /// w_ij = w_ji: #D.
  const Eigen::VectorXd& GetWeights() const { return this->Weights; }

  /// m_i: the mixed Voronoi areas over their mean, without unit; 1 for vertices
  /// whose triangles have no area, and for all vertices with uniform weights.
  /// #V.
  const Eigen::VectorXd& GetMass() const { return this->Mass; }

  /// L between the given vertices: the rows and columns of Laplacian() that
  /// belong to them, in this order. Rows of vertices whose neighbors are all
  /// among them are complete.
  SparseMatrix Restricted(const TriangleMesh& mesh, const std::vector<int>& vertices) const;

private:
  Eigen::VectorXd Weights;
  Eigen::VectorXd Mass;
};

/// L (M^-1 L)^(k-1), the symmetric matrix of order k >= 1. Throws Error(TooLarge)
/// before it makes a matrix with more entries than SparseMatrix can index.
SparseMatrix PolyharmonicMatrix(
  const SparseMatrix& laplacian, const Eigen::VectorXd& inverseMass, int order);
}
