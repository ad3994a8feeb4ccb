// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Bytes.h"
#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

#include <vector>

/// A triangle mesh as rigid plates that hinge on shared edges: the lengths of
/// its edges and the angles of its hinges, which together determine each
/// component up to a rigid motion, and the reconstruction of triangles from
/// them.
namespace cartan
{
/// An edge between two triangles. In Left it runs from corner LeftCorner to the
/// next corner, in Right from the corner after RightCorner to RightCorner.
struct Hinge
{
  int Left;
  int LeftCorner;
  int Right;
  int RightCorner;
  int Edge;

  int OtherTriangle(int triangle) const
  {
    return this->Left == triangle ? this->Right : this->Left;
  }
};

/// Adjacency of triangles, edges and hinges. Each edge occurs once. A hinge is
/// an edge that is not on the boundary.
struct HingeTopology
{
  explicit HingeTopology(const TriangleMesh& mesh);

  int NumberOfTriangles() const { return static_cast<int>(this->Corners.rows()); }
  int NumberOfEdges() const { return static_cast<int>(this->Edges.rows()); }
  int NumberOfHinges() const { return static_cast<int>(this->Hinges.size()); }

  std::size_t GetBytes() const
  {
    return TotalBytes(this->Corners, this->CornerEdges, this->Edges, this->Hinges);
  }

  int NumberOfVertices;
  Triangles Corners;     ///< #T x 3, vertices
  Triangles CornerEdges; ///< #T x 3, the edge from a corner to the next
  Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor> Edges; ///< #E x 2, their end points
  std::vector<Hinge> Hinges;
};

/// #E.
Eigen::VectorXd EdgeLengths(
  const HingeTopology& topology, const Points& points, const ExecutionContext& context = {});

/// Unit normals of the triangles: #T x 3. A triangle without area (see HasArea)
/// has no normal; it takes that of a neighbor, made orthogonal to its longest
/// edge. If `isDegenerate` (#T) is given, its entry is set.
Points HingeNormals(
  const HingeTopology& topology, const Points& points, std::vector<char>* isDegenerate = nullptr);

/// The angle by which the normal turns about a hinge from Left to Right, by the
/// right-hand rule about the edge as it runs in Left: #hinges, in (-pi, pi].
/// Zero where the surface is flat, positive where it is convex, seen from
/// outside. A closed hinge has the angle pi, whatever its rounding: an angle
/// within a microradian of -pi is replaced by the equivalent one above pi.
Eigen::VectorXd HingeAngles(const HingeTopology& topology, const Points& points,
  const Points& normals, const ExecutionContext& context = {});

/// `angles` plus multiples of 2 pi, each as close as possible to `previous`,
/// the angles of the surface at `previousPoints`: hinges turn the shorter way.
/// That way may pass through pi, where the hinge's triangles pass through each
/// other; so a fold that is almost closed in both surfaces stays closed between
/// them. If both ways are equally long, it is the one that does not pass
/// through pi.
///
/// A crease that turns by about 180 degrees must turn in one direction
/// everywhere. Therefore hinges that turn by more than 150 degrees and continue
/// each other at an interior vertex (within 60 degrees) all turn in the same
/// direction, the one with the smaller sum of their turns.
Eigen::VectorXd UnwrappedAngles(const HingeTopology& topology, const Points& previousPoints,
  const Eigen::VectorXd& previous, const Eigen::VectorXd& angles);

/// Triangles laid out in the plane, their corners counter-clockwise, (x, y) of
/// one after the other: #T x 6.
using Layouts = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

/// From edge lengths, all positive. The first corner is the origin, the second on
/// the x axis. Lengths that break the triangle inequality, or keep it by less than
/// their rounding, give a triangle without area.
Layouts LayOut(const HingeTopology& topology, const Eigen::VectorXd& lengths,
  const ExecutionContext& context = {});

/// The edge from a corner of a layout to the next corner.
inline Eigen::Vector2d LayoutEdge(const Layouts& layouts, int triangle, int corner)
{
  return layouts.block<1, 2>(triangle, 2 * ((corner + 1) % 3)).transpose() -
    layouts.block<1, 2>(triangle, 2 * corner).transpose();
}

/// The rotation from the frame of a hinge's left to that of its right triangle:
/// #hinges x 9, B_right = B_left Q. The frame B of a triangle maps its layout to
/// space, z to its normal. With the directions a and b of the edge in the two
/// layouts, as angles, and the hinge's angle h,
///
///   Q = R_z(a) R_x(h) R_z(-b).
Matrices HingeTransitions(const HingeTopology& topology, const Layouts& layouts,
  const Eigen::VectorXd& angles, const ExecutionContext& context = {});
}
