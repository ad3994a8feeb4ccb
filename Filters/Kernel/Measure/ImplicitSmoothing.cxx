// SPDX-License-Identifier: BSD-3-Clause
#include "Measure/ImplicitSmoothing.h"

#include "Mesh/Geometry.h"

namespace cartan
{
Anchors SmoothingAnchors(const TriangleMesh& mesh, const Points& points,
  const std::vector<double>& steps, const SurfaceComponents* parts)
{
  Anchors anchors = Anchors::After(0, mesh.NumberOfVertices());
  // Not the masses of LaplaceOperator, whose bounds and lack of a unit serve powers
  // of L / m alone.
  anchors.Stiffness = MixedVoronoiAreas(mesh, points);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const int component = parts ? parts->OfVertex(v) : mesh.Component(v);
    if (mesh.IsUsed(v) && steps[component] > 0.0)
    {
      anchors.Stiffness[v] /= steps[component];
      anchors.IsHard[v] = 0;
    }
  }
  return anchors;
}
}
