// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/DistributedRows.h"
#include "Base/Bytes.h"
#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

#include <memory>
#include <vector>

namespace cartan
{
class Neighborhood;

/// The distance of shapes of Lipman et al., Volume and Shape Preservation via
/// Moving Frame Manipulation, 2007, Eqs. 2 and 3. It does not change when either
/// surface is moved rigidly.
struct ShapeDistance
{
  /// Dist = 1/2 int |grad R|_F^2 over the reference, without unit. For an
  /// isometric deformation this is the integral of the squared difference of
  /// the second fundamental forms: area / r^2 when a plane is rolled to a
  /// cylinder of radius r.
  double Total = 0.0;
  /// |grad R|_F^2 / 2 at each vertex, never negative, in 1 / squared length units:
  /// #V. Its integral with BarycentricAreas of the reference is Total.
  Eigen::VectorXd Density;
};

/// The distances of surfaces from one reference of the same connectivity. With F the linear
/// map that takes the tangents of the reference to those of the current surface and the unit
/// normal to the unit normal, R is the orthogonal factor of F = R U.
///
/// Both surfaces are fitted by quadratics in coordinates (x, y) of the reference's
/// tangent plane around each vertex (see Neighborhood::CollectBall), which gives F and its
/// derivatives, and with them those of R: R^T dR is the cross product with
///
///   omega = (tr U - U)^-1 axial(R^T dF - dF^T R),   |dR|_F^2 = 2 |omega|^2.
///
/// R is not differenced along edges. Rotations fitted to one-rings are off by a
/// part of the strain, another one on each ring that is not symmetric, and such
/// differences over the edge's length grow without limit as meshes get finer.
///
/// Converges with the edge length on irregular meshes too, with slivers and
/// vertices that all but coincide. Zero where the reference has no normal or
/// either surface is not fitted by a regular patch: where it has collapsed.
class ShapeDistances
{
public:
  /// What holds for all current surfaces: which points are fitted around each vertex, over which
  /// coordinates, and the reference's own fit. O(#V), about 450 bytes per vertex.
  ///
  /// Of a surface in pieces (`pieces`, may be nothing), which must be so wide that owned vertices
  /// see all around the vertices that they look at, Measure() is collective.
  ShapeDistances(const TriangleMesh& mesh, std::shared_ptr<const Points> reference,
    const ExecutionContext& context = {}, std::shared_ptr<const DistributedRows> pieces = nullptr);

  /// The vertices that the fit around one looks at.
  static std::vector<int> LooksAt(const TriangleMesh& mesh, const Points& reference, int vertex);

  /// Of `current` (#V x 3).
  ShapeDistance Measure(const Points& current, const ExecutionContext& context = {}) const;

  /// Without the reference, which others hold too.
  std::size_t GetBytes() const
  {
    return TotalBytes(this->VertexAreas, this->Patches, this->Begin, this->Ids);
  }

private:
  /// The quadratics around a vertex in coordinates (s, t) along uncorrelated axes of the
  /// reference's tangent plane, of unit variance,
  ///   x(s, t) = x(0) + X1 s + X2 t + X11 s^2 / 2 + X12 s t + X22 t^2 / 2.
  struct Patch
  {
    Eigen::Matrix<double, 3, 2> Axes;    ///< an offset's s and t are its products with them
    Eigen::Matrix<double, 5, 5> Inverse; ///< of the normal equations
    Eigen::Matrix<double, 3, 5> Rest;    ///< X1, X2, X11, X12, X22 of the reference; X1 = 0: none
  };

  Patch Fit(const Neighborhood& neighborhood, const Eigen::Vector3d& normal) const;
  Eigen::Matrix<double, 3, 5> FitPoints(const Patch& patch, int v, const Points& points) const;

  std::shared_ptr<const Points> Reference;
  std::shared_ptr<const DistributedRows> Pieces;
  Eigen::VectorXd VertexAreas;
  std::vector<Patch> Patches;
  std::vector<int> Begin; // #V + 1: where the points around each vertex begin in Ids
  std::vector<int> Ids;
};

/// Of one current surface (#V x 3 as the reference).
ShapeDistance MeasureShapeDistance(const TriangleMesh& mesh, const Points& reference,
  const Points& current, const ExecutionContext& context = {});

/// The distance for a field of rotations (or other 3 x 3 matrices) that is given
/// (#V x 9), smooth on the scale of the edges, with linear interpolation in the
/// triangles: 1/2 sum over edges of w_ij |R_i - R_j|_F^2, w_ij = (cot a + cot b) / 2.
/// Triangles without area count as equilateral with the longest edge's length.
ShapeDistance ShapeDistanceOfRotations(const TriangleMesh& mesh, const Points& reference,
  const Matrices& rotations, const ExecutionContext& context = {});
}
