// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// Whether Cartan was built with METIS, which makes patches.
bool HasMetis();

/// Splits the used vertices into patches of about equal size with few edges between them, by
/// METIS (Karypis, Kumar, A Fast and High Quality Multilevel Scheme for Partitioning
/// Irregular Graphs, SIAM Journal on Scientific Computing 20(1), 1998). #V: the patch of
/// each vertex, -1 for unused ones. One version of METIS gives the same patches again.
///
/// Throws Error(BadInput) for more than one patch when Cartan was built without METIS, and
/// Error(SolverFailed) when METIS fails.
std::vector<int> GraphPatches(const TriangleMesh& mesh, int numberOfPatches);
}
