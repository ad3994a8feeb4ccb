// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

namespace cartan
{
enum class LaplacianWeights
{
  Uniform,   ///< 1 for each edge: the graph Laplacian
  Cotangent, ///< (cot a + cot b) / 2 with the angles opposite to the edge; may be negative
  MeanValue  ///< (tan a/2 + tan b/2) / length with the angles beside the edge (Floater, Mean
             ///< value coordinates, 2003); positive, not symmetric, in 1 / length units
};

/// The weight w_ij of each directed edge i -> j: #D. An edge on the boundary
/// has one triangle and so one term. A triangle without area (see
/// HasArea) has no angles; it counts as equilateral, with its
/// longest edge as length, which keeps every weight finite and the surface
/// connected.
Eigen::VectorXd EdgeWeights(const TriangleMesh& mesh, const Points& points,
  LaplacianWeights weights, const ExecutionContext& context = {});

/// What each triangle adds to the symmetric weight of the edge opposite to each
/// of its corners: #T x 3. EdgeWeights are sums of one or two of these, but for
/// Uniform, where an edge between two triangles has half of its weight from
/// each.
Points CornerWeights(const TriangleMesh& mesh, const Points& points, LaplacianWeights weights,
  const ExecutionContext& context = {});

/// (w_ij + w_ji) / 2: #D. An energy that is a sum over both directions of each
/// edge, sum_i sum_j w_ij |r_ij|^2 with |r_ij| = |r_ji|, sees only this part.
Eigen::VectorXd SymmetricPart(const TriangleMesh& mesh, const Eigen::VectorXd& edgeWeights);

/// The matrix L with (L x)_i = sum_j w_ij (x_i - x_j): #V x #V, positive on the
/// diagonal, constants in its null space; symmetric and positive semidefinite
/// for uniform, cotangent and symmetrized weights. Integrated, not pointwise:
/// divide row i by the mixed Voronoi area for the (negative) Laplace-Beltrami
/// operator. Rows of unused vertices are empty.
SparseMatrix Laplacian(const TriangleMesh& mesh, const Eigen::VectorXd& edgeWeights);

/// Its rows and columns that belong to `vertices`, in this order: #vertices x
/// #vertices. Rows of vertices whose neighbors are all among them are complete, so
/// that systems in which the others are given see the whole surface.
SparseMatrix Laplacian(
  const TriangleMesh& mesh, const Eigen::VectorXd& edgeWeights, const std::vector<int>& vertices);

/// The same for any graph, with an edge (i, j) per row of `edges` (#E x 2) and its
/// weight: #nodes x #nodes. Edges may be there several times.
SparseMatrix GraphLaplacian(int numberOfNodes,
  const Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor>& edges,
  const Eigen::VectorXd& weights);
}
