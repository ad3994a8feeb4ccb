// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/Hinges.h"

#include "Base/Constants.h"
#include "Base/DisjointSets.h"
#include "Base/FloodFill.h"
#include "Mesh/TriangleShape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace cartan
{
namespace
{
/// Below this, in radians, angles that should be equal count as such.
constexpr double AngleTolerance = 1e-6;
/// What UnwrappedAngles says of creases, in radians and as a cosine.
constexpr double CreaseTurn = Pi * 150.0 / 180.0;
constexpr double CreaseCosine = 0.5;

Eigen::Vector3d EdgeVector(const HingeTopology& topology, const Points& points, int t, int corner)
{
  return points.row(topology.Corners(t, (corner + 1) % 3)) -
    points.row(topology.Corners(t, corner));
}

/// The hinges at every triangle's corners: #T x 3, -1 at the boundary.
Triangles CornerHinges(const HingeTopology& topology)
{
  Triangles cornerHinges = Triangles::Constant(topology.NumberOfTriangles(), 3, -1);
  for (int h = 0; h < topology.NumberOfHinges(); ++h)
  {
    const Hinge& hinge = topology.Hinges[h];
    cornerHinges(hinge.Left, hinge.LeftCorner) = h;
    cornerHinges(hinge.Right, hinge.RightCorner) = h;
  }
  return cornerHinges;
}

/// Writes the unit normals of the triangles that have an area, and returns those.
std::vector<int> FindNormals(const HingeTopology& topology, const Points& points, Points& normals,
  std::vector<char>* isDegenerate)
{
  std::vector<int> withArea;
  for (int t = 0; t < topology.NumberOfTriangles(); ++t)
  {
    const Eigen::Vector3d ab = EdgeVector(topology, points, t, 0);
    const Eigen::Vector3d bc = EdgeVector(topology, points, t, 1);
    const Eigen::Vector3d ca = EdgeVector(topology, points, t, 2);
    const Eigen::Vector3d normal = ca.cross(ab);
    if (HasArea(normal.norm(), std::max({ ab.squaredNorm(), bc.squaredNorm(), ca.squaredNorm() })))
    {
      normals.row(t) = normal.stableNormalized().transpose();
      withArea.push_back(t);
    }
    else if (isDegenerate)
    {
      (*isDegenerate)[t] = 1;
    }
  }
  return withArea;
}

/// The normal of a neighbor, for a triangle without area: the part of it that is
/// perpendicular to the triangle's longest edge; any such direction where none is left.
Eigen::Vector3d BorrowedNormal(
  const HingeTopology& topology, const Points& points, int t, const Eigen::Vector3d& neighbor)
{
  Eigen::Vector3d longest = EdgeVector(topology, points, t, 0);
  for (const int corner : { 1, 2 })
  {
    const Eigen::Vector3d edge = EdgeVector(topology, points, t, corner);
    longest = edge.squaredNorm() > longest.squaredNorm() ? edge : longest;
  }
  longest.stableNormalize();
  const Eigen::Vector3d normal = neighbor - longest * longest.dot(neighbor);
  // Parallel but for rounding.
  return normal.norm() > 1e-6 ? normal.normalized() : longest.unitOrthogonal();
}

/// #V.
std::vector<char> IsBoundaryVertex(const HingeTopology& topology)
{
  std::vector<char> isHinge(topology.NumberOfEdges(), 0);
  for (const Hinge& hinge : topology.Hinges)
  {
    isHinge[hinge.Edge] = 1;
  }
  std::vector<char> isBoundary(topology.NumberOfVertices, 0);
  for (int e = 0; e < topology.NumberOfEdges(); ++e)
  {
    if (!isHinge[e])
    {
      isBoundary[topology.Edges(e, 0)] = isBoundary[topology.Edges(e, 1)] = 1;
    }
  }
  return isBoundary;
}

/// Which of the hinges that have `isTurning` belong to one crease: those that
/// UnwrappedAngles must turn together.
DisjointSets GroupCreases(
  const HingeTopology& topology, const Points& points, const std::vector<char>& isTurning)
{
  struct End
  {
    int Hinge;
    Eigen::Vector3d Direction;
  };
  std::vector<std::vector<End>> ends(topology.NumberOfVertices);
  const std::vector<char> isBoundary = IsBoundaryVertex(topology);
  for (int h = 0; h < topology.NumberOfHinges(); ++h)
  {
    const int a = topology.Edges(topology.Hinges[h].Edge, 0);
    const int b = topology.Edges(topology.Hinges[h].Edge, 1);
    const Eigen::Vector3d direction = (points.row(b) - points.row(a)).stableNormalized();
    if (isTurning[h] && !isBoundary[a])
    {
      ends[a].push_back({ h, direction });
    }
    if (isTurning[h] && !isBoundary[b])
    {
      ends[b].push_back({ h, -direction });
    }
  }
  DisjointSets creases(topology.NumberOfHinges());
  for (const std::vector<End>& atVertex : ends)
  {
    for (const End& one : atVertex)
    {
      for (const End& other : atVertex)
      {
        if (one.Direction.dot(other.Direction) < -CreaseCosine)
        {
          creases.Join(one.Hinge, other.Hinge);
        }
      }
    }
  }
  return creases;
}
}

HingeTopology::HingeTopology(const TriangleMesh& mesh)
  : NumberOfVertices(mesh.NumberOfVertices())
  , Corners(mesh.GetTriangles())
  , CornerEdges(mesh.NumberOfTriangles(), 3)
  , Edges(mesh.NumberOfEdges(), 2)
{
  const auto cornerOf = [this](int triangle, int vertex) {
    return this->Corners(triangle, 0) == vertex ? 0 : this->Corners(triangle, 1) == vertex ? 1 : 2;
  };
  int edge = 0;
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    const int twin = mesh.Twin(d);
    if (twin < d)
    {
      continue;
    }
    this->Edges.row(edge) << mesh.Origin(d), mesh.Neighbor(d);
    const int left = mesh.LeftTriangle(d);
    const int right = mesh.LeftTriangle(twin);
    const int leftCorner = left < 0 ? -1 : cornerOf(left, mesh.Origin(d));
    const int rightCorner = right < 0 ? -1 : cornerOf(right, mesh.Neighbor(d));
    if (left >= 0)
    {
      this->CornerEdges(left, leftCorner) = edge;
    }
    if (right >= 0)
    {
      this->CornerEdges(right, rightCorner) = edge;
    }
    if (left >= 0 && right >= 0)
    {
      this->Hinges.push_back({ left, leftCorner, right, rightCorner, edge });
    }
    ++edge;
  }
}

Eigen::VectorXd EdgeLengths(
  const HingeTopology& topology, const Points& points, const ExecutionContext& context)
{
  Eigen::VectorXd lengths(topology.NumberOfEdges());
  context.For(topology.NumberOfEdges(),
    [&](int begin, int end)
    {
      for (int e = begin; e < end; ++e)
      {
        lengths[e] =
          (points.row(topology.Edges(e, 1)) - points.row(topology.Edges(e, 0))).stableNorm();
      }
    });
  return lengths;
}

Points HingeNormals(
  const HingeTopology& topology, const Points& points, std::vector<char>* isDegenerate)
{
  const int count = topology.NumberOfTriangles();
  Points normals = Points::Zero(count, 3);
  const std::vector<int> withArea = FindNormals(topology, points, normals, isDegenerate);
  if (static_cast<int>(withArea.size()) == count)
  {
    return normals;
  }
  const Triangles cornerHinges = CornerHinges(topology);
  std::vector<char> isKnown(count, 0);
  const auto spread = [&](const std::vector<int>& seeds)
  {
    FloodFill(
      seeds, [&isKnown](int t) { return !std::exchange(isKnown[t], 1); },
      [&](int t, const auto& reach)
      {
        for (int corner = 0; corner < 3; ++corner)
        {
          const int h = cornerHinges(t, corner);
          if (h < 0)
          {
            continue;
          }
          const int other = topology.Hinges[h].OtherTriangle(t);
          if (!isKnown[other])
          {
            normals.row(other) =
              BorrowedNormal(topology, points, other, normals.row(t)).transpose();
            reach(other);
          }
        }
      });
  };
  spread(withArea);
  // Parts that none of them reaches have any normal.
  for (int t = 0; t < count; ++t)
  {
    if (!isKnown[t])
    {
      normals.row(t) = BorrowedNormal(topology, points, t, Eigen::Vector3d::Zero()).transpose();
      spread({ t });
    }
  }
  return normals;
}

Eigen::VectorXd HingeAngles(const HingeTopology& topology, const Points& points,
  const Points& normals, const ExecutionContext& context)
{
  Eigen::VectorXd angles(topology.NumberOfHinges());
  context.For(topology.NumberOfHinges(),
    [&](int begin, int end)
    {
      for (int h = begin; h < end; ++h)
      {
        const Hinge& hinge = topology.Hinges[h];
        const Eigen::Vector3d left = normals.row(hinge.Left);
        const Eigen::Vector3d right = normals.row(hinge.Right);
        const Eigen::Vector3d edge =
          EdgeVector(topology, points, hinge.Left, hinge.LeftCorner).stableNormalized();
        const double angle = std::atan2(left.cross(right).dot(edge), left.dot(right));
        angles[h] = angle < AngleTolerance - Pi ? angle + FullTurn : angle;
      }
    });
  return angles;
}

Eigen::VectorXd UnwrappedAngles(const HingeTopology& topology, const Points& previousPoints,
  const Eigen::VectorXd& previous, const Eigen::VectorXd& angles)
{
  const int count = topology.NumberOfHinges();
  Eigen::VectorXd turns(count);
  std::vector<char> isTurning(count, 0);
  bool anyTurns = false;
  for (int h = 0; h < count; ++h)
  {
    turns[h] = std::remainder(angles[h] - previous[h], FullTurn);
    isTurning[h] = std::abs(turns[h]) > CreaseTurn;
    anyTurns = anyTurns || isTurning[h];
  }
  if (!anyTurns)
  {
    return previous + turns;
  }

  DisjointSets creases = GroupCreases(topology, previousPoints, isTurning);
  Eigen::VectorXd excess = Eigen::VectorXd::Zero(count); // of turning to the positive side
  Eigen::VectorXd direct = Eigen::VectorXd::Zero(count);
  Eigen::VectorXi members = Eigen::VectorXi::Zero(count);
  for (int h = 0; h < count; ++h)
  {
    if (isTurning[h])
    {
      // Both angles as they are in space: a turn between them misses pi.
      const double before =
        previous[h] - FullTurn * std::ceil((previous[h] - Pi - AngleTolerance) / (FullTurn));
      const int crease = creases.Find(h);
      excess[crease] += (turns[h] > 0.0 ? turns[h] : turns[h] + FullTurn) - Pi;
      direct[crease] += angles[h] - before;
      ++members[crease];
    }
  }
  for (int h = 0; h < count; ++h)
  {
    if (isTurning[h])
    {
      const int crease = creases.Find(h);
      const bool isTie = std::abs(excess[crease]) <= AngleTolerance * members[crease];
      const bool isPositive = isTie ? direct[crease] >= 0.0 : excess[crease] < 0.0;
      if (isPositive != (turns[h] > 0.0))
      {
        turns[h] += isPositive ? FullTurn : -FullTurn;
      }
    }
  }
  return previous + turns;
}

Layouts LayOut(
  const HingeTopology& topology, const Eigen::VectorXd& lengths, const ExecutionContext& context)
{
  Layouts layouts(topology.NumberOfTriangles(), 6);
  context.For(topology.NumberOfTriangles(),
    [&](int begin, int end)
    {
      for (int t = begin; t < end; ++t)
      {
        const std::array<double, 3> sides = { lengths[topology.CornerEdges(t, 0)],
          lengths[topology.CornerEdges(t, 1)], lengths[topology.CornerEdges(t, 2)] };
        const int base =
          static_cast<int>(std::max_element(sides.begin(), sides.end()) - sides.begin());
        const double ab = sides[base];
        const double bc = sides[(base + 1) % 3];
        const double ca = sides[(base + 2) % 3];
        // (4 area)^2 as a product that loses no digits (Kahan, Miscalculating Area
        // and Angles of a Needle-like Triangle, 2014). The factor `slack` is all
        // that can be negative, or rounding alone.
        const double longer = std::max(bc, ca);
        const double shorter = std::min(bc, ca);
        const double slack = shorter - (ab - longer);
        const double product = slack > 4.0 * std::numeric_limits<double>::epsilon() * ab
          ? (ab + (longer + shorter)) * slack * (shorter + (ab - longer)) *
            (ab + (longer - shorter))
          : 0.0;
        const double x = 0.5 * (ab + (ca - bc) * (ca + bc) / ab);
        const double y = 0.5 * std::sqrt(product) / ab;
        std::array<Eigen::Vector2d, 3> corners;
        corners[base] = Eigen::Vector2d(0.0, 0.0);
        corners[(base + 1) % 3] = Eigen::Vector2d(ab, 0.0);
        corners[(base + 2) % 3] = Eigen::Vector2d(x, y);
        const Eigen::Vector2d first = (corners[1] - corners[0]).normalized();
        const Eigen::Vector2d third = corners[2] - corners[0];
        layouts.row(t) << 0.0, 0.0, sides[0], 0.0, first.dot(third),
          first[0] * third[1] - first[1] * third[0];
      }
    });
  return layouts;
}

Matrices HingeTransitions(const HingeTopology& topology, const Layouts& layouts,
  const Eigen::VectorXd& angles, const ExecutionContext& context)
{
  Matrices transitions(topology.NumberOfHinges(), 9);
  context.For(topology.NumberOfHinges(),
    [&](int begin, int end)
    {
      for (int h = begin; h < end; ++h)
      {
        const Hinge& hinge = topology.Hinges[h];
        const Eigen::Vector2d a = LayoutEdge(layouts, hinge.Left, hinge.LeftCorner).normalized();
        const Eigen::Vector2d b = -LayoutEdge(layouts, hinge.Right, hinge.RightCorner).normalized();
        const double c = std::cos(angles[h]);
        const double s = std::sin(angles[h]);
        // R_z(a) R_x(h) has the columns (a, 0), (-c a_y, c a_x, s),
        // (s a_y, -s a_x, c).
        const Eigen::Vector3d along(a[0], a[1], 0.0);
        const Eigen::Vector3d across(-c * a[1], c * a[0], s);
        auto transition = MatrixAt(transitions, h);
        transition.col(0) = b[0] * along - b[1] * across;
        transition.col(1) = b[1] * along + b[0] * across;
        transition.col(2) = Eigen::Vector3d(s * a[1], -s * a[0], c);
      }
    });
  return transitions;
}
}
