// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// Moves the vertices of `region` to the smooth surface through those around them: the
/// biharmonic one, L M^-1 L x = 0 (Botsch, Kobbelt, An Intuitive Framework for Real-Time
/// Freeform Modeling, 2004), with the cotangent weights, negative ones left out, and masses of
/// the surface as it is, and once more with those of the result. Throws
/// Error(SingularSystem) where a component lies in the region as a whole.
void FairRegion(const TriangleMesh& mesh, const std::vector<int>& region, Points& points,
  const ExecutionContext& context = {});
}
