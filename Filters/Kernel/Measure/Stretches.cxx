// SPDX-License-Identifier: BSD-3-Clause
#include "Measure/Stretches.h"

#include "Mesh/Geometry.h"
#include "Mesh/TriangleShape.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cartan
{
namespace
{
/// Stretches that differ by less, in parts of their mean, have no directions.
constexpr double SameStretch = 1e-12;

/// A ring whose second squared extent is below this part of the first is a line up to
/// rounding; one whose third is below this part is flat for all purposes.
constexpr double LinePart = 1e-15;
constexpr double FlatPart = 1e-20;

/// Rings with a determinant of extents above this part of the cubed trace bend so much that the
/// inverse by cofactors is as good as that by axes, and much faster.
constexpr double BentPart = 1e-5;

constexpr double Undefined = std::numeric_limits<double>::quiet_NaN();

using TangentMap = Eigen::Matrix<double, 3, 2>;

Stretches Sized(int count)
{
  return { Eigen::VectorXd::Ones(count), Eigen::VectorXd::Ones(count), Points::Zero(count, 3),
    Points::Zero(count, 3) };
}

void SetUndefined(int row, Stretches& stretches)
{
  stretches.Larger[row] = Undefined;
  stretches.Smaller[row] = Undefined;
}

/// Cosine and sine of half an angle between -pi and pi, from those of the angle.
Eigen::Vector2d HalfAngle(double cosine, double sine)
{
  if (cosine >= 0.0)
  {
    const double half = std::sqrt(0.5 * (1.0 + cosine));
    return { half, 0.5 * sine / half };
  }
  const double half = std::copysign(std::sqrt(0.5 * (1.0 - cosine)), sine);
  return { 0.5 * sine / half, half };
}

/// The singular values and left singular vectors of a linear map from the plane to space.
void SetStretch(const TangentMap& map, int row, Stretches& stretches)
{
  // In an orthonormal basis (u, v) of the image, the map is (a b; 0 d) with d >= 0.
  const double a = map.col(0).norm();
  const Eigen::Vector3d u =
    a > 0.0 ? Eigen::Vector3d(map.col(0) / a) : Eigen::Vector3d(map.col(1).normalized());
  const double b = u.dot(map.col(1));
  const Eigen::Vector3d rest = map.col(1) - b * u;
  const double d = rest.norm();
  const Eigen::Vector3d v = d > 0.0 ? Eigen::Vector3d(rest / d) : Eigen::Vector3d::Zero();
  // (a b; 0 d) is the sum of a rotation by alpha times q and a reflection by beta times r
  // (Blinn, Consider the lowly 2x2 matrix, 1996): its singular values are q + r and q - r.
  const double q = 0.5 * std::sqrt((a + d) * (a + d) + b * b);
  const double r = 0.5 * std::sqrt((a - d) * (a - d) + b * b);
  stretches.Larger[row] = q + r;
  stretches.Smaller[row] = std::max(0.0, q - r);
  if (r > SameStretch * q)
  {
    // Turned from u by half the sum of both angles.
    const Eigen::Vector2d reflected = HalfAngle(0.5 * (a - d) / r, 0.5 * b / r);
    const Eigen::Vector2d turned = HalfAngle(0.5 * (a + d) / q, -0.5 * b / q);
    const double cosine = reflected[0] * turned[0] - reflected[1] * turned[1];
    const double sine = reflected[0] * turned[1] + reflected[1] * turned[0];
    const Eigen::Vector3d larger = cosine * u + sine * v;
    const Eigen::Vector3d smaller = cosine * v - sine * u;
    stretches.LargerDirections.row(row) = larger.transpose();
    stretches.SmallerDirections.row(row) = smaller.transpose();
  }
}

/// The map of the plane of a triangle in the reference, in an orthonormal basis of it; false
/// where it has no area.
bool MapTriangle(const Eigen::Vector3d p[3], const Eigen::Vector3d q[3], TangentMap& map)
{
  const Eigen::Vector3d along = p[1] - p[0];
  const Eigen::Vector3d across = p[2] - p[0];
  const double twiceArea = along.cross(across).norm();
  if (!HasArea(twiceArea, LongestEdgeSquared(p[0], p[1], p[2])))
  {
    return false;
  }
  // along = (l, 0), across = (x, h): the inverse of (l x; 0 h).
  const double l = along.norm();
  const double x = along.dot(across) / l;
  const double h = twiceArea / l;
  map.col(0) = (q[1] - q[0]) / l;
  map.col(1) = (q[2] - q[0] - x * map.col(0)) / h;
  return true;
}

/// The pseudo-inverse of a symmetric matrix times two orthonormal tangents; zero where the ring
/// that the matrix is of has no area.
TangentMap DualTangents(const Eigen::Matrix3d& extents, const Eigen::Vector3d& normal)
{
  TangentMap duals = TangentMap::Zero();
  if (normal.isZero(0.0))
  {
    return duals;
  }
  TangentMap tangents;
  tangents.col(0) = normal.unitOrthogonal();
  tangents.col(1) = normal.cross(tangents.col(0));
  if (extents.determinant() > BentPart * std::pow(extents.trace(), 3))
  {
    return extents.inverse() * tangents;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(extents);
  const Eigen::Vector3d& values = axes.eigenvalues(); // increasing
  if (!(values[1] > LinePart * values[2]))
  {
    return duals;
  }
  for (int k = 0; k < 3; ++k)
  {
    if (values[k] > FlatPart * values[2])
    {
      const Eigen::Vector3d axis = axes.eigenvectors().col(k);
      duals += axis * (axis.transpose() * tangents) / values[k];
    }
  }
  return duals;
}
}

Stretches TriangleStretches(const TriangleMesh& mesh, const Points& reference,
  const Points& current, const ExecutionContext& context)
{
  Stretches stretches = Sized(mesh.NumberOfTriangles());
  context.For(mesh.NumberOfTriangles(),
    [&](int begin, int end)
    {
      for (int t = begin; t < end; ++t)
      {
        Eigen::Vector3d p[3];
        Eigen::Vector3d q[3];
        for (int corner = 0; corner < 3; ++corner)
        {
          const int v = mesh.GetTriangles()(t, corner);
          p[corner] = reference.row(v).transpose();
          q[corner] = current.row(v).transpose();
        }
        TangentMap map;
        if (MapTriangle(p, q, map))
        {
          SetStretch(map, t, stretches);
        }
        else
        {
          SetUndefined(t, stretches);
        }
      }
    });
  return stretches;
}

RingStretches::RingStretches(std::shared_ptr<const TriangleMesh> mesh,
  std::shared_ptr<const Points> reference, const ExecutionContext& context)
  : Mesh(std::move(mesh))
  , Reference(std::move(reference))
  , Duals(this->Mesh->NumberOfVertices())
{
  const Points normals = VertexNormals(*this->Mesh, *this->Reference, context);
  context.For(this->Mesh->NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        Eigen::Matrix3d extents = Eigen::Matrix3d::Zero();
        for (int d = this->Mesh->RingBegin(v); d < this->Mesh->RingEnd(v); ++d)
        {
          const Eigen::Vector3d p =
            (this->Reference->row(this->Mesh->Neighbor(d)) - this->Reference->row(v)).transpose();
          const double squared = p.squaredNorm();
          if (squared > 0.0)
          {
            extents += p * p.transpose() / squared;
          }
        }
        this->Duals[v] = DualTangents(extents, normals.row(v).transpose());
      }
    });
}

Stretches RingStretches::Measure(const Points& current, const ExecutionContext& context) const
{
  const TriangleMesh& mesh = *this->Mesh;
  const Points& reference = *this->Reference;
  Stretches stretches = Sized(mesh.NumberOfVertices());
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        if (!mesh.IsUsed(v))
        {
          continue;
        }
        const TangentMap& duals = this->Duals[v];
        if (duals.isZero(0.0))
        {
          SetUndefined(v, stretches);
          continue;
        }
        TangentMap map = TangentMap::Zero();
        for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
        {
          const int w = mesh.Neighbor(d);
          const Eigen::RowVector3d p = reference.row(w) - reference.row(v);
          const double squared = p.squaredNorm();
          if (squared > 0.0)
          {
            const Eigen::Vector3d q = (current.row(w) - current.row(v)).transpose() / squared;
            map += q.lazyProduct(p * duals);
          }
        }
        SetStretch(map, v, stretches);
      }
    });
  return stretches;
}

Eigen::VectorXd Strains(const Eigen::VectorXd& stretches, StrainMeasure measure)
{
  const Eigen::ArrayXd s = stretches.array();
  switch (measure)
  {
    case StrainMeasure::Biot:
      return s - 1.0;
    case StrainMeasure::GreenLagrange:
      return 0.5 * (s * s - 1.0);
    case StrainMeasure::Hencky:
      return s.log();
    default:
      return 0.5 * (1.0 - (s * s).inverse());
  }
}
}
