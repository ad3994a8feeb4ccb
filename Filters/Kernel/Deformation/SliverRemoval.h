// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Deformation/HandleProblem.h"

namespace cartan
{
/// The problem on a mesh without slivers (see FindSlivers), with the same vertices.
///
/// A free vertex inside three triangles one of which is a cap, and a free end of
/// a needle's edge, are taken out of the mesh: they become Riders on a triangle
/// that stays, so that the surface around them bends as if they were not there.
/// A cap across the border is left out, and elsewhere its long edge is flipped, as
/// intrinsic Delaunay triangulations do (Fisher et al., An Algorithm for the
/// Construction of Intrinsic Delaunay Triangulations with Applications to Digital
/// Geometry Processing, 2006), but where that would change the shape: the
/// triangles' normals, of caps higher than 1 %, are more than 30 degrees apart.
/// Vertices of handles stay in the mesh, but for that of a cap between two of the same
/// handle, which hold it anyway; with soft weights all. Joined vertices stay, and no
/// edge comes to run between them. What splits a triangle goes first, the rest by
/// length: the order of the vertices decides only between slivers of equal length that
/// touch each other.
///
/// The problem as it is, and the same objects, when there is no sliver. O(#V + #T),
/// and again as often as slivers hang on slivers. Throws Error(Aborted).
HandleProblem WithoutSlivers(HandleProblem problem, const ExecutionContext& context = {});

/// The number in the whole mesh of each component of the mesh without slivers, whose
/// numbers are others where the first vertex of one has gone.
std::vector<long long> ComponentsInWhole(const HandleProblem& problem);
}
