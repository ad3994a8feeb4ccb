// SPDX-License-Identifier: BSD-3-Clause
#include "Merging/SeamFairing.h"

#include "Algebra/AnchoredSystem.h"
#include "Differential/LaplaceOperator.h"
#include "Mesh/GrowByRings.h"

#include <algorithm>

namespace cartan
{
namespace
{
/// One solve, with the weights of the surface as it is, for the region among `vertices`.
void Solve(const TriangleMesh& mesh, const std::vector<int>& vertices,
  const std::vector<char>& isInside, Points& points, const ExecutionContext& context)
{
  const LaplaceOperator laplace(mesh, points, LaplacianWeights::Cotangent, context);
  const auto size = static_cast<Eigen::Index>(vertices.size());
  Eigen::VectorXd inverseMass(size);
  Field positions(size, 3);
  std::vector<char> isHeld(vertices.size());
  for (Eigen::Index i = 0; i < size; ++i)
  {
    const int v = vertices[i];
    inverseMass[i] = 1.0 / laplace.GetMass()[v];
    positions.row(i) = points.row(v);
    isHeld[i] = !isInside[v];
  }
  Anchors anchors = Anchors::Hard(isHeld);
  anchors.Vertices = vertices;
  // The negative weights of obtuse triangles, of which fans at a seam have many, would
  // fold the surface.
  const Eigen::VectorXd weights = laplace.GetWeights().cwiseMax(0.0);
  AnchoredSystem system;
  system.Factorize(
    PolyharmonicMatrix(Laplacian(mesh, weights, vertices), inverseMass, 2), anchors, context);
  system.Interpolate(positions);
  for (Eigen::Index i = 0; i < size; ++i)
  {
    if (!isHeld[i])
    {
      points.row(vertices[i]) = positions.row(i);
    }
  }
}
}

void FairRegion(const TriangleMesh& mesh, const std::vector<int>& region, Points& points,
  const ExecutionContext& context)
{
  // Equations see two rings around the region; with a third one their rows are complete.
  // In the order of the surface, which factors like better than that of the rings.
  std::vector<int> vertices = GrowByRings(mesh, region, 3);
  std::sort(vertices.begin(), vertices.end());
  std::vector<char> isInside(mesh.NumberOfVertices(), 0);
  for (const int v : region)
  {
    isInside[v] = 1;
  }
  if (!vertices.empty())
  {
    // The first surface is smoother than the fold, and so are its weights.
    Solve(mesh, vertices, isInside, points, context.Part(0.0, 0.5));
    Solve(mesh, vertices, isInside, points, context.Part(0.5, 1.0));
  }
}
}
