// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Error.h"
#include "Deformation/VolumeGraph.h"

namespace cartan
{
/// Four nodes per row: #K x 4.
using Tetrahedra = Eigen::Matrix<int, Eigen::Dynamic, 4, Eigen::RowMajor>;

/// The edges of tetrahedra with the sum of V / (2 |e|^2), which is exact for the integral
/// of |g|^2 in regular ones and never negative, in parts of the mean edge length.
/// Throws Error(BadInput) where a tetrahedron names a node twice or one that is not.
VolumeGraph MakeTetrahedronGraph(const Points& nodes, const Tetrahedra& tetrahedra);

/// Six times the signed volume of each tetrahedron: #K.
Eigen::VectorXd TetrahedronDeterminants(const Points& nodes, const Tetrahedra& tetrahedra);

/// The tetrahedra that `current` has turned inside out, or made flat. Those that are flat
/// at rest, up to rounding, do not count.
IdSample InvertedTetrahedra(
  const Points& rest, const Points& current, const Tetrahedra& tetrahedra);
}
