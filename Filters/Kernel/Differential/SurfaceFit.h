// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/IdSet.h"
#include "Mesh/TriangleMesh.h"

#include <limits>
#include <vector>

namespace cartan
{
/// The second fundamental form in an orthonormal frame (U, V, Normal), in 1 /
/// length, with the sign that makes an outward-oriented sphere positive.
struct SecondForm
{
  Eigen::Vector3d Normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d U = Eigen::Vector3d::Zero();
  Eigen::Vector3d V = Eigen::Vector3d::Zero();
  double Uu = 0.0;
  double Uv = 0.0;
  double Vv = 0.0;

  /// Of (Uu, Uv, Vv) as a tensor, in 1 / length, by how far the points lie from
  /// the fit. Infinite where there are too few points to tell.
  double StandardError = std::numeric_limits<double>::infinity();

  /// The Frobenius norm of the third derivatives of a cubic's height: by how much the
  /// form changes per length, in 1 / length^2.
  double Change = 0.0;

  /// The sine of half the turn of the normal along an edge from the vertex, if
  /// the edge is the chord of a circle. More than 1 where there is no such circle.
  double HalfTurnSine(const Eigen::Vector3d& edge) const;
};

/// The points a surface is fitted to around one vertex. Reused from vertex to
/// vertex, so that nothing is allocated in the loop.
class Neighborhood
{
public:
  /// A cubic has nine coefficients without its constant one; a few points more
  /// than that let the fit average.
  static constexpr int MinimumPoints = 12;

  /// No ring is begun beyond as many points, which bounds the work at vertices with
  /// many neighbors and on very anisotropic triangles. Twice as many have not made
  /// any error of our tests smaller. A ring that is begun is completed: the order of
  /// the points decides nothing.
  static constexpr int MaximumPoints = 64;

  /// Neighborhoods of too few points, or of points that leave the form open,
  /// grow at most this far.
  static constexpr int MaximumRings = 5;

  /// With the normals of VertexNormals() the points behind sharp bends are left
  /// out, without normals none is.
  Neighborhood(const TriangleMesh& mesh, const Points& points, const Points* normals = nullptr)
    : Mesh(mesh)
    , Positions(points)
    , Normals(normals)
  {
  }

  /// As many rings around v as asked for, more where these are too few points
  /// (at borders).
  void CollectRings(int v, int rings);

  /// The two-ring, and what is connected with v inside the ball through its
  /// farthest neighbor. The ball makes up for long thin triangles, whose
  /// two-ring is just as long and thin and says little about bending the other
  /// way.
  void CollectBall(int v);

  /// The one-ring, and of the second ring what faces the same way.
  void CollectNearest(int v);

  /// Points that were collected around v on another surface of the same connectivity: `ids`,
  /// the neighbors of v first.
  void Take(int v, const int* ids, int size, int oneRingSize);

  /// Without the vertex itself.
  int Size() const { return this->Count() - 1; }

  /// The i-th point, and the way to it from the vertex.
  int Vertex(int i) const { return this->Ids[i + 1]; }
  const Eigen::Vector3d& Offset(int i) const { return this->Offsets[i + 1]; }

  /// The normal at the i-th point, with normals only.
  Eigen::Vector3d Normal(int i) const { return this->Normals->row(this->Vertex(i)).transpose(); }

  /// Whether the i-th point is a neighbor or its normal has turned by less than
  /// 37 degrees.
  bool IsClose(int i) const;

  /// Whether no normal has turned by 37 degrees, of the neighbors neither.
  bool AreAllClose() const;

  /// Whether no normal beyond the neighbors has turned so far, by 61 degrees, that the point may
  /// be on another side of a tube.
  bool FacesOneWay() const;

  /// The first points are the neighbors of the vertex: how many.
  int OneRingSize() const { return this->CountWithOneRing - 1; }

private:
  void Start(int v);
  void AddFan(int v, double minimumCosine, double maximumSquaredDistance);
  int NearestInFan(int v) const;
  int Count() const { return static_cast<int>(this->Ids.size()); }
  bool IsFull() const { return this->Count() > MaximumPoints; }

  const TriangleMesh& Mesh;
  const Points& Positions;
  const Points* Normals;
  std::vector<int> Ids;
  IdSet Found; // the same ids
  std::vector<Eigen::Vector3d> Offsets;
  std::vector<double> Cosines; // of the turn of the normal
  int CountWithOneRing = 0;
};

/// How far the close points of a neighborhood determine a quadric: of each of
/// the quadratic monomials x^2, x y, y^2 the part of its sum of squares that the
/// linear and the earlier ones leave over, the smallest of the three. 0 for two
/// straight rows of points, where y^2 is a multiple of y; .03 and more where
/// three rows are seen from the first; up to 1.
double Determination(const Neighborhood& neighborhood, const Eigen::Vector3d& normal);

/// From here on a quadric is taken as determined. Two rows of a cone, which
/// are circles and therefore no straight rows, reach .008, three rows of quite
/// different distances fall below .01.
constexpr double LeastDetermination = 0.025;

/// The least-squares cubic of FitCurvatures() in the plane normal to `normal`.
/// The coordinates are corrected to chord lengths by `earlier` where it is
/// given, and as on a sphere where it is not. False if the points coincide. With
/// `earlier`, the form has a standard error and a change.
bool FitCubic(const Neighborhood& neighborhood, const Eigen::Vector3d& normal,
  const SecondForm* earlier, SecondForm& form);

/// What FitCubic() without `earlier` makes of the offsets of the points is linear in them: of
/// each point its weights in the derivatives x_u, x_v, x_uu, x_uv, x_vv at the vertex. The
/// coordinates (u, v) are lengths along orthonormal axes of the plane. False if the points
/// coincide.
///
/// The same weights hold for any surface over these coordinates. They take linear functions for
/// what they are, so that where the surface is turned, or stretched evenly, its form is, too.
bool AppendCubicWeights(
  const Neighborhood& neighborhood, const Eigen::Vector3d& normal, std::vector<float>& weights);

/// The form from the derivatives x_u, x_v, x_uu, x_uv, x_vv of a regular surface, without
/// standard error and change. False where they are not regular.
bool ToSecondForm(const Eigen::Matrix<double, 3, 5>& derivatives, SecondForm& form);

/// The form of the normal curvatures 2 h / |p|^2 toward the points, for
/// neighborhoods that do not determine a quadric: what is left open is decided
/// by the normal, which is kept, and by a third derivative of zero. So edges
/// between two rows are taken as straight if they are normal to it. As FitCubic
/// otherwise.
bool FitNormalCurvatures(const Neighborhood& neighborhood, const Eigen::Vector3d& normal,
  const SecondForm* earlier, SecondForm& form);
}
