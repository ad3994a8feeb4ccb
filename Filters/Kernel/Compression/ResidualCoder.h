// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Compression/RangeCoder.h"
#include "Mesh/TriangleMesh.h"

namespace cartan
{
/// Three whole numbers per vertex, each less than 2^16 in size: #V x 3.
using Residuals = Eigen::Matrix<std::int32_t, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Codes `values` of the used vertices in the order of their ids; those of others are not
/// touched. What the neighbors that came before have says how large a number probably is,
/// and which sign it has: where the triangles are small, so are differential coordinates,
/// and they change slowly. A decoder sets `values`, and throws Error(BadInput) for numbers
/// that are too large.
void CodeResiduals(RangeEncoder& coder, const TriangleMesh& mesh, Residuals& values);
void CodeResiduals(RangeDecoder& coder, const TriangleMesh& mesh, Residuals& values);
}
