// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/AnchoredSystem.h"
#include "Differential/LaplaceOperator.h"
#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// Fits the vertices of a region to Laplacians while all others keep their place:
///
///   min sum_i m_i |(M^-1 L x)_i - d_i|^2 over the region and the ring around it,
///
/// with cotangent weights and masses of the surface as `shape` has it. Weights are never
/// negative, as those of obtuse triangles, of which fans at a seam have many, would fold the
/// surface: the sum of both cotangents is left out where it is, or with ObtuseAngles::AsZero
/// each cotangent. The former is closer to the surface's operator, so that curvatures mean
/// something; the latter smoothes more.
class RegionFit
{
public:
  /// Throws Error(SingularSystem) where a component lies in the region as a whole.
  RegionFit(const TriangleMesh& mesh, const std::vector<int>& region, const Points& shape,
    const ExecutionContext& context = {}, ObtuseAngles obtuse = ObtuseAngles::AsTheyAre);

  /// The vertices that equations see, in increasing order: the region and three rings.
  const std::vector<int>& GetVertices() const { return this->Vertices; }

  /// #GetVertices(): whether a vertex keeps its place.
  const std::vector<char>& GetHeld() const { return this->IsHeld; }

  /// M^-1 L x of points (#V of the mesh x 3): #GetVertices() x 3. Not those of the
  /// outermost ring, which no equation of the region sees.
  Points Laplacians(const Points& points) const;

  /// Moves the region's points to fit `laplacians` (#GetVertices() x 3).
  void Solve(const Points& laplacians, Points& points) const;

  /// Values (#GetVertices()) that are harmonic, L x = 0, where `isGiven` is 0.
  void Interpolate(const std::vector<char>& isGiven, Eigen::VectorXd& values) const;

private:
  Points Gather(const Points& points) const;

  std::vector<int> Vertices;
  std::vector<char> IsHeld; // #Vertices
  SparseMatrix Matrix;      // #Vertices x #Vertices
  Eigen::VectorXd InverseMass;
  AnchoredSystem System;
};

/// Moves the vertices of `region` to the smooth surface through those around them, the
/// thin plate: L M^-1 L x = 0 (Botsch, Kobbelt, An Intuitive Framework for Real-Time
/// Freeform Modeling, 2004), with the weights of the surface as it is but ObtuseAngles::AsZero,
/// and once more with those of the result. Throws what RegionFit throws.
void FairRegion(const TriangleMesh& mesh, const std::vector<int>& region, Points& points,
  const ExecutionContext& context = {});

/// Moves the seam and `rings` >= 1 rings around it so that the Laplacian coordinates of both
/// sides go on to the seam and blend there:
///
///   d_i = h_i n_i,
///
/// where h_i, twice the mean curvature, is that of the vertex's own side, but on the seam and the
/// ring beside it the harmonic function that continues both sides. So details are kept up to
/// that ring, and a sphere that was cut in two is one again, which the thin plate
/// flattens (the blend of Laplacian coordinates of Sorkine et al., Laplacian Surface Editing,
/// 2004, section 5, without its dependence on how both sides are turned). Weights and normals
/// are those of the surface as it is, and once more those of the result. Throws what RegionFit
/// throws.
void BlendSeam(const TriangleMesh& mesh, const std::vector<int>& seam, int rings, Points& points,
  const ExecutionContext& context = {});
}
