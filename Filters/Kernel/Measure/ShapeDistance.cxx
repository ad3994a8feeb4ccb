// SPDX-License-Identifier: BSD-3-Clause
#include "Measure/ShapeDistance.h"

#include "Differential/SurfaceFit.h"
#include "Measure/Areas.h"
#include "Mesh/Geometry.h"
#include "Mesh/TriangleShape.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>

namespace cartan
{
namespace
{
/// Relative to the number of points, in coordinates of unit variance: too little
/// to be seen where the points determine the fit, and enough for linear terms to
/// come before quadratic ones where they do not (few points, or all in two rows).
constexpr double LinearRidge = 1e-10;
constexpr double QuadraticRidge = 1e-6;

/// X1, X2, X11, X12, X22
struct QuadraticPatch
{
  const Eigen::Matrix<double, 3, 5>& Coefficients;

  Eigen::Vector3d Tangent(int i) const { return this->Coefficients.col(i); }
  Eigen::Vector3d Second(int i, int j) const { return this->Coefficients.col(2 + i + j); }

  /// Whether the tangents span a plane.
  bool IsRegular() const
  {
    const Eigen::Vector3d a = this->Tangent(0);
    const Eigen::Vector3d b = this->Tangent(1);
    return HasArea(a.cross(b).norm(), std::max(a.squaredNorm(), b.squaredNorm()));
  }

  /// (X1, X2, N), N the unit normal, and its derivative in direction i.
  Eigen::Matrix3d Frame() const
  {
    Eigen::Matrix3d frame;
    frame << this->Tangent(0), this->Tangent(1),
      this->Tangent(0).cross(this->Tangent(1)).normalized();
    return frame;
  }
  Eigen::Matrix3d FrameDerivative(int i) const
  {
    const Eigen::Vector3d area = this->Tangent(0).cross(this->Tangent(1));
    const Eigen::Vector3d normal = area.normalized();
    const Eigen::Vector3d change =
      this->Second(0, i).cross(this->Tangent(1)) + this->Tangent(0).cross(this->Second(1, i));
    Eigen::Matrix3d derivative;
    derivative << this->Second(0, i), this->Second(1, i),
      (change - normal * normal.dot(change)) / area.norm();
    return derivative;
  }
};

/// The axes of (s, t) around a vertex. False if the points coincide.
bool FitAxes(const Neighborhood& neighborhood, const Eigen::Vector3d& normal,
  Eigen::Matrix<double, 3, 2>& axes)
{
  axes.col(0) = normal.unitOrthogonal();
  axes.col(1) = normal.cross(axes.col(0));
  Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
  for (int k = 0; k < neighborhood.Size(); ++k)
  {
    const Eigen::RowVector2d planar = neighborhood.Offset(k).transpose() * axes;
    moments += planar.transpose() * planar / neighborhood.Size();
  }
  const double turn = 0.5 * std::atan2(2.0 * moments(0, 1), moments(0, 0) - moments(1, 1));
  axes = (axes * Eigen::Rotation2Dd(turn).toRotationMatrix()).eval();
  const double mean = 0.5 * moments.trace();
  const double spread = std::hypot(0.5 * (moments(0, 0) - moments(1, 1)), moments(0, 1));
  if (!(mean > 0.0))
  {
    return false;
  }
  // Where all points are in one line the other direction gets no say.
  const double first = std::sqrt(mean + spread);
  axes.col(0) /= first;
  axes.col(1) /= std::max(std::sqrt(std::max(mean - spread, 0.0)), 1e-6 * first);
  return true;
}

using Vector5 = Eigen::Matrix<double, 5, 1>;

Vector5 Monomials(const Eigen::Matrix<double, 3, 2>& axes, const Eigen::Vector3d& offset)
{
  const double s = offset.dot(axes.col(0));
  const double t = offset.dot(axes.col(1));
  Vector5 monomials;
  monomials << s, t, 0.5 * s * s, s * t, 0.5 * t * t;
  return monomials;
}

/// Tangents (X1, X2) in the orthonormal basis of X1 / |X1| and what is normal to it and N.
struct TangentBasis
{
  explicit TangentBasis(const Eigen::Matrix3d& frame)
    : Length(frame.col(0).norm())
  {
    this->Basis << frame.col(0) / this->Length, frame.col(2).cross(frame.col(0)) / this->Length,
      frame.col(2);
    this->Along = this->Basis.col(0).dot(frame.col(1));
    this->Across = this->Basis.col(1).dot(frame.col(1));
  }

  Eigen::Matrix3d Basis;
  double Length; ///< X1 is (Length, 0)
  double Along;  ///< X2 is (Along, Across)
  double Across;
};

/// The orthogonal factor of the map that takes one frame (X1, X2, N) to another. It turns the
/// normals into each other, and in the planes the map is (a b; 0 d), whose orthogonal factor is
/// (a + d, b; -b, a + d) by its length.
Eigen::Matrix3d RotationBetween(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to)
{
  const TangentBasis before(from);
  const TangentBasis now(to);
  const double a = now.Length / before.Length;
  const double b = (now.Along - a * before.Along) / before.Across;
  const double d = now.Across / before.Across;
  const double size = std::hypot(a + d, b);
  Eigen::Matrix3d turned = now.Basis;
  turned.col(0) = ((a + d) * now.Basis.col(0) - b * now.Basis.col(1)) / size;
  turned.col(1) = (b * now.Basis.col(0) + (a + d) * now.Basis.col(1)) / size;
  return turned * before.Basis.transpose();
}

/// |grad R|_F^2 / 2 of the map from one patch to the other.
double RotationEnergy(const QuadraticPatch& rest, const QuadraticPatch& deformed)
{
  if (!rest.IsRegular() || !deformed.IsRegular())
  {
    return 0.0;
  }
  // F T = T' and its derivative F' T = dT' - F dT
  const Eigen::Matrix3d restFrame = rest.Frame();
  const Eigen::Matrix3d frame = deformed.Frame();
  const Eigen::Matrix3d inverse = restFrame.inverse();
  const Eigen::Matrix3d map = frame * inverse;
  const Eigen::Matrix3d rotation = RotationBetween(restFrame, frame);
  const Eigen::Matrix3d stretch = rotation.transpose() * map;
  const Eigen::Matrix3d inertia =
    stretch.trace() * Eigen::Matrix3d::Identity() - 0.5 * (stretch + stretch.transpose());
  const Eigen::Matrix3d inverseInertia = inertia.inverse();
  Eigen::Matrix<double, 3, 2> turns;
  for (int i = 0; i < 2; ++i)
  {
    const Eigen::Matrix3d change = rotation.transpose() *
      (deformed.FrameDerivative(i) - map * rest.FrameDerivative(i)) * inverse;
    const Eigen::Vector3d axial(
      change(2, 1) - change(1, 2), change(0, 2) - change(2, 0), change(1, 0) - change(0, 1));
    turns.col(i) = inverseInertia * axial;
  }
  // sum of g^ij omega_i . omega_j, g the first fundamental form of the reference
  Eigen::Matrix2d metric;
  metric << rest.Tangent(0).squaredNorm(), rest.Tangent(0).dot(rest.Tangent(1)),
    rest.Tangent(0).dot(rest.Tangent(1)), rest.Tangent(1).squaredNorm();
  const double energy = (metric.inverse() * (turns.transpose() * turns)).trace();
  return std::isfinite(energy) ? std::max(energy, 0.0) : 0.0;
}
}

ShapeDistances::Patch ShapeDistances::Fit(
  const Neighborhood& neighborhood, const Eigen::Vector3d& normal) const
{
  Patch patch;
  patch.Rest.setZero();
  if (normal.isZero(0.0) || !FitAxes(neighborhood, normal, patch.Axes))
  {
    return patch;
  }
  Eigen::Matrix<double, 5, 5> matrix = Eigen::Matrix<double, 5, 5>::Zero();
  Eigen::Matrix<double, 5, 3> rightHandSide = Eigen::Matrix<double, 5, 3>::Zero();
  for (int k = 0; k < neighborhood.Size(); ++k)
  {
    const Vector5 monomials = Monomials(patch.Axes, neighborhood.Offset(k));
    matrix += monomials.lazyProduct(monomials.transpose());
    rightHandSide += monomials.lazyProduct(neighborhood.Offset(k).transpose());
  }
  // A mixed derivative counts twice: the sums do not depend on the axes.
  Vector5 ridge;
  ridge << LinearRidge, LinearRidge, QuadraticRidge, 2.0 * QuadraticRidge, QuadraticRidge;
  matrix.diagonal() += neighborhood.Size() * ridge;
  patch.Inverse = matrix.ldlt().solve(Eigen::Matrix<double, 5, 5>::Identity());
  patch.Rest = (patch.Inverse * rightHandSide).transpose();
  return patch;
}

ShapeDistances::ShapeDistances(const TriangleMesh& mesh, std::shared_ptr<const Points> reference,
  const ExecutionContext& context, std::shared_ptr<const DistributedRows> pieces)
  : Reference(std::move(reference))
  , Pieces(std::move(pieces))
  , VertexAreas(BarycentricAreas(mesh, TriangleAreas(mesh, *this->Reference, context)))
  , Patches(mesh.NumberOfVertices())
  , Begin(mesh.NumberOfVertices() + 1, 0)
{
  const Points normals = VertexNormals(mesh, *this->Reference, context);
  std::map<int, std::vector<int>> idsOfRanges; // by their first vertices
  std::mutex access;
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      std::vector<int> ids;
      Neighborhood neighborhood(mesh, *this->Reference);
      for (int v = begin; v < end; ++v)
      {
        if (mesh.IsUsed(v))
        {
          neighborhood.CollectBall(v);
          this->Patches[v] = this->Fit(neighborhood, normals.row(v).transpose());
          for (int k = 0; k < neighborhood.Size(); ++k)
          {
            ids.push_back(neighborhood.Vertex(k));
          }
          this->Begin[v + 1] = neighborhood.Size();
        }
        else
        {
          this->Patches[v].Rest.setZero();
        }
      }
      const std::lock_guard<std::mutex> guard(access);
      idsOfRanges[begin] = std::move(ids);
    });
  std::partial_sum(this->Begin.begin(), this->Begin.end(), this->Begin.begin());
  this->Ids.reserve(this->Begin.back());
  for (const auto& [begin, ids] : idsOfRanges)
  {
    this->Ids.insert(this->Ids.end(), ids.begin(), ids.end());
  }
}

std::vector<int> ShapeDistances::LooksAt(
  const TriangleMesh& mesh, const Points& reference, int vertex)
{
  Neighborhood neighborhood(mesh, reference);
  neighborhood.CollectBall(vertex);
  std::vector<int> ids(neighborhood.Size());
  for (int k = 0; k < neighborhood.Size(); ++k)
  {
    ids[k] = neighborhood.Vertex(k);
  }
  return ids;
}

/// The coefficients of the same least-squares fit for other positions.
Eigen::Matrix<double, 3, 5> ShapeDistances::FitPoints(
  const Patch& patch, int v, const Points& points) const
{
  const Points& reference = *this->Reference;
  Eigen::Matrix<double, 3, 5> sum = Eigen::Matrix<double, 3, 5>::Zero();
  for (int k = this->Begin[v]; k < this->Begin[v + 1]; ++k)
  {
    const int w = this->Ids[k];
    const Vector5 monomials =
      Monomials(patch.Axes, (reference.row(w) - reference.row(v)).transpose());
    const Eigen::Vector3d offset = (points.row(w) - points.row(v)).transpose();
    sum += offset.lazyProduct(monomials.transpose());
  }
  return sum.lazyProduct(patch.Inverse);
}

ShapeDistance ShapeDistances::Measure(const Points& current, const ExecutionContext& context) const
{
  ShapeDistance distance;
  distance.Density = Eigen::VectorXd::Zero(current.rows());
  context.For(static_cast<int>(current.rows()),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        const Patch& patch = this->Patches[v];
        if (!patch.Rest.isZero(0.0))
        {
          const Eigen::Matrix<double, 3, 5> now = this->FitPoints(patch, v, current);
          distance.Density[v] = RotationEnergy({ patch.Rest }, { now });
        }
      }
    });
  if (!this->Pieces)
  {
    distance.Total = distance.Density.dot(this->VertexAreas);
    return distance;
  }
  this->Pieces->UpdateGhosts(distance.Density);
  Eigen::VectorXd total = Eigen::VectorXd::Zero(1);
  for (int v = 0; v < static_cast<int>(distance.Density.size()); ++v)
  {
    total[0] += this->Pieces->IsOwned(v) ? distance.Density[v] * this->VertexAreas[v] : 0.0;
  }
  this->Pieces->Sum(total);
  distance.Total = total[0];
  return distance;
}

ShapeDistance MeasureShapeDistance(const TriangleMesh& mesh, const Points& reference,
  const Points& current, const ExecutionContext& context)
{
  return ShapeDistances(mesh, std::make_shared<Points>(reference), context)
    .Measure(current, context);
}

ShapeDistance ShapeDistanceOfRotations(const TriangleMesh& mesh, const Points& reference,
  const Matrices& rotations, const ExecutionContext& context)
{
  const Triangles& triangles = mesh.GetTriangles();
  const Eigen::VectorXd vertexAreas =
    BarycentricAreas(mesh, TriangleAreas(mesh, reference, context));
  ShapeDistance distance;
  distance.Density = Eigen::VectorXd::Zero(mesh.NumberOfVertices());
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Eigen::Vector3d cotangents = Cotangents(reference.row(triangles(t, 0)).transpose(),
      reference.row(triangles(t, 1)).transpose(), reference.row(triangles(t, 2)).transpose());
    double energy = 0.0;
    for (int corner = 0; corner < 3; ++corner)
    {
      const int next = triangles(t, (corner + 1) % 3);
      const int last = triangles(t, (corner + 2) % 3);
      energy +=
        0.25 * cotangents[corner] * (rotations.row(next) - rotations.row(last)).squaredNorm();
    }
    // A sum of squares, which rounding must not make negative.
    energy = std::max(energy, 0.0);
    distance.Total += energy;
    for (int corner = 0; corner < 3; ++corner)
    {
      distance.Density[triangles(t, corner)] += energy / 3.0;
    }
  }
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    distance.Density[v] = vertexAreas[v] > 0.0 ? distance.Density[v] / vertexAreas[v] : 0.0;
  }
  return distance;
}
}
