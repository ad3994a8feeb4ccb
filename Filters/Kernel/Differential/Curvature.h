// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Bytes.h"
#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

#include <memory>
#include <vector>

namespace cartan
{
class Neighborhood;
struct SecondForm;

/// What a mesh says about the curvatures of a vertex.
enum class CurvatureState : unsigned char
{
  Open,      ///< the neighbors lie in two rows: the values are the best guess
  Split,     ///< as Coarse, in triangles that were split into coplanar ones
  Coarse,    ///< the values may be off by more than 5 % of the larger curvature
  Determined ///< else; also where there is nothing to say
};

/// Curvatures per vertex, positive where the surface bends away from its
/// normal: a sphere of radius R that is oriented outward has Mean = Maximum =
/// Minimum = 1 / R and Gaussian = 1 / R^2.
///
/// Never NaN. All zero, and the directions zero vectors, where there is nothing
/// to say: at unused vertices, and where the neighbors coincide with the
/// vertex or the triangles around it cancel so that it has no normal.
struct Curvatures
{
  Eigen::VectorXd Mean;     ///< H = (Maximum + Minimum) / 2, 1 / length: #V
  Eigen::VectorXd Gaussian; ///< K = Maximum * Minimum, 1 / length^2: #V
  Eigen::VectorXd Maximum;  ///< k1, 1 / length: #V
  Eigen::VectorXd Minimum;  ///< k2 <= k1, 1 / length: #V
  Points MaximumDirections; ///< unit tangent vectors of either sign: #V x 3
  Points MinimumDirections; ///< the normal times them: #V x 3

  std::vector<CurvatureState> States; ///< #V
};

/// Curvatures by a least-squares fit around each vertex, O(#V).
///
/// The height h over the tangent plane is fitted by a cubic without constant
/// term in chord-length coordinates X of p = (x, y, h) relative to the vertex,
///
///   h = g . (x, y) + 1/2 X^T A X + 1/6 C(X, X, X).
///
/// X agrees with (x, y) to second order, so A is the Hessian, but in X what
/// bends in circles is exactly quadratic. The fit is done twice. The first time
/// X = (x, y) |p| / |(x, y)|, as on a sphere (h = -|p|^2 / 2 R). The second time
/// in the tangent plane that the first one found, and with X longer than (x, y)
/// in the direction A (x, y) only, in which the surface bends on the way to p.
/// So spheres are right to eight digits and cylinders to five, whatever
/// their triangles, poles and borders included. The points are the two-ring,
/// more rings at borders, and a ball as large as the one-ring, which matters for
/// long thin triangles, without what faces another way. C has a slight
/// preference for zero, which decides where the points cannot.
///
/// Where the points do not determine A (two rows, such as the side of a
/// cylinder without inner points) more rings are taken. Where those do not help
/// either, A is fitted to the normal curvatures 2 h / |p|^2 toward the nearest
/// points in the plane normal to the mean of the triangles' normals: edges
/// between two rows count as straight. That is right for cylinders and cones
/// and a guess elsewhere, and the state says so.
///
/// A determined form counts as coarse where MayBeWrong() says so, by how far the points lie
/// from the cubic and the normals of the neighbors from what the form makes of them, and if
/// an edge turns the normal by more than 66 degrees. Other values are right within
/// 5 % on tori, tubes along lines and arcs, cones, catenoids and superquadrics of 3 to 100
/// points around, jittered or not, borders included, and on hulls of 20 to 300 random
/// points. Along the crests of coarse waves, errors of up to 7 % pass.
///
/// Measured against others: rms over all vertices of the error of (H, K), on
/// shapes of about unit curvature with 3K - 9K vertices (irregular ones are
/// jittered by 0.3 of an edge, the open one includes its border); in brackets
/// with noise of 1 % of the edge length.
///
///                                 sphere   irregular    irregular open
///                                          torus        cylinder
///   cotangents and angle defect   1e-3     .36  (.67)   .19   (.53)
///   normals of the one-ring       .035     .21  (.22)   .093  (.11)
///   normals and points (cubic)    .029     .21  (.26)   .12   (.18)
///   quadric, two-ring             .011     .022 (.086)  .002  (.088)
///   cubic, two-ring               .011     .011 (.10)   .011  (.92)
///   this one                      4e-10    .002 (.10)   2e-6 (.12)
///
/// The first three do not converge on irregular meshes. Here the error goes
/// down with the square of the edge length on regular and irregular meshes, and
/// about with the edge length itself at irregular borders. A plane has
/// exactly zero up to the rounding of its coordinates. On scanned surfaces
/// (armadillo, bunny, camel) noise of 1 % of the edge length changes H by
/// 3 - 13 % of its rms, and by 7 - 44 % with cotangents. 100K vertices take
/// half a second on one core.
Curvatures FitCurvatures(
  const TriangleMesh& mesh, const Points& points, const ExecutionContext& context = {});

/// The curvatures of surfaces that are deformed from one reference, in half the time of
/// FitCurvatures() for each.
///
/// A surface is fitted around each vertex to the points that the reference has there, so that no
/// difference from the reference's curvature comes from a choice of others. What the first of the
/// two fits makes of the points is kept as weights of theirs over the reference's coordinates,
/// which give the tangent plane and the form from which the second one starts. That is the same
/// fit as in FitCurvatures(), with the current chord lengths: all that is said there of its
/// errors holds, but that spheres that are bent from something else are right to five digits.
/// On the reference and its rigid motions the results are those of FitCurvatures() up to
/// rounding.
///
/// The points are collected anew, as FitCurvatures() does it, at vertices where the reference's
/// do not determine a form, where the surface is stretched more than twice as far in one
/// direction as in the other, and where it bends so much that they do not determine one any more
/// or have come to lie on another side.
class CurvatureFits
{
public:
  /// O(#V), about 450 bytes per vertex.
  CurvatureFits(std::shared_ptr<const TriangleMesh> mesh, const Points& reference,
    const ExecutionContext& context = {});

  /// Of `current` (#V x 3).
  Curvatures Measure(const Points& current, const ExecutionContext& context = {}) const;

  /// Without the mesh, which others hold too.
  std::size_t GetBytes() const
  {
    return TotalBytes(this->Begin, this->OneRingSizes, this->Ids, this->Weights);
  }

private:
  bool Fit(
    Neighborhood& neighborhood, int v, const Eigen::Vector3d& normal, SecondForm& form) const;

  std::shared_ptr<const TriangleMesh> Mesh;
  std::vector<int> Begin;        // #V + 1: where the points around each vertex begin in Ids
  std::vector<int> OneRingSizes; // #V
  std::vector<int> Ids;
  std::vector<float> Weights; // five for each of Ids
};

/// Curvatures from the change of given unit normals (#V x 3, such as
/// VertexNormals) along the edges of each one-ring, the least-squares
/// symmetric map from edges to changes. Coarser than FitCurvatures, and
/// smoother: it sees bending of the size of the one-ring only, does not
/// converge on irregular meshes, and has lower peaks at creases (1.7 instead of
/// 2.6 over the edge length on the armadillo).
Curvatures CurvaturesFromNormals(const TriangleMesh& mesh, const Points& points,
  const Points& normals, const ExecutionContext& context = {});
}
