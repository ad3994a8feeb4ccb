// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/AnchoredSystem.h"
#include "Measure/SurfaceComponents.h"
#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// Makes Laplacian() the system of one step of implicit smoothing,
/// (M / tau + L) x = M / tau p (Desbrun et al., Implicit Fairing of Irregular Meshes
/// using Diffusion and Curvature Flow, 1999): each vertex is a soft anchor at its
/// place p, as stiff as its mixed Voronoi area (mass M) over the step tau of its
/// component, in squared length units. Components with a step of zero, and unused
/// vertices, stay where they are. Without `parts`, components are those of the mesh.
Anchors SmoothingAnchors(const TriangleMesh& mesh, const Points& points,
  const std::vector<double>& steps, const SurfaceComponents* parts = nullptr);
}
