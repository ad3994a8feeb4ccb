// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

#include <vector>

/// Rotations that take points closest to others in the least-squares sense: the
/// orthogonal factor of sum w q p^T (Kabsch, A solution for the best rotation to
/// relate two sets of vectors, 1976).
namespace cartan
{
/// The rotation that takes the one-ring of each vertex in the reference closest
/// to the current one, in the least-squares sense over edges and vertex
/// normal: #V x 9. The identity at unused vertices. Edges count alike, or by
/// `edgeWeights` >= 0 (#D).
Matrices FitRotations(const TriangleMesh& mesh, const Points& reference, const Points& current,
  const ExecutionContext& context = {}, const Eigen::VectorXd& edgeWeights = {});

/// The rotation of each component that takes `from` closest to `to` (#V x 3) about
/// the centers (#components x 3), vertices weighted by `weights` >= 0 (#V).
std::vector<Eigen::Matrix3d> FitComponentRotations(const TriangleMesh& mesh, const Points& from,
  const Points& fromCenters, const Points& to, const Points& toCenters,
  const Eigen::VectorXd& weights);
}
