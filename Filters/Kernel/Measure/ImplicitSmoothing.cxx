// SPDX-License-Identifier: BSD-3-Clause
#include "Measure/ImplicitSmoothing.h"

#include "Mesh/Geometry.h"

namespace cartan
{
Anchors SmoothingAnchors(
  const TriangleMesh& mesh, const Points& points, const std::vector<double>& steps)
{
  Anchors anchors = Anchors::After(0, mesh.NumberOfVertices());
  // Not the masses of LaplaceOperator, whose bounds and lack of a unit serve powers
  // of L / m alone.
  anchors.Stiffness = MixedVoronoiAreas(mesh, points);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v) && steps[mesh.Component(v)] > 0.0)
    {
      anchors.Stiffness[v] /= steps[mesh.Component(v)];
      anchors.IsHard[v] = 0;
    }
  }
  return anchors;
}
}
