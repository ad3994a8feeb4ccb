// SPDX-License-Identifier: BSD-3-Clause
#include "Merging/SeamFairing.h"

#include "Differential/LaplaceOperator.h"
#include "Mesh/GrowByRings.h"

#include <algorithm>

namespace cartan
{
RegionFit::RegionFit(const TriangleMesh& mesh, const std::vector<int>& region, const Points& shape,
  const ExecutionContext& context)
  // Equations see two rings around the region; with a third one their rows are complete.
  : Vertices(GrowByRings(mesh, region, 3))
{
  // In the order of the surface, which factors like better than that of the rings.
  std::sort(this->Vertices.begin(), this->Vertices.end());
  std::vector<char> isInside(mesh.NumberOfVertices(), 0);
  for (const int v : region)
  {
    isInside[v] = 1;
  }
  const LaplaceOperator laplace(mesh, shape, LaplacianWeights::Cotangent, context);
  this->InverseMass.resize(static_cast<Eigen::Index>(this->Vertices.size()));
  for (std::size_t i = 0; i < this->Vertices.size(); ++i)
  {
    const int v = this->Vertices[i];
    this->InverseMass[static_cast<Eigen::Index>(i)] = 1.0 / laplace.GetMass()[v];
    this->IsHeld.push_back(!isInside[v]);
  }
  this->Matrix = Laplacian(mesh, laplace.GetWeights().cwiseMax(0.0), this->Vertices);
  Anchors anchors = Anchors::Hard(this->IsHeld);
  anchors.Vertices = this->Vertices;
  this->System.FactorizeFit(this->Matrix, this->InverseMass, anchors, AnchorMode::Hard, context);
}

Points RegionFit::Gather(const Points& points) const
{
  Points gathered(static_cast<Eigen::Index>(this->Vertices.size()), 3);
  for (std::size_t i = 0; i < this->Vertices.size(); ++i)
  {
    gathered.row(static_cast<Eigen::Index>(i)) = points.row(this->Vertices[i]);
  }
  return gathered;
}

Points RegionFit::Laplacians(const Points& points) const
{
  return this->InverseMass.asDiagonal() * Points(this->Matrix * this->Gather(points));
}

void RegionFit::Solve(const Points& laplacians, Points& points) const
{
  Field positions = this->Gather(points);
  this->System.Solve(laplacians, positions);
  for (std::size_t i = 0; i < this->Vertices.size(); ++i)
  {
    if (!this->IsHeld[i])
    {
      points.row(this->Vertices[i]) = positions.row(static_cast<Eigen::Index>(i));
    }
  }
}

void FairRegion(const TriangleMesh& mesh, const std::vector<int>& region, Points& points,
  const ExecutionContext& context)
{
  if (region.empty())
  {
    return;
  }
  // The first surface is smoother than the fold, and so are its weights.
  for (const double from : { 0.0, 0.5 })
  {
    const RegionFit fit(mesh, region, points, context.Part(from, from + 0.5));
    fit.Solve(Points::Zero(static_cast<Eigen::Index>(fit.GetVertices().size()), 3), points);
  }
}
}
