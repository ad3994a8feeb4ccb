// SPDX-License-Identifier: BSD-3-Clause
#include "Measure/VolumePreservation.h"

#include "Algebra/ConstrainedSolver.h"
#include "Base/Constants.h"
#include "Differential/Curvature.h"
#include "Differential/Laplacian.h"
#include "Measure/Measures.h"
#include "Mesh/Geometry.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cartan
{
namespace
{
constexpr int RaysAround = 6;

/// The mean length of the rays from a vertex that leave the body; negative if
/// none does. A ray that meets a triangle from outside was never inside.
double MeanDepth(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
  const Points& areaVectors, double offset, const RayCaster& castRay)
{
  const double halfAngle = 15.0 * Pi / 180.0;
  const Eigen::Vector3d side = normal.unitOrthogonal();
  const Eigen::Vector3d other = normal.cross(side);
  double sum = 0.0;
  int count = 0;
  for (int ray = 0; ray <= RaysAround; ++ray)
  {
    Eigen::Vector3d direction = -normal;
    if (ray > 0)
    {
      const double turn = FullTurn * ray / RaysAround;
      direction = -std::cos(halfAngle) * normal +
        std::sin(halfAngle) * (std::cos(turn) * side + std::sin(turn) * other);
    }
    // The start is moved off the vertex's own triangles.
    const RayHit hit = castRay(point + offset * direction, direction);
    if (hit.Distance >= 0.0 && areaVectors.row(hit.Triangle).dot(direction) > 0.0)
    {
      sum += hit.Distance + offset;
      ++count;
    }
  }
  return count ? sum / count : -1.0;
}

/// Depths at unmeasured vertices, harmonic between measured ones.
void FillDepths(const TriangleMesh& mesh, const SparseMatrix& laplacian, VolumeModel& model)
{
  std::vector<char> isFixed(mesh.NumberOfVertices(), 1);
  bool isAnyFree = false;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v) && model.EnclosesVolume[mesh.Component(v)] && !model.IsMeasured[v])
    {
      isFixed[v] = 0;
      isAnyFree = true;
    }
  }
  if (!isAnyFree)
  {
    return;
  }
  ConstrainedSolver solver;
  solver.Factorize(laplacian, isFixed);
  Field depth = model.LocalDepth;
  solver.Solve(Field::Zero(depth.rows(), 1), depth);
  model.LocalDepth = depth.col(0);
}

/// The middles of the body, smoothed where their neighbors belong together.
Points SmoothedCenters(const TriangleMesh& mesh, const Points& points,
  const SparseMatrix& laplacian, const Points& centers, const VolumeModel& model)
{
  std::vector<std::vector<double>> depths(mesh.NumberOfComponents());
  std::vector<char> isFixed(mesh.NumberOfVertices(), 1);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v) && model.EnclosesVolume[mesh.Component(v)])
    {
      isFixed[v] = 0;
      depths[mesh.Component(v)].push_back(model.LocalDepth[v]);
    }
  }
  // A step for each component, so that none depends on what others are there.
  std::vector<double> steps;
  for (std::vector<double>& some : depths)
  {
    const auto middle = some.begin() + some.size() / 2;
    std::nth_element(some.begin(), middle, some.end());
    steps.push_back(some.empty() ? 1.0 : 0.02 * *middle * *middle);
  }
  Eigen::VectorXd stiffness = MixedVoronoiAreas(mesh, points);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    stiffness[v] /= mesh.IsUsed(v) ? steps[mesh.Component(v)] : 1.0;
  }
  ConstrainedSolver solver;
  solver.Factorize(laplacian, isFixed, stiffness);
  Field smoothed = centers;
  solver.Solve(stiffness.asDiagonal() * centers, smoothed);
  return smoothed;
}

/// Decides which components take part and says why others do not.
void FindEnclosingComponents(const TriangleMesh& mesh, const Points& points, VolumeModel& model)
{
  IdSample open;
  IdSample inverted;
  for (const ComponentVolume& component : MeasureComponents(mesh, points))
  {
    const auto id = static_cast<long long>(model.Volumes.size());
    model.Volumes.push_back(component.Volume);
    model.EnclosesVolume.push_back(component.IsClosed && component.Volume > 0.0);
    if (!component.IsClosed)
    {
      open.Add(id);
    }
    else if (!(component.Volume > 0.0))
    {
      inverted.Add(id);
    }
  }
  if (!open.IsEmpty())
  {
    model.Warning = "No volume is preserved in " +
      open.Describe("open component", "open components") + ": close the surface (Fill Holes).";
  }
  if (!inverted.IsEmpty())
  {
    model.Warning += (model.Warning.empty() ? "" : " ");
    model.Warning += "No volume is preserved in " + inverted.Describe("component", "components") +
      " that are oriented inside out: flip the triangles (Surface Normals, Flip Normals).";
  }
}
}

VolumeModel MeasureVolumeModel(const TriangleMesh& mesh, const Points& points,
  const RayCaster& castRay, const ExecutionContext& context)
{
  VolumeModel model;
  FindEnclosingComponents(mesh, points, model);
  if (std::none_of(
        model.EnclosesVolume.begin(), model.EnclosesVolume.end(), [](char e) { return e; }))
  {
    return model;
  }
  const int numberOfVertices = mesh.NumberOfVertices();
  const Points normals = VertexNormals(mesh, points, context);
  const Points areaVectors = TriangleAreaVectors(points, mesh.GetTriangles(), context);
  model.LocalDepth = Eigen::VectorXd::Zero(numberOfVertices);
  model.IsMeasured.assign(numberOfVertices, 0);
  // Far above rounding, far below any thickness worth preserving.
  const double offset = 1e-7 * BoundingDiagonal(points);
  // In parts, so that progress moves and an abort is noticed.
  constexpr int parts = 20;
  for (int part = 0; part < parts; ++part)
  {
    const int first = static_cast<int>(static_cast<long long>(numberOfVertices) * part / parts);
    const int last =
      static_cast<int>(static_cast<long long>(numberOfVertices) * (part + 1) / parts);
    context.For(last - first,
      [&](int begin, int end)
      {
        for (int v = first + begin; v < first + end; ++v)
        {
          if (!mesh.IsUsed(v) || !model.EnclosesVolume[mesh.Component(v)] ||
            normals.row(v).isZero(0.0))
          {
            continue;
          }
          const double depth = MeanDepth(
            points.row(v).transpose(), normals.row(v).transpose(), areaVectors, offset, castRay);
          model.IsMeasured[v] = depth >= 0.0;
          model.LocalDepth[v] = std::max(depth, 0.0);
        }
      });
    context.Report(0.8 * (part + 1) / parts);
  }
  // A component none of whose rays hit has no depth to fill in from.
  std::vector<char> isAnyMeasured(mesh.NumberOfComponents(), 0);
  for (int v = 0; v < numberOfVertices; ++v)
  {
    if (model.IsMeasured[v])
    {
      isAnyMeasured[mesh.Component(v)] = 1;
    }
  }
  IdSample unmeasured;
  for (int c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    if (model.EnclosesVolume[c] && !isAnyMeasured[c])
    {
      unmeasured.Add(c);
      model.EnclosesVolume[c] = 0;
    }
  }
  if (!unmeasured.IsEmpty())
  {
    model.Warning += (model.Warning.empty() ? "" : " ");
    model.Warning += "No volume is preserved in " + unmeasured.Describe("component", "components") +
      " whose inside no ray has found: the surface is folded flat, or crosses itself.";
  }
  if (std::none_of(
        model.EnclosesVolume.begin(), model.EnclosesVolume.end(), [](char e) { return e; }))
  {
    model.LocalDepth.resize(0);
    return model;
  }
  const SparseMatrix laplacian =
    Laplacian(mesh, EdgeWeights(mesh, points, LaplacianWeights::Cotangent, context));
  FillDepths(mesh, laplacian, model);

  Points centers = points;
  for (int v = 0; v < numberOfVertices; ++v)
  {
    centers.row(v) -= 0.5 * model.LocalDepth[v] * normals.row(v);
  }
  model.Offsets = points - SmoothedCenters(mesh, points, laplacian, centers, model);
  for (int v = 0; v < numberOfVertices; ++v)
  {
    if (!mesh.IsUsed(v) || !model.EnclosesVolume[mesh.Component(v)])
    {
      model.Offsets.row(v).setZero();
    }
  }

  const Curvatures curvatures = CurvaturesFromNormals(mesh, points, normals, context);
  model.ColumnHeight.resize(numberOfVertices);
  for (int v = 0; v < numberOfVertices; ++v)
  {
    const double k1 = curvatures.Maximum[v];
    const double k2 = curvatures.Minimum[v];
    model.ColumnHeight[v] = ColumnHeight(ColumnDepth(model.LocalDepth[v], k1, k2), k1, k2);
  }
  context.Report(1.0);
  return model;
}

double ColumnDepth(double localDepth, double k1, double k2)
{
  double depth = 0.5 * localDepth;
  for (const double k : { k1, k2 })
  {
    if (k > 0.0)
    {
      depth = std::min(depth, 0.5 / k);
    }
  }
  return depth;
}

double ColumnHeight(double phi, double k1, double k2)
{
  return phi * (1.0 + phi * (-0.5 * (k1 + k2) + phi * k1 * k2 / 3.0));
}

Points VolumeGradient(const TriangleMesh& mesh, const Points& points)
{
  // Of sum a . (b x c) / 6; on a closed surface its derivative by a vertex is a
  // sixth of the sum of the adjacent triangles' doubled area vectors.
  const Points areaVectors = TriangleAreaVectors(points, mesh.GetTriangles());
  Points gradient = Points::Zero(points.rows(), 3);
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    for (int corner = 0; corner < 3; ++corner)
    {
      gradient.row(mesh.GetTriangles()(t, corner)) += areaVectors.row(t) / 6.0;
    }
  }
  return gradient;
}

std::vector<double> VolumeClosingSteps(const TriangleMesh& mesh, const Points& points,
  const Points& direction, const std::vector<char>& takesPart, const std::vector<double>& volumes)
{
  // A vertex of each component as its origin, which keeps the digits of one that
  // has gone far.
  std::vector<Eigen::Vector3d> origins(mesh.NumberOfComponents(), Eigen::Vector3d::Zero());
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v))
    {
      origins[mesh.Component(v)] = points.row(v).transpose();
    }
  }
  // Volume(x + q u) = c0 + c1 q + c2 q^2 + c3 q^3, per component.
  std::vector<std::array<double, 4>> cubics(mesh.NumberOfComponents(), { 0.0, 0.0, 0.0, 0.0 });
  for (int t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const int component = mesh.Component(mesh.GetTriangles()(t, 0));
    Eigen::Matrix3d x;
    Eigen::Matrix3d u;
    for (int corner = 0; corner < 3; ++corner)
    {
      x.col(corner) = points.row(mesh.GetTriangles()(t, corner)).transpose() - origins[component];
      u.col(corner) = direction.row(mesh.GetTriangles()(t, corner)).transpose();
    }
    auto& cubic = cubics[component];
    const auto determinant = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                               const Eigen::Vector3d& c) { return a.dot(b.cross(c)) / 6.0; };
    cubic[0] += determinant(x.col(0), x.col(1), x.col(2));
    cubic[3] += determinant(u.col(0), u.col(1), u.col(2));
    for (int corner = 0; corner < 3; ++corner)
    {
      const int next = (corner + 1) % 3;
      const int last = (corner + 2) % 3;
      cubic[1] += determinant(u.col(corner), x.col(next), x.col(last));
      cubic[2] += determinant(x.col(corner), u.col(next), u.col(last));
    }
  }
  std::vector<double> steps(mesh.NumberOfComponents(), 0.0);
  for (int c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    const auto& cubic = cubics[c];
    if (!takesPart[c] || cubic[1] == 0.0)
    {
      continue;
    }
    double q = 0.0;
    // Newton from 0 finds the nearest root as long as the volume grows with q,
    // which the gradient direction makes sure of near 0.
    for (int round = 0; round < 50; ++round)
    {
      const double error = cubic[0] + q * (cubic[1] + q * (cubic[2] + q * cubic[3])) - volumes[c];
      const double slope = cubic[1] + q * (2.0 * cubic[2] + q * 3.0 * cubic[3]);
      if (std::abs(error) <= 1e-15 * std::abs(volumes[c]) || slope == 0.0)
      {
        break;
      }
      q -= error / slope;
    }
    const double remaining =
      std::abs(cubic[0] + q * (cubic[1] + q * (cubic[2] + q * cubic[3])) - volumes[c]);
    steps[c] = remaining <= 1e-9 * std::abs(volumes[c]) ? q : 0.0;
  }
  return steps;
}
}
