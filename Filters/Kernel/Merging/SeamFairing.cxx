// SPDX-License-Identifier: BSD-3-Clause
#include "Merging/SeamFairing.h"

#include "Merging/BoundaryFrames.h"
#include "Mesh/GrowByRings.h"

#include <algorithm>

namespace cartan
{
RegionFit::RegionFit(const TriangleMesh& mesh, const std::vector<int>& region, const Points& shape,
  const ExecutionContext& context, ObtuseAngles obtuse)
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
  const LaplaceOperator laplace(mesh, shape, LaplacianWeights::Cotangent, context, obtuse);
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

void RegionFit::Interpolate(const std::vector<char>& isGiven, Eigen::VectorXd& values) const
{
  Anchors anchors = Anchors::Hard(isGiven);
  anchors.Vertices = this->Vertices;
  AnchoredSystem system;
  system.Factorize(this->Matrix, anchors);
  Field field = values;
  system.Interpolate(field);
  values = field.col(0);
}

namespace
{
/// The h of BlendSeam, #fit.GetVertices().
Eigen::VectorXd BlendedCurvatures(const TriangleMesh& mesh, const RegionFit& fit,
  const std::vector<int>& seam, const Points& laplacians, const Points& normals)
{
  // Rows on the seam see both sides, those beside it what was moved onto it, and those on the
  // boundary one half of their surroundings.
  std::vector<char> isDoubtful(mesh.NumberOfVertices(), 0);
  for (const int v : GrowByRings(mesh, seam, 1))
  {
    isDoubtful[v] = 1;
  }
  std::vector<char> isGiven;
  for (std::size_t i = 0; i < fit.GetVertices().size(); ++i)
  {
    const int v = fit.GetVertices()[i];
    isGiven.push_back(fit.GetHeld()[i] || (!isDoubtful[v] && !mesh.IsBoundary(v)));
  }
  Eigen::VectorXd curvatures = laplacians.cwiseProduct(normals).rowwise().sum();
  fit.Interpolate(isGiven, curvatures);
  return curvatures;
}
}

void FairRegion(const TriangleMesh& mesh, const std::vector<int>& region, Points& points,
  const ExecutionContext& context)
{
  if (region.empty())
  {
    return;
  }
  // The first pulls folds flat, the second one sees a surface without them.
  for (const bool isFirst : { true, false })
  {
    const double from = isFirst ? 0.0 : 0.5;
    const RegionFit fit(mesh, region, points, context.Part(from, from + 0.5),
      isFirst ? ObtuseAngles::AsZero : ObtuseAngles::AsTheyAre);
    fit.Solve(Points::Zero(static_cast<Eigen::Index>(fit.GetVertices().size()), 3), points);
  }
}

void BlendSeam(const TriangleMesh& mesh, const std::vector<int>& seam, int rings, Points& points,
  const ExecutionContext& context)
{
  const std::vector<int> region = GrowByRings(mesh, seam, rings);
  if (region.empty())
  {
    return;
  }
  Points laplacians;
  Eigen::VectorXd curvatures;
  for (const double from : { 0.0, 0.5 })
  {
    const RegionFit fit(mesh, region, points, context.Part(from, from + 0.5));
    const std::vector<int>& vertices = fit.GetVertices();
    const Points normals = AngleWeightedNormals(mesh, points, vertices);
    if (from == 0.0)
    {
      laplacians = fit.Laplacians(points);
      curvatures = BlendedCurvatures(mesh, fit, seam, laplacians, normals);
    }
    Points blended = laplacians;
    for (std::size_t i = 0; i < vertices.size(); ++i)
    {
      // On a boundary the Laplacian lies along the surface as well.
      if (!fit.GetHeld()[i] && !mesh.IsBoundary(vertices[i]))
      {
        const auto row = static_cast<Eigen::Index>(i);
        blended.row(row) = curvatures[row] * normals.row(row);
      }
    }
    fit.Solve(blended, points);
  }
}
}
