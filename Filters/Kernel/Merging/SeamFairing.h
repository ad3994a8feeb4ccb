// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/AnchoredSystem.h"
#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// Fits the vertices of a region to Laplacians while all others keep their place:
///
///   min sum_i m_i |(M^-1 L x)_i - d_i|^2 over the region and the ring around it,
///
/// with cotangent weights, negative ones left out (those of obtuse triangles, of which
/// fans at a seam have many, would fold the surface), and masses of the surface as
/// `shape` has it.
class RegionFit
{
public:
  /// Throws Error(SingularSystem) where a component lies in the region as a whole.
  RegionFit(const TriangleMesh& mesh, const std::vector<int>& region, const Points& shape,
    const ExecutionContext& context = {});

  /// The vertices that equations see, in increasing order: the region and three rings.
  const std::vector<int>& GetVertices() const { return this->Vertices; }

  /// M^-1 L x of points (#V of the mesh x 3): #GetVertices() x 3. Not those of the
  /// outermost ring, which no equation of the region sees.
  Points Laplacians(const Points& points) const;

  /// Moves the region's points to fit `laplacians` (#GetVertices() x 3).
  void Solve(const Points& laplacians, Points& points) const;

private:
  Points Gather(const Points& points) const;

  std::vector<int> Vertices;
  std::vector<char> IsHeld; // #Vertices
  SparseMatrix Matrix;      // #Vertices x #Vertices
  Eigen::VectorXd InverseMass;
  AnchoredSystem System;
};

/// Moves the vertices of `region` to the smooth surface through those around them: the
/// biharmonic one, L M^-1 L x = 0 (Botsch, Kobbelt, An Intuitive Framework for Real-Time
/// Freeform Modeling, 2004), with the weights of the surface as it is, and once more with
/// those of the result. Throws what RegionFit throws.
void FairRegion(const TriangleMesh& mesh, const std::vector<int>& region, Points& points,
  const ExecutionContext& context = {});
}
