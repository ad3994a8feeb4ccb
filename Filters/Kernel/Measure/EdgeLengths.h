// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/DistributedRows.h"
#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

namespace cartan
{
struct EdgeLengthChange
{
  /// Per vertex the mean of l' / l over its edges; 1 at unused vertices, NaN
  /// where every edge has length zero in the reference: #V.
  Eigen::VectorXd VertexRatio;
  /// Over all edges, sqrt(mean of (l' / l - 1)^2) and the maximum of |l' / l - 1|.
  double RootMeanSquare = 0.0;
  double Maximum = 0.0;
  /// Edges of length zero in the reference, by their smaller end point. They
  /// have no relative change and are left out.
  IdSample ZeroLength;
};

/// Of a surface in pieces (`pieces`, may be nothing) collective: numbers are those of the whole,
/// ZeroLength has names, and ratios are right at vertices with all of their triangles.
EdgeLengthChange CompareEdgeLengths(const TriangleMesh& mesh, const Points& reference,
  const Points& current, const ExecutionContext& context = {},
  const DistributedRows* pieces = nullptr);
}
