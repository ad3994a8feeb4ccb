// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Error.h"
#include "Mesh/TriangleMesh.h"

#include <functional>
#include <vector>

namespace cartan
{
/// (d Volume / d x_i) for each vertex: a third of half the one-ring's area
/// vectors: #V x 3.
Points VolumeGradient(const TriangleMesh& mesh, const Points& points);

/// The amounts q, one per component, so that points + q * direction enclose
/// `volumes` in the components where `takesPart` is set; 0 in the others. The
/// volume is a cubic in q, whose root nearest to 0 is taken. Components whose
/// direction changes no volume, or cannot reach the given one, keep 0.
std::vector<double> VolumeClosingSteps(const TriangleMesh& mesh, const Points& points,
  const Points& direction, const std::vector<char>& takesPart, const std::vector<double>& volumes);

/// Gives the components where `takesPart` is set the signed `volumes`, both
/// #components, by a Lagrange step: among all changes of one volume by the same
/// amount, the direction A^-1 grad V costs the energy x^T A x / 2 least.
/// `solve` applies A^-1 to the gradient (#V x 3), with zero rows where a vertex
/// is held. Returns the components that could not be closed to a part of 1e-9.
IdSample CloseVolumes(const TriangleMesh& mesh, const std::vector<char>& takesPart,
  const std::vector<double>& volumes, const std::function<Points(const Points&)>& solve,
  Points& positions);
}
