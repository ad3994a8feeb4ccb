// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/DiscreteForms.h"

#include "Algebra/Rotation.h"
#include "Mesh/Geometry.h"
#include "Mesh/TriangleShape.h"

#include <cmath>
#include <limits>

namespace cartan
{
namespace
{
/// A projected edge shorter than this part of the ring's longest edge has no
/// direction that rounding leaves intact.
constexpr double ParallelToNormal = 1e-10;

/// The unit directions of v's edges projected on the plane normal to `normal`,
/// one per ring entry; edges without one take that of the edge before them (at
/// the start of a boundary fan, of the first one that has one).
void ProjectedDirections(const TriangleMesh& mesh, const Points& points, int v,
  const Eigen::Vector3d& normal, std::vector<Eigen::Vector3d>& directions)
{
  const int valence = mesh.Valence(v);
  directions.assign(valence, Eigen::Vector3d::Zero());
  double longest = 0.0;
  for (int k = 0; k < valence; ++k)
  {
    const Eigen::Vector3d edge =
      (points.row(mesh.Neighbor(mesh.RingBegin(v) + k)) - points.row(v)).transpose();
    longest = std::max(longest, edge.norm());
    directions[k] = edge - edge.dot(normal) * normal;
  }
  int firstGood = -1;
  int lastGood = -1;
  for (int k = 0; k < valence; ++k)
  {
    const double length = directions[k].norm();
    if (length > ParallelToNormal * longest)
    {
      directions[k] /= length;
      firstGood = firstGood < 0 ? k : firstGood;
      lastGood = k;
    }
    else
    {
      directions[k].setZero();
    }
  }
  if (firstGood < 0)
  {
    directions.assign(valence, normal.unitOrthogonal());
    return;
  }
  Eigen::Vector3d previous = directions[mesh.IsBoundary(v) ? firstGood : lastGood];
  for (Eigen::Vector3d& direction : directions)
  {
    direction = direction.isZero(0.0) ? previous : direction;
    previous = direction;
  }
}

/// The ring entry before d around its origin; -1 at the start of a boundary fan.
int Previous(const TriangleMesh& mesh, int origin, int d)
{
  if (d > mesh.RingBegin(origin))
  {
    return d - 1;
  }
  return mesh.IsBoundary(origin) ? -1 : mesh.RingEnd(origin) - 1;
}

/// Theorem 3.1 seeks the frame of j in that of i. What it knows of the corner at
/// j between two edges that leave j: both edges in i's frame, and from j's own
/// forms their heights, orientation bit and angles from b1.
struct CornerAtNeighbor
{
  Eigen::Vector3d First;
  Eigen::Vector3d Second;
  double FirstHeight;
  double SecondHeight;
  int Orientation;
  double FirstAngle;
  double SecondAngle;
};

/// Returns whether the corner determines the frame.
bool SolveCorner(const CornerAtNeighbor& corner, Eigen::Ref<Eigen::Matrix3d> transition)
{
  const Eigen::Vector3d& u = corner.First;
  const Eigen::Vector3d& v = corner.Second;
  const Eigen::Vector3d cross = u.cross(v);
  const double crossSquared = cross.squaredNorm();
  if (!HasArea(std::sqrt(crossSquared), std::max(u.squaredNorm(), v.squaredNorm())) ||
    corner.Orientation == 0)
  {
    return false;
  }
  // The minimum-norm solution p of <u, p> = h_u, <v, p> = h_v (Eq. 3), and the
  // unit normal over it; the orientation bit chooses between the two.
  const Eigen::Vector3d p =
    (corner.FirstHeight * v.cross(cross) + corner.SecondHeight * cross.cross(u)) / crossSquared;
  const Eigen::Vector3d normal = (p +
    corner.Orientation * std::sqrt(std::max(0.0, 1.0 - p.squaredNorm())) * cross /
      std::sqrt(crossSquared))
                                   .normalized();
  // The longer projection fixes the tangent directions (Lemma 2.1).
  const Eigen::Vector3d uTangent = u - u.dot(normal) * normal;
  const Eigen::Vector3d vTangent = v - v.dot(normal) * normal;
  const bool useFirst = uTangent.squaredNorm() > vTangent.squaredNorm();
  const Eigen::Vector3d tangent = (useFirst ? uTangent : vTangent).normalized();
  const double angle = useFirst ? corner.FirstAngle : corner.SecondAngle;
  const Eigen::Vector3d b1 = std::cos(angle) * tangent - std::sin(angle) * normal.cross(tangent);
  transition.col(0) = b1;
  transition.col(1) = normal.cross(b1);
  transition.col(2) = normal;
  return true;
}

/// The angle of each directed edge from b1 of its origin's frame: #D.
Eigen::VectorXd AnglesFromFirst(const TriangleMesh& mesh, const DiscreteForms& forms)
{
  Eigen::VectorXd angles(mesh.NumberOfDirectedEdges());
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    double angle = 0.0;
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      angles[d] = angle;
      angle += forms.Angle[d];
    }
  }
  return angles;
}

/// Theorem 3.1 for i -> j: the triangle on the left, else the one on the right.
bool TransitionByBits(const TriangleMesh& mesh, const DiscreteForms& forms, const Points& ring,
  const Eigen::VectorXd& angles, int i, int d, Eigen::Ref<Eigen::Matrix3d> transition)
{
  const int back = mesh.Twin(d); // j -> i
  const Eigen::Vector3d toI = -ring.row(d).transpose();
  const int left = mesh.NextAround(i, d);
  if (left >= 0)
  {
    const int fromJ = Previous(mesh, mesh.Neighbor(d), back);
    const Eigen::Vector3d toApex = (ring.row(left) - ring.row(d)).transpose();
    if (SolveCorner({ toApex, toI, forms.Height[fromJ], forms.Height[back],
                      forms.Orientation[fromJ], angles[fromJ], angles[back] },
          transition))
    {
      return true;
    }
  }
  const int right = mesh.NextAround(mesh.Neighbor(d), back);
  if (right < 0)
  {
    return false;
  }
  const Eigen::Vector3d toApex = (ring.row(Previous(mesh, i, d)) - ring.row(d)).transpose();
  return SolveCorner({ toI, toApex, forms.Height[back], forms.Height[right],
                       forms.Orientation[back], angles[back], angles[right] },
    transition);
}

/// The same where the points p_k are all but on a line, about which next to
/// nothing in that sum turns: from the unit vectors between all points, and the
/// unit normals over the first two and each other one.
Eigen::Matrix3d RotationByDirections(const Eigen::Matrix<double, 3, Eigen::Dynamic>& p,
  const Eigen::Matrix<double, 3, Eigen::Dynamic>& q)
{
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (Eigen::Index k = 1; k < p.cols(); ++k)
  {
    for (Eigen::Index l = 0; l < k; ++l)
    {
      products +=
        (p.col(k) - p.col(l)).normalized() * (q.col(k) - q.col(l)).normalized().transpose();
    }
    const Eigen::Vector3d overP = (p.col(1) - p.col(0)).cross(p.col(k) - p.col(0));
    const Eigen::Vector3d overQ = (q.col(1) - q.col(0)).cross(q.col(k) - q.col(0));
    products += overP.normalized() * overQ.normalized().transpose();
  }
  return ProjectOnRotations(products);
}

/// The rotation C that minimizes sum |p_k - C q_k - shift|^2 over the vertices
/// i, j and those opposite to their edge, p as seen from i and q from j: the
/// orthogonal factor of sum (p_k - mean p) (q_k - mean q)^T (Kabsch, A solution
/// for the best rotation to relate two sets of vectors, 1976).
bool TransitionByProcrustes(const TriangleMesh& mesh, const Points& ring, int i, int d,
  Eigen::Ref<Eigen::Matrix3d> transition)
{
  const int j = mesh.Neighbor(d);
  const int back = mesh.Twin(d);
  Eigen::Matrix<double, 3, 4> fromI = Eigen::Matrix<double, 3, 4>::Zero();
  Eigen::Matrix<double, 3, 4> fromJ = Eigen::Matrix<double, 3, 4>::Zero();
  fromI.col(1) = ring.row(d).transpose();
  fromJ.col(0) = ring.row(back).transpose();
  int count = 2;
  const auto addApex = [&](int entryOfI, int entryOfJ)
  {
    fromI.col(count) = ring.row(entryOfI).transpose();
    fromJ.col(count) = ring.row(entryOfJ).transpose();
    ++count;
  };
  if (mesh.LeftTriangle(d) >= 0)
  {
    addApex(mesh.NextAround(i, d), Previous(mesh, j, back));
  }
  if (mesh.LeftTriangle(back) >= 0)
  {
    addApex(Previous(mesh, i, d), mesh.NextAround(j, back));
  }
  // Points on a line leave the rotation about it open, those near one to rounding.
  constexpr double thin = 1e-6;
  bool hasArea = false;
  bool isThin = true;
  for (int apex = 2; apex < count; ++apex)
  {
    const Eigen::Vector3d edge = fromI.col(1);
    const Eigen::Vector3d side = fromI.col(apex);
    const double twiceArea = edge.cross(side).norm();
    const double longestSquared = LongestEdgeSquared(fromI.col(0), edge, side);
    hasArea = hasArea || HasArea(twiceArea, longestSquared);
    isThin = isThin && !(twiceArea > thin * longestSquared);
  }
  if (!hasArea)
  {
    return false;
  }
  auto p = fromI.leftCols(count);
  auto q = fromJ.leftCols(count);
  if (isThin)
  {
    transition = RotationByDirections(p, q);
    return true;
  }
  p.colwise() -= p.rowwise().mean().eval();
  q.colwise() -= q.rowwise().mean().eval();
  transition = ProjectOnRotations(p * q.transpose());
  return true;
}
}

Matrices VertexFrames(
  const TriangleMesh& mesh, const Points& points, const ExecutionContext& context)
{
  const Points normals = VertexNormals(mesh, points, context);
  IdSample withoutNormal;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v) && normals.row(v).isZero(0.0))
    {
      withoutNormal.Add(v);
    }
  }
  if (!withoutNormal.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The surface has " + withoutNormal.Describe("point", "points") +
        " without a normal, because their triangles have no area or fold back on each other: "
        "move these points or their neighbors, remove their triangles, or, where points coincide, "
        "merge them with vtkPrepareSurface (Prepare Surface).");
  }
  Matrices frames(mesh.NumberOfVertices(), 9);
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      std::vector<Eigen::Vector3d> directions;
      for (int v = begin; v < end; ++v)
      {
        auto frame = MatrixAt(frames, v);
        frame.setIdentity();
        if (mesh.IsUsed(v))
        {
          const Eigen::Vector3d normal = normals.row(v);
          ProjectedDirections(mesh, points, v, normal, directions);
          frame.col(0) = directions[0];
          frame.col(1) = normal.cross(directions[0]);
          frame.col(2) = normal;
        }
      }
    });
  return frames;
}

DiscreteForms ComputeDiscreteForms(const TriangleMesh& mesh, const Points& points,
  const Matrices& frames, const ExecutionContext& context)
{
  const int numberOfDirectedEdges = mesh.NumberOfDirectedEdges();
  DiscreteForms forms;
  forms.Length.resize(numberOfDirectedEdges);
  forms.Angle.resize(numberOfDirectedEdges);
  forms.Height.resize(numberOfDirectedEdges);
  forms.Orientation.resize(numberOfDirectedEdges);
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      std::vector<Eigen::Vector3d> directions;
      for (int v = begin; v < end; ++v)
      {
        const Eigen::Vector3d normal = MatrixAt(frames, v).col(2);
        ProjectedDirections(mesh, points, v, normal, directions);
        for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
        {
          const Eigen::Vector3d edge = (points.row(mesh.Neighbor(d)) - points.row(v)).transpose();
          forms.Height[d] = edge.dot(normal);
          forms.Length[d] = (edge - forms.Height[d] * normal).norm();
          const int next = mesh.NextAround(v, d);
          if (next < 0)
          {
            forms.Angle[d] = std::numeric_limits<double>::quiet_NaN();
            forms.Orientation[d] = 0;
            continue;
          }
          const Eigen::Vector3d& from = directions[d - mesh.RingBegin(v)];
          const Eigen::Vector3d& to = directions[next - mesh.RingBegin(v)];
          const double sine = from.cross(to).dot(normal);
          forms.Angle[d] = std::atan2(sine, from.dot(to));
          forms.Orientation[d] = sine > 0.0 ? 1 : (sine < 0.0 ? -1 : 0);
        }
      }
    });
  return forms;
}

Points RingCoordinates(const TriangleMesh& mesh, const DiscreteForms& forms)
{
  const Eigen::VectorXd angles = AnglesFromFirst(mesh, forms);
  Points ring(mesh.NumberOfDirectedEdges(), 3);
  ring.col(0) = forms.Length.array() * angles.array().cos();
  ring.col(1) = forms.Length.array() * angles.array().sin();
  ring.col(2) = forms.Height;
  return ring;
}

Transitions TransitionsFromFrames(const TriangleMesh& mesh, const Matrices& frames)
{
  Transitions transitions(mesh.NumberOfDirectedEdges(), 9);
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    MatrixAt(transitions, d) =
      MatrixAt(frames, mesh.Origin(d)).transpose() * MatrixAt(frames, mesh.Neighbor(d));
  }
  return transitions;
}

Transitions TransitionsFromRings(
  const TriangleMesh& mesh, const Points& ring, const ExecutionContext& context)
{
  Transitions transitions(mesh.NumberOfDirectedEdges(), 9);
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
        {
          if (!TransitionByProcrustes(mesh, ring, v, d, MatrixAt(transitions, d)))
          {
            transitions.row(d).setZero();
          }
        }
      }
    });
  return transitions;
}

Transitions TransitionsFromForms(const TriangleMesh& mesh, const DiscreteForms& forms,
  TransitionMethod method, const ExecutionContext& context)
{
  const Points ring = RingCoordinates(mesh, forms);
  if (method == TransitionMethod::Procrustes)
  {
    return TransitionsFromRings(mesh, ring, context);
  }
  const Eigen::VectorXd angles = AnglesFromFirst(mesh, forms);
  Transitions transitions(mesh.NumberOfDirectedEdges(), 9);
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
        {
          if (!TransitionByBits(mesh, forms, ring, angles, v, d, MatrixAt(transitions, d)))
          {
            transitions.row(d).setZero();
          }
        }
      }
    });
  return transitions;
}
}
