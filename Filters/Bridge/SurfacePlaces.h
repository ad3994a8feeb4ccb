// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Merging/CoatingTransfer.h"

namespace cartan
{
/// The closest place on a surface for each query, and how far it is.
struct FoundPlaces
{
  std::vector<SurfacePlace> Places;
  Eigen::VectorXd Distances;
};
FoundPlaces ClosestPlaces(const TriangleMesh& mesh, const Points& points, const Points& queries,
  const ExecutionContext& context);

/// The rigid motion or similarity (4 x 4) that takes `from` closest to a surface, by
/// vtkIterativeClosestPointTransform, which starts with both centers in one place and
/// finds the nearest of several possible fits.
Eigen::Matrix4d AlignToSurface(
  const Points& from, const TriangleMesh& mesh, const Points& points, bool isSimilarity);
}
