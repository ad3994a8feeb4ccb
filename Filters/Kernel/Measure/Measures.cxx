// SPDX-License-Identifier: BSD-3-Clause
#include "Measure/Measures.h"

#include "Algebra/Rotation.h"
#include "Differential/Laplacian.h"
#include "Mesh/Geometry.h"
#include "Mesh/TriangleShape.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace cartan
{
namespace
{
constexpr double Undefined = std::numeric_limits<double>::quiet_NaN();

Eigen::Vector3d Corner(const TriangleMesh& mesh, const Points& points, int t, int corner)
{
  return points.row(mesh.GetTriangles()(t, corner)).transpose();
}

int TriangleComponent(const TriangleMesh& mesh, int t)
{
  return mesh.Component(mesh.GetTriangles()(t, 0));
}

/// The mean of each component's vertices: #components x 3.
Points ComponentCenters(const TriangleMesh& mesh, const Points& points)
{
  Points centers = Points::Zero(mesh.NumberOfComponents(), 3);
  std::vector<int> counts(mesh.NumberOfComponents(), 0);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v))
    {
      centers.row(mesh.Component(v)) += points.row(v);
      ++counts[mesh.Component(v)];
    }
  }
  for (int component = 0; component < mesh.NumberOfComponents(); ++component)
  {
    centers.row(component) /= counts[component];
  }
  return centers;
}

/// The volume of the tetrahedron between a triangle and the origin.
double TetrahedronVolume(
  const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
{
  return a.dot(b.cross(c)) / 6.0;
}

Eigen::Vector3d AreaVector(
  const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
{
  return 0.5 * (b - a).cross(c - a);
}
}

std::vector<ComponentVolume> MeasureComponents(const TriangleMesh& mesh, const Points& points)
{
  const Points centers = ComponentCenters(mesh, points);
  std::vector<ComponentVolume> components(mesh.NumberOfComponents());
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsBoundary(v))
    {
      components[mesh.Component(v)].IsClosed = false;
    }
  }
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const int component = TriangleComponent(mesh, t);
    const Eigen::Vector3d center = centers.row(component).transpose();
    const Eigen::Vector3d a = Corner(mesh, points, t, 0) - center;
    const Eigen::Vector3d b = Corner(mesh, points, t, 1) - center;
    const Eigen::Vector3d c = Corner(mesh, points, t, 2) - center;
    components[component].Volume += TetrahedronVolume(a, b, c);
    components[component].Area += AreaVector(a, b, c).norm();
  }
  return components;
}

Eigen::VectorXd TriangleAreas(
  const TriangleMesh& mesh, const Points& points, const ExecutionContext& context)
{
  return 0.5 * TriangleAreaVectors(points, mesh.GetTriangles(), context).rowwise().norm();
}

Eigen::VectorXd BarycentricAreas(const TriangleMesh& mesh, const Eigen::VectorXd& triangleAreas)
{
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(mesh.NumberOfVertices());
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    for (int corner = 0; corner < 3; ++corner)
    {
      areas[mesh.GetTriangles()(t, corner)] += triangleAreas[t] / 3.0;
    }
  }
  return areas;
}

Eigen::VectorXd Ratios(const Eigen::VectorXd& reference, const Eigen::VectorXd& current)
{
  Eigen::VectorXd ratios(reference.size());
  for (Eigen::Index i = 0; i < reference.size(); ++i)
  {
    if (reference[i] > 0.0)
    {
      ratios[i] = current[i] / reference[i];
    }
    else
    {
      ratios[i] = reference[i] == 0.0 && current[i] == 0.0 ? 1.0 : Undefined;
    }
  }
  return ratios;
}

EdgeLengthChange CompareEdgeLengths(const TriangleMesh& mesh, const Points& reference,
  const Points& current, const ExecutionContext& context)
{
  EdgeLengthChange change;
  change.VertexRatio = Eigen::VectorXd::Ones(mesh.NumberOfVertices());
  Eigen::VectorXd ratios(mesh.NumberOfDirectedEdges());
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        double sum = 0.0;
        int count = 0;
        for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
        {
          const int w = mesh.Neighbor(d);
          const double before = (reference.row(w) - reference.row(v)).norm();
          const double after = (current.row(w) - current.row(v)).norm();
          ratios[d] = before > 0.0 ? after / before : Undefined;
          if (before > 0.0)
          {
            sum += ratios[d];
            ++count;
          }
        }
        if (mesh.IsUsed(v))
        {
          change.VertexRatio[v] = count > 0 ? sum / count : Undefined;
        }
      }
    });
  double squares = 0.0;
  int count = 0;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      if (v > mesh.Neighbor(d))
      {
        continue;
      }
      if (std::isnan(ratios[d]))
      {
        change.ZeroLength.Add(v);
        continue;
      }
      const double relative = ratios[d] - 1.0;
      squares += relative * relative;
      change.Maximum = std::max(change.Maximum, std::abs(relative));
      ++count;
    }
  }
  change.RootMeanSquare = count > 0 ? std::sqrt(squares / count) : 0.0;
  return change;
}

Matrices FitRotations(const TriangleMesh& mesh, const Points& reference, const Points& current,
  const ExecutionContext& context, const Eigen::VectorXd& edgeWeights)
{
  const Points referenceNormals = VertexNormals(mesh, reference, context);
  const Points currentNormals = VertexNormals(mesh, current, context);
  Matrices rotations(mesh.NumberOfVertices(), 9);
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
        double size = 0.0;
        for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
        {
          const int w = mesh.Neighbor(d);
          const Eigen::RowVector3d before = reference.row(w) - reference.row(v);
          const Eigen::RowVector3d after = current.row(w) - current.row(v);
          const double weight = edgeWeights.size() ? edgeWeights[d] : 1.0;
          covariance += weight * after.transpose() * before;
          size += weight * before.norm() * after.norm();
        }
        // The edges of a flat ring, or of one whose edges are all but in line,
        // leave the rotation to rounding; the normal settles it.
        covariance += size * currentNormals.row(v).transpose() * referenceNormals.row(v);
        MatrixAt(rotations, v) = size > 0.0 ? ProjectOnRotations(covariance / size)
                                            : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
      }
    });
  return rotations;
}

LocalVolumes::LocalVolumes(
  const TriangleMesh& mesh, const Points& reference, const ExecutionContext& context)
  : Mesh(mesh)
  , Positions(reference)
  , EdgeWeight(EdgeWeights(mesh, reference, LaplacianWeights::Cotangent, context))
  , Stiffness(MixedVoronoiAreas(mesh, reference, context))
  , Centers(reference)
{
  const std::vector<ComponentVolume> components = MeasureComponents(mesh, reference);
  std::vector<double> smoothing;
  for (const ComponentVolume& component : components)
  {
    // Below this part of its area a volume is rounding, as that of a sheet
    // with two sides.
    const bool enclosesVolume = component.IsClosed &&
      std::abs(component.Volume) > 1e-12 * component.Area * std::sqrt(component.Area);
    const double length = enclosesVolume ? 6.0 * component.Volume / component.Area : 1.0;
    this->EnclosesVolume.push_back(enclosesVolume);
    smoothing.push_back(length * length);
  }
  std::vector<char> isFixed(mesh.NumberOfVertices(), 1);
  bool isAnyFree = false;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v))
    {
      this->Stiffness[v] /= smoothing[mesh.Component(v)];
      isFixed[v] = !this->EnclosesVolume[mesh.Component(v)];
      isAnyFree = isAnyFree || !isFixed[v];
    }
  }
  if (isAnyFree)
  {
    this->Solver.Factorize(
      Laplacian(mesh, this->EdgeWeight), isFixed, this->Stiffness, {}, context);
    Field centers = reference;
    this->Solver.Solve(Field(this->Stiffness.asDiagonal() * reference), centers);
    this->Centers = centers;
  }
  this->Reference = this->Sum(reference, this->Centers);
  context.Report(1.0);
}

Eigen::VectorXd LocalVolumes::Measure(const Points& current, const ExecutionContext& context) const
{
  Field centers = current;
  if (!this->Solver.GetFree().empty())
  {
    const Matrices rotations = FitRotations(this->Mesh, this->Positions, current, context);
    Field rightHandSide(current.rows(), 3);
    context.For(this->Mesh.NumberOfVertices(),
      [&](int begin, int end)
      {
        for (int v = begin; v < end; ++v)
        {
          const Eigen::Vector3d offset =
            (this->Positions.row(v) - this->Centers.row(v)).transpose();
          Eigen::Vector3d sum =
            this->Stiffness[v] * (current.row(v).transpose() - MatrixAt(rotations, v) * offset);
          for (int d = this->Mesh.RingBegin(v); d < this->Mesh.RingEnd(v); ++d)
          {
            const int w = this->Mesh.Neighbor(d);
            const Eigen::Vector3d difference =
              (this->Centers.row(v) - this->Centers.row(w)).transpose();
            sum += 0.5 * this->EdgeWeight[d] *
              (MatrixAt(rotations, v) * difference + MatrixAt(rotations, w) * difference);
          }
          rightHandSide.row(v) = sum.transpose();
        }
      });
    this->Solver.Solve(rightHandSide, centers);
  }
  context.Report(1.0);
  return this->Sum(current, centers);
}

Eigen::VectorXd LocalVolumes::Sum(const Points& points, const Points& centers) const
{
  std::vector<double> rest(this->Mesh.NumberOfComponents(), 0.0);
  const std::vector<ComponentVolume> inner = MeasureComponents(this->Mesh, centers);
  const std::vector<ComponentVolume> outer = MeasureComponents(this->Mesh, points);
  for (std::size_t component = 0; component < rest.size(); ++component)
  {
    if (outer[component].Area > 0.0)
    {
      rest[component] = inner[component].Volume / outer[component].Area;
    }
  }
  Eigen::VectorXd volumes = Eigen::VectorXd::Zero(this->Mesh.NumberOfVertices());
  for (int t = 0; t < this->Mesh.NumberOfTriangles(); ++t)
  {
    Eigen::Vector3d p[3];
    Eigen::Vector3d c[3];
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();
    for (int corner = 0; corner < 3; ++corner)
    {
      p[corner] = Corner(this->Mesh, points, t, corner);
      c[corner] = Corner(this->Mesh, centers, t, corner);
      offset += (p[corner] - c[corner]) / 3.0;
    }
    const Eigen::Vector3d top = AreaVector(p[0], p[1], p[2]);
    const Eigen::Vector3d bottom = AreaVector(c[0], c[1], c[2]);
    // Four times the area vector half-way.
    const Eigen::Vector3d middle = AreaVector(p[0] + c[0], p[1] + c[1], p[2] + c[2]);
    const double volume = (top + middle + bottom).dot(offset) / 6.0 +
      rest[TriangleComponent(this->Mesh, t)] * top.norm();
    for (int corner = 0; corner < 3; ++corner)
    {
      volumes[this->Mesh.GetTriangles()(t, corner)] += volume / 3.0;
    }
  }
  for (int v = 0; v < this->Mesh.NumberOfVertices(); ++v)
  {
    if (this->Mesh.IsUsed(v) && !this->EnclosesVolume[this->Mesh.Component(v)])
    {
      volumes[v] = Undefined;
    }
  }
  return volumes;
}

ShapeDistance MeasureShapeDistance(const TriangleMesh& mesh, const Points& reference,
  const Points& current, const ExecutionContext& context)
{
  return ShapeDistanceOfRotations(
    mesh, reference, FitRotations(mesh, reference, current, context), context);
}

ShapeDistance ShapeDistanceOfRotations(const TriangleMesh& mesh, const Points& reference,
  const Matrices& rotations, const ExecutionContext& context)
{
  const Eigen::VectorXd areas = TriangleAreas(mesh, reference, context);
  const Eigen::VectorXd vertexAreas = BarycentricAreas(mesh, areas);
  ShapeDistance distance;
  distance.Density = Eigen::VectorXd::Zero(mesh.NumberOfVertices());
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Eigen::Vector3d cotangents = Cotangents(
      Corner(mesh, reference, t, 0), Corner(mesh, reference, t, 1), Corner(mesh, reference, t, 2));
    double energy = 0.0;
    for (int corner = 0; corner < 3; ++corner)
    {
      const int next = mesh.GetTriangles()(t, (corner + 1) % 3);
      const int last = mesh.GetTriangles()(t, (corner + 2) % 3);
      energy +=
        0.25 * cotangents[corner] * (rotations.row(next) - rotations.row(last)).squaredNorm();
    }
    // A sum of squares, which rounding must not make negative.
    energy = std::max(energy, 0.0);
    distance.Total += energy;
    for (int corner = 0; corner < 3; ++corner)
    {
      distance.Density[mesh.GetTriangles()(t, corner)] += energy / 3.0;
    }
  }
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    distance.Density[v] = vertexAreas[v] > 0.0 ? distance.Density[v] / vertexAreas[v] : 0.0;
  }
  return distance;
}
}
