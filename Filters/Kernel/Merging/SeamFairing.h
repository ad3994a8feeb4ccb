// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// Moves the vertices of `region` to the smooth surface through
/// those around them: the biharmonic one, L M^-1 L x = 0 with cotangent weights and masses
/// of the surface as it is (Botsch, Kobbelt, An Intuitive Framework for Real-Time Freeform
/// Modeling, 2004). Throws Error(SingularSystem) where a component lies in the region as a
/// whole.
void FairRegion(const TriangleMesh& mesh, const std::vector<int>& region, Points& points,
  const ExecutionContext& context = {});
}
