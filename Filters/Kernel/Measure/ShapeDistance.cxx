// SPDX-License-Identifier: BSD-3-Clause
#include "Measure/ShapeDistance.h"

#include "Algebra/Rotation.h"
#include "Differential/SurfaceFit.h"
#include "Measure/Areas.h"
#include "Mesh/Geometry.h"
#include "Mesh/TriangleShape.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
/// Relative to the number of points, in coordinates of unit variance: too little
/// to be seen where the points determine the fit, and enough for linear terms to
/// come before quadratic ones where they do not (few points, or all in two rows).
constexpr double LinearRidge = 1e-10;
constexpr double QuadraticRidge = 1e-6;

/// x(s, t) = x(0) + X1 s + X2 t + X11 s^2 / 2 + X12 s t + X22 t^2 / 2
struct QuadraticPatch
{
  Eigen::Matrix<double, 3, 5> Coefficients; // X1, X2, X11, X12, X22

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

/// Fits patches to both surfaces around v over the same coordinates (s, t), which
/// are along uncorrelated axes of the reference's tangent plane and have unit
/// variance. False if the points coincide.
bool FitPatches(const Points& current, int v, const Neighborhood& neighborhood,
  const Eigen::Vector3d& normal, QuadraticPatch& rest, QuadraticPatch& deformed)
{
  Eigen::Matrix<double, 3, 2> axes;
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

  using Vector5 = Eigen::Matrix<double, 5, 1>;
  Eigen::Matrix<double, 5, 5> matrix = Eigen::Matrix<double, 5, 5>::Zero();
  Eigen::Matrix<double, 5, 6> rightHandSide = Eigen::Matrix<double, 5, 6>::Zero();
  for (int k = 0; k < neighborhood.Size(); ++k)
  {
    const Eigen::RowVector3d before = neighborhood.Offset(k);
    const Eigen::RowVector3d after = current.row(neighborhood.Vertex(k)) - current.row(v);
    const double s = before.dot(axes.col(0));
    const double t = before.dot(axes.col(1));
    Vector5 monomials;
    monomials << s, t, 0.5 * s * s, s * t, 0.5 * t * t;
    matrix.selfadjointView<Eigen::Lower>().rankUpdate(monomials);
    rightHandSide.leftCols<3>() += monomials * before;
    rightHandSide.rightCols<3>() += monomials * after;
  }
  // A mixed derivative counts twice: the sums do not depend on the axes.
  Vector5 ridge;
  ridge << LinearRidge, LinearRidge, QuadraticRidge, 2.0 * QuadraticRidge, QuadraticRidge;
  matrix.diagonal() += neighborhood.Size() * ridge;
  const Eigen::Matrix<double, 5, 6> fit = matrix.ldlt().solve(rightHandSide);
  rest.Coefficients = fit.leftCols<3>().transpose();
  deformed.Coefficients = fit.rightCols<3>().transpose();
  return true;
}

/// |grad R|_F^2 / 2 of the map from one patch to the other.
double RotationEnergy(const QuadraticPatch& rest, const QuadraticPatch& deformed)
{
  if (!rest.IsRegular() || !deformed.IsRegular())
  {
    return 0.0;
  }
  // F T = T' and its derivative F' T = dT' - F dT
  const Eigen::Matrix3d inverse = rest.Frame().inverse();
  const Eigen::Matrix3d map = deformed.Frame() * inverse;
  const Eigen::Matrix3d rotation = ProjectOnRotations(map);
  const Eigen::Matrix3d stretch = rotation.transpose() * map;
  const Eigen::Matrix3d inertia =
    stretch.trace() * Eigen::Matrix3d::Identity() - 0.5 * (stretch + stretch.transpose());
  Eigen::Matrix<double, 3, 2> turns;
  for (int i = 0; i < 2; ++i)
  {
    const Eigen::Matrix3d change = rotation.transpose() *
      (deformed.FrameDerivative(i) - map * rest.FrameDerivative(i)) * inverse;
    const Eigen::Vector3d axial(
      change(2, 1) - change(1, 2), change(0, 2) - change(2, 0), change(1, 0) - change(0, 1));
    turns.col(i) = inertia.ldlt().solve(axial);
  }
  // sum of g^ij omega_i . omega_j, g the first fundamental form of the reference
  Eigen::Matrix2d metric;
  metric << rest.Tangent(0).squaredNorm(), rest.Tangent(0).dot(rest.Tangent(1)),
    rest.Tangent(0).dot(rest.Tangent(1)), rest.Tangent(1).squaredNorm();
  const double energy = (metric.inverse() * (turns.transpose() * turns)).trace();
  return std::isfinite(energy) ? std::max(energy, 0.0) : 0.0;
}
}

ShapeDistance MeasureShapeDistance(const TriangleMesh& mesh, const Points& reference,
  const Points& current, const ExecutionContext& context)
{
  const Points normals = VertexNormals(mesh, reference, context);
  ShapeDistance distance;
  distance.Density = Eigen::VectorXd::Zero(mesh.NumberOfVertices());
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      Neighborhood neighborhood(mesh, reference);
      QuadraticPatch rest;
      QuadraticPatch deformed;
      for (int v = begin; v < end; ++v)
      {
        if (!mesh.IsUsed(v) || normals.row(v).isZero(0.0))
        {
          continue;
        }
        neighborhood.CollectBall(v);
        if (FitPatches(current, v, neighborhood, normals.row(v).transpose(), rest, deformed))
        {
          distance.Density[v] = RotationEnergy(rest, deformed);
        }
      }
    });
  distance.Total =
    distance.Density.dot(BarycentricAreas(mesh, TriangleAreas(mesh, reference, context)));
  return distance;
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
