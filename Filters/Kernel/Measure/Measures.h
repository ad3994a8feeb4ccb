// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Algebra/ConstrainedSolver.h"
#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

#include <vector>

/// Numbers that compare a surface with a reference of the same connectivity.
/// `mesh` is that connectivity, `reference` and `current` are positions
/// (#V x 3). Nothing here changes when either surface is moved rigidly.
namespace cartan
{
struct ComponentVolume
{
  /// Positive when the triangles are oriented outwards, negative inside out (or
  /// for the wall of a cavity). Computed about the component's own center, so
  /// that a surface far from the origin keeps its digits. Means nothing when
  /// the component is not closed.
  double Volume = 0.0;
  double Area = 0.0;
  bool IsClosed = true;
};

/// One entry per component of the mesh.
std::vector<ComponentVolume> MeasureComponents(const TriangleMesh& mesh, const Points& points);

/// The area of each triangle: #T.
Eigen::VectorXd TriangleAreas(
  const TriangleMesh& mesh, const Points& points, const ExecutionContext& context = {});

/// A third of the adjacent triangles' area for each vertex: #V. The sum is the
/// surface's area.
Eigen::VectorXd BarycentricAreas(const TriangleMesh& mesh, const Eigen::VectorXd& triangleAreas);

/// current / reference, entry by entry; 1 where both are zero (nothing there
/// and nothing changed), NaN where only the reference is, or is negative: there
/// is no ratio.
Eigen::VectorXd Ratios(const Eigen::VectorXd& reference, const Eigen::VectorXd& current);

struct EdgeLengthChange
{
  /// Per vertex the mean of l' / l over its edges; 1 at unused vertices, NaN
  /// where every edge has length zero in the reference: #V.
  Eigen::VectorXd VertexRatio;
  /// Over all edges, sqrt(mean of (l' / l - 1)^2) and the maximum of |l' / l - 1|.
  double RootMeanSquare = 0.0;
  double Maximum = 0.0;
  /// Edges of length zero in the reference, by their smaller end point. They
  /// have no relative change and are left out.
  IdSample ZeroLength;
};

EdgeLengthChange CompareEdgeLengths(const TriangleMesh& mesh, const Points& reference,
  const Points& current, const ExecutionContext& context = {});

/// The rotation that takes the one-ring of each vertex in the reference closest
/// to the current one, in the least-squares sense over edges and vertex
/// normal: #V x 9. The identity at unused vertices. Edges count alike, or by
/// `edgeWeights` >= 0 (#D).
Matrices FitRotations(const TriangleMesh& mesh, const Points& reference, const Points& current,
  const ExecutionContext& context = {}, const Eigen::VectorXd& edgeWeights = {});

/// The part of the enclosed volume that lies under each vertex, in the spirit
/// of Lipman et al., Volume and Shape Preservation via Moving Frame
/// Manipulation, 2007, section 4 (volume below a surface element in the
/// direction of the inward normal), but so that the parts of a closed component
/// sum to its volume exactly, whatever the shape.
///
/// Tetrahedra between the triangles and the centroid have that property too,
/// but are not local: bending one end of a bar moves the centroid and changes
/// them all. So each point p_i gets its own center c_i, and a vertex a third of
/// each adjacent prism between triangle (p_i) and (c_i). By Stokes' theorem
///
///   Volume = sum over triangles of  int_0^1 a(s) . d ds  +  Volume(c),
///
/// with d the mean of p_i - c_i and a(s) the area vector of c_i + s (p_i - c_i),
/// quadratic in s, so that Simpson's rule is exact. The little that the c_i
/// still enclose, Volume(c), is spread evenly over the component's area.
///
/// The centers of the reference are the surface after one implicit smoothing
/// step, (M + tau L) c = M p, with tau = (6 volume / area)^2. That is (3 r)^2 in
/// a tube of radius r, where it leaves a tenth of the distance from the axis; in
/// a ball the result is all but the centroid. The current centers c' keep the
/// differences of the reference's, turned with the surface:
///
///   (M + tau L) c' = M (p' - R (p - c)) + tau b,
///   b_i = sum_j w_ij (R_i + R_j) (c_i - c_j) / 2,   R = FitRotations,
///
/// without which smoothing would cut the corner of every bend. Where a
/// part of the surface moves rigidly, its local volumes stay what they are but
/// for the change of Volume(c).
class LocalVolumes
{
public:
  /// Factorizes M / tau + L once for all current surfaces.
  LocalVolumes(
    const TriangleMesh& mesh, const Points& reference, const ExecutionContext& context = {});

  /// The local volumes of the reference in cubed length units; 0 at unused
  /// vertices, NaN in components that enclose nothing (open ones, and those
  /// without volume). Negative where the surface faces its own center: #V.
  const Eigen::VectorXd& GetReference() const { return this->Reference; }

  /// The same for the current surface.
  Eigen::VectorXd Measure(const Points& current, const ExecutionContext& context = {}) const;

private:
  Eigen::VectorXd Sum(const Points& points, const Points& centers) const;

  TriangleMesh Mesh;
  Points Positions;
  std::vector<char> EnclosesVolume; // #components
  Eigen::VectorXd EdgeWeight;       // #D
  Eigen::VectorXd Stiffness;        // #V, M / tau
  ConstrainedSolver Solver;
  Points Centers;
  Eigen::VectorXd Reference;
};

struct ShapeDistance
{
  /// Dist = 1/2 int |grad R|_F^2 over the reference, without unit. For an
  /// isometric deformation this is the integral of the squared difference of
  /// the second fundamental forms: area / r^2 when a plane is rolled to a
  /// cylinder of radius r.
  double Total = 0.0;
  /// |grad R|_F^2 / 2 at each vertex, the mean over the adjacent triangles
  /// weighted by area, never negative, in 1 / squared length units: #V. Its
  /// integral with BarycentricAreas of the reference is Total.
  Eigen::VectorXd Density;
};

/// The distance of shapes (Lipman et al. 2007, Eqs. 2 and 3) with
/// R = FitRotations and linear interpolation in the triangles, that is
/// 1/2 sum over edges of w_ij |R_i - R_j|_F^2, w_ij = (cot a + cot b) / 2.
/// Triangles without area count as equilateral with the longest edge's length.
ShapeDistance MeasureShapeDistance(const TriangleMesh& mesh, const Points& reference,
  const Points& current, const ExecutionContext& context = {});

/// The same for a field of rotations (or other 3 x 3 matrices) that is given:
/// #V x 9.
ShapeDistance ShapeDistanceOfRotations(const TriangleMesh& mesh, const Points& reference,
  const Matrices& rotations, const ExecutionContext& context = {});
}
