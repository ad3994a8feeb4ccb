// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Merging/CoatingTransfer.h"

namespace cartan
{
/// The closest place on a surface for each query, and how far it is. Throws Error(BadInput)
/// where no triangle has an area: there is none.
struct FoundPlaces
{
  std::vector<SurfacePlace> Places;
  Eigen::VectorXd Distances;
};
FoundPlaces ClosestPlaces(const TriangleMesh& mesh, const Points& points, const Points& queries,
  const ExecutionContext& context);
}
