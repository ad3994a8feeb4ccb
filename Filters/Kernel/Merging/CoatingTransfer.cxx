// SPDX-License-Identifier: BSD-3-Clause
#include "Merging/CoatingTransfer.h"

#include "Algebra/AnchoredSystem.h"
#include "Base/Constants.h"
#include "Differential/LaplaceOperator.h"
#include "Differential/RotationFit.h"
#include "Mesh/Geometry.h"
#include "Mesh/UsedVertices.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
Points SmoothBase(
  const TriangleMesh& mesh, const Points& points, double width, const ExecutionContext& context)
{
  if (!(width > 0.0))
  {
    return points;
  }
  std::vector<double> lengths(mesh.NumberOfComponents(), 0.0);
  std::vector<int> counts(mesh.NumberOfComponents(), 0);
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    const int component = mesh.Component(mesh.Origin(d));
    lengths[component] += (points.row(mesh.Neighbor(d)) - points.row(mesh.Origin(d))).norm();
    ++counts[component];
  }
  std::vector<double> steps;
  for (std::size_t c = 0; c < lengths.size(); ++c)
  {
    const double frequency = 2.0 * Pi / (width * lengths[c] / counts[c]);
    steps.push_back(1.0 / (frequency * frequency));
  }
  const LaplaceOperator laplace(mesh, points, LaplacianWeights::Cotangent, context.Part(0.0, 0.1));
  // Areas are the operator's masses times their mean.
  const double meanArea = MixedVoronoiAreas(mesh, points).sum() /
    static_cast<double>(std::max<std::size_t>(UsedVertices(mesh).size(), 1));
  Anchors anchors = Anchors::After(0, mesh.NumberOfVertices());
  anchors.Stiffness = Eigen::VectorXd::Zero(mesh.NumberOfVertices());
  for (const int v : UsedVertices(mesh))
  {
    const double ratio = meanArea / steps[mesh.Component(v)];
    anchors.IsHard[v] = 0;
    anchors.Stiffness[v] = laplace.GetMass()[v] * ratio * ratio;
  }
  AnchoredSystem system;
  system.Factorize(
    PolyharmonicMatrix(Laplacian(mesh, laplace.GetWeights()), laplace.GetMass().cwiseInverse(), 2),
    anchors, context.Part(0.1, 0.9));
  // What the first filter takes away is filtered and given back: S p + S (p - S p).
  Field smooth = points;
  system.Interpolate(smooth);
  Field rest = points - smooth;
  for (Eigen::Index v = 0; v < rest.rows(); ++v)
  {
    rest.row(v) *= anchors.IsHard[v] ? 0.0 : 1.0;
  }
  system.Interpolate(rest);
  return smooth + rest;
}

PlaceFrames FramesAtPlaces(const TriangleMesh& target, const Points& targetPoints,
  const Points& basePoints, const std::vector<SurfacePlace>& places,
  const ExecutionContext& context)
{
  const Points there = AtPlaces(basePoints, places);
  PlaceFrames frames;
  frames.Rotations = FitRotations(target, there, targetPoints, context);
  std::vector<double> before(target.NumberOfComponents(), 0.0);
  std::vector<double> after(target.NumberOfComponents(), 0.0);
  for (int d = 0; d < target.NumberOfDirectedEdges(); ++d)
  {
    const int v = target.Origin(d);
    const int w = target.Neighbor(d);
    before[target.Component(v)] += (there.row(w) - there.row(v)).squaredNorm();
    after[target.Component(v)] += (targetPoints.row(w) - targetPoints.row(v)).squaredNorm();
  }
  frames.Scales = Eigen::VectorXd::Ones(target.NumberOfVertices());
  for (int v = 0; v < target.NumberOfVertices(); ++v)
  {
    const int component = target.Component(v);
    if (component >= 0 && before[component] > 0.0)
    {
      frames.Scales[v] = std::sqrt(after[component] / before[component]);
    }
  }
  return frames;
}

Points CoatingDisplacements(const Points& base, const Points& detailed,
  const std::vector<SurfacePlace>& places, const PlaceFrames& frames, bool scales,
  const Eigen::VectorXd& strengths)
{
  Points displacements = AtPlaces(detailed - base, places);
  for (Eigen::Index v = 0; v < displacements.rows(); ++v)
  {
    const double factor = strengths[v] * (scales ? frames.Scales[v] : 1.0);
    const Eigen::Vector3d turned = MatrixAt(frames.Rotations, v) * displacements.row(v).transpose();
    displacements.row(v) = factor * turned.transpose();
  }
  return displacements;
}
}
