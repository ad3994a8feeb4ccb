// SPDX-License-Identifier: BSD-3-Clause
#include "Measure/VolumeModel.h"

#include "Algebra/AnchoredSystem.h"
#include "Base/Constants.h"
#include "Differential/Curvature.h"
#include "Differential/Laplacian.h"
#include "Measure/ComponentVolumes.h"
#include "Measure/ImplicitSmoothing.h"
#include "Mesh/Geometry.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
/// What the rays around count together, in parts of the one in the middle.
constexpr double WeightAround = 6.0;

/// A ray's direction and how much it counts.
struct Ray
{
  Eigen::Vector3d Direction;
  double Weight;
};

/// One ray against the normal, and around it one tilted towards each neighbor of
/// the vertex, so that the rays go with the surface however it lies and in whatever
/// order its points come. Those around count by the angles between them.
void ConeOfRays(const TriangleMesh& mesh, const Points& points, int vertex,
  const Eigen::Vector3d& normal, std::vector<Ray>& rays)
{
  rays.assign(1, { -normal, 1.0 });
  const double halfAngle = 15.0 * Pi / 180.0;
  const Eigen::Vector3d side = normal.unitOrthogonal();
  const Eigen::Vector3d other = normal.cross(side);
  std::vector<double> turns;
  for (int d = mesh.RingBegin(vertex); d < mesh.RingEnd(vertex); ++d)
  {
    const Eigen::Vector3d edge = (points.row(mesh.Neighbor(d)) - points.row(vertex)).transpose();
    if ((edge - edge.dot(normal) * normal).norm() > 1e-6 * edge.norm())
    {
      turns.push_back(std::atan2(edge.dot(other), edge.dot(side)));
    }
  }
  std::sort(turns.begin(), turns.end());
  for (std::size_t i = 0; i < turns.size(); ++i)
  {
    const double before = i > 0 ? turns[i - 1] : turns.back() - FullTurn;
    const double after = i + 1 < turns.size() ? turns[i + 1] : turns.front() + FullTurn;
    rays.push_back({ -std::cos(halfAngle) * normal +
        std::sin(halfAngle) * (std::cos(turns[i]) * side + std::sin(turns[i]) * other),
      WeightAround * 0.5 * (after - before) / FullTurn });
  }
}

/// How far a ray is tilted to pass beside a place, and by which part its length changes then.
constexpr double Tilt = 1e-5;
constexpr double TiltedPart = 1e-3;

/// Whether a ray that meets a triangle from outside leaves the body in the same place, because
/// another body touches it there: seen from beyond that place, or beside it. The order of what
/// is met in one place is a matter of rounding.
template <typename Leaves>
bool LeavesThere(const Eigen::Vector3d& start, const Eigen::Vector3d& direction, double distance,
  double offset, const RayCaster& castRay, const Leaves& leaves)
{
  const RayHit back = castRay(start + (distance + offset) * direction, -direction);
  if (back.Distance >= 0.0 && back.Distance < 2.0 * offset && leaves(back))
  {
    return true;
  }
  const Eigen::Vector3d tilted = direction + Tilt * direction.unitOrthogonal();
  const RayHit beside = castRay(start, tilted.normalized());
  return std::abs(beside.Distance - distance) < TiltedPart * distance && leaves(beside);
}

/// The mean length of the rays from a vertex that leave the body; negative if
/// none does. A ray that meets a triangle from outside was never inside.
double MeanDepth(const Eigen::Vector3d& point, const std::vector<Ray>& rays,
  const Points& areaVectors, double offset, const RayCaster& castRay)
{
  double sum = 0.0;
  double weight = 0.0;
  for (const Ray& ray : rays)
  {
    // The start is moved off the vertex's own triangles.
    const Eigen::Vector3d start = point + offset * ray.Direction;
    const auto leaves = [&](const RayHit& hit)
    { return areaVectors.row(hit.Triangle).dot(ray.Direction) > 0.0; };
    const RayHit hit = castRay(start, ray.Direction);
    if (hit.Distance >= 0.0 &&
      (leaves(hit) || LeavesThere(start, ray.Direction, hit.Distance, offset, castRay, leaves)))
    {
      sum += ray.Weight * (hit.Distance + offset);
      weight += ray.Weight;
    }
  }
  return weight > 0.0 ? sum / weight : -1.0;
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
  AnchoredSystem system;
  system.Factorize(laplacian, Anchors::Hard(std::move(isFixed)));
  Field depth = model.LocalDepth;
  system.Interpolate(depth);
  model.LocalDepth = depth.col(0);
}

/// The middles of the body, smoothed where their neighbors belong together.
Points SmoothedCenters(const TriangleMesh& mesh, const Points& points,
  const SparseMatrix& laplacian, const Points& centers, const VolumeModel& model)
{
  std::vector<std::vector<double>> depths(mesh.NumberOfComponents());
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v) && model.EnclosesVolume[mesh.Component(v)])
    {
      depths[mesh.Component(v)].push_back(model.LocalDepth[v]);
    }
  }
  // A step for each component, so that none depends on what others are there.
  std::vector<double> steps;
  for (std::vector<double>& some : depths)
  {
    const auto middle = some.begin() + some.size() / 2;
    std::nth_element(some.begin(), middle, some.end());
    steps.push_back(some.empty() ? 0.0 : 0.02 * *middle * *middle);
  }
  AnchoredSystem system;
  system.Factorize(laplacian, SmoothingAnchors(mesh, points, steps));
  Field smoothed = centers;
  system.Interpolate(smoothed);
  return smoothed;
}

void AddSentence(std::string& text, const std::string& sentence)
{
  text += (text.empty() ? "" : " ") + sentence;
}

/// Flipping all triangles helps only where all are the wrong way round.
std::string FlipAdvice(bool isAnyRight)
{
  return isAnyRight ? "flip the triangles of these components alone (Surface Normals with Flip "
                      "Normals on and Splitting off)."
                    : "flip the triangles (Surface Normals with Flip Normals on and Splitting "
                      "off).";
}

/// Decides which components take part and says why others do not.
void FindEnclosingComponents(const TriangleMesh& mesh, const Points& points, VolumeModel& model)
{
  const std::vector<ComponentVolume> components = MeasureComponents(mesh, points);
  const std::vector<int> enclosing = EnclosingComponents(mesh, points, components);
  IdSample open;
  IdSample flat;
  IdSample inverted;
  bool isAnyRight = false;
  for (std::size_t c = 0; c < components.size(); ++c)
  {
    const auto id = static_cast<long long>(c);
    // The wall of a cavity has a negative volume: the outermost component decides.
    // Components that intersect each other may go round in a circle.
    std::size_t outermost = c;
    for (std::size_t step = 0; step < components.size() && enclosing[outermost] >= 0; ++step)
    {
      outermost = static_cast<std::size_t>(enclosing[outermost]);
    }
    const bool isRight = components[c].EnclosesVolume() && components[outermost].Volume > 0.0;
    model.Volumes.push_back(components[c].Volume);
    model.EnclosesVolume.push_back(isRight);
    isAnyRight = isAnyRight || isRight;
    if (!isRight)
    {
      (!components[c].IsClosed ? open : components[c].EnclosesVolume() ? inverted : flat).Add(id);
    }
  }
  if (!open.IsEmpty())
  {
    AddSentence(model.Warning,
      "No volume is preserved in " +
        open.Renamed(model.Names).Describe("open component", "open components") +
        ": close the surface (Prepare Surface, Maximum Hole Edges).");
  }
  if (!flat.IsEmpty())
  {
    AddSentence(model.Warning,
      "No volume is preserved in " + flat.Renamed(model.Names).Describe("component", "components") +
        " that enclose none, as a sheet with two sides.");
  }
  if (!inverted.IsEmpty())
  {
    AddSentence(model.Warning,
      "No volume is preserved in " +
        inverted.Renamed(model.Names).Describe("component", "components") +
        " that are oriented inside out: " + FlipAdvice(isAnyRight));
  }
}

bool IsAnyEnclosing(const VolumeModel& model)
{
  return std::any_of(
    model.EnclosesVolume.begin(), model.EnclosesVolume.end(), [](char e) { return e != 0; });
}

void MeasureDepths(const TriangleMesh& mesh, const Points& points, const Points& normals,
  const RayCaster& castRay, const ExecutionContext& context, VolumeModel& model)
{
  const int numberOfVertices = mesh.NumberOfVertices();
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
        std::vector<Ray> rays;
        for (int v = first + begin; v < first + end; ++v)
        {
          if (!mesh.IsUsed(v) || !model.EnclosesVolume[mesh.Component(v)] ||
            normals.row(v).isZero(0.0))
          {
            continue;
          }
          ConeOfRays(mesh, points, v, normals.row(v).transpose(), rays);
          const double depth =
            MeanDepth(points.row(v).transpose(), rays, areaVectors, offset, castRay);
          model.IsMeasured[v] = depth >= 0.0;
          model.LocalDepth[v] = std::max(depth, 0.0);
        }
      });
    context.Report(0.8 * (part + 1) / parts);
  }
}

/// A component none of whose rays hit has no depth to fill in from.
void LeaveOutUnmeasured(const TriangleMesh& mesh, VolumeModel& model)
{
  std::vector<char> isAnyMeasured(mesh.NumberOfComponents(), 0);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
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
    AddSentence(model.Warning,
      "No volume is preserved in " +
        unmeasured.Renamed(model.Names).Describe("component", "components") +
        " whose inside no ray has found: the surface is folded flat, or crosses itself.");
  }
}

/// The way from the middle of the body to each vertex.
Points OffsetsFromMiddle(const TriangleMesh& mesh, const Points& points, const Points& normals,
  const SparseMatrix& laplacian, const VolumeModel& model)
{
  Points centers = points;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    centers.row(v) -= 0.5 * model.LocalDepth[v] * normals.row(v);
  }
  Points offsets = points - SmoothedCenters(mesh, points, laplacian, centers, model);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (!mesh.IsUsed(v) || !model.EnclosesVolume[mesh.Component(v)])
    {
      offsets.row(v).setZero();
    }
  }
  return offsets;
}
}

VolumeModel MeasureVolumeModel(const TriangleMesh& mesh, const Points& points,
  const RayCaster& castRay, const ExecutionContext& context, std::vector<long long> names)
{
  VolumeModel model;
  model.Names = std::move(names);
  FindEnclosingComponents(mesh, points, model);
  if (!IsAnyEnclosing(model))
  {
    return model;
  }
  const Points normals = VertexNormals(mesh, points, context);
  MeasureDepths(mesh, points, normals, castRay, context, model);
  LeaveOutUnmeasured(mesh, model);
  if (!IsAnyEnclosing(model))
  {
    model.LocalDepth.resize(0);
    return model;
  }
  const SparseMatrix laplacian =
    Laplacian(mesh, EdgeWeights(mesh, points, LaplacianWeights::Cotangent, context));
  FillDepths(mesh, laplacian, model);
  model.Offsets = OffsetsFromMiddle(mesh, points, normals, laplacian, model);

  context.Report(1.0);
  return model;
}

Eigen::VectorXd ColumnHeights(const TriangleMesh& mesh, const Points& points,
  const Eigen::VectorXd& localDepth, const ExecutionContext& context)
{
  const Curvatures curvatures =
    CurvaturesFromNormals(mesh, points, VertexNormals(mesh, points, context), context);
  Eigen::VectorXd heights(mesh.NumberOfVertices());
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const double k1 = curvatures.Maximum[v];
    const double k2 = curvatures.Minimum[v];
    heights[v] = ColumnHeight(ColumnDepth(localDepth[v], k1, k2), k1, k2);
  }
  return heights;
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
}
