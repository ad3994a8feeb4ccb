// SPDX-License-Identifier: BSD-3-Clause
#include "Merging/CoatingTransfer.h"

#include "Algebra/AnchoredSystem.h"
#include "Algebra/SimilarityFit.h"
#include "Base/Constants.h"
#include "Base/Error.h"
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

Eigen::Matrix4d AlignKeys(const std::map<int, int>& targetKeys, const Points& target,
  const std::map<int, int>& sourceKeys, const Points& source)
{
  std::vector<int> from;
  std::vector<int> to;
  for (const auto& [key, point] : targetKeys)
  {
    const auto partner = sourceKeys.find(key);
    if (partner != sourceKeys.end())
    {
      from.push_back(point);
      to.push_back(partner->second);
    }
  }
  const Points fromPoints = target(from, Eigen::all);
  if (!SpanPlane(fromPoints))
  {
    throw Error(ErrorCode::BadInput,
      std::to_string(from.size()) +
        " points have equal keys on both surfaces, which is too few, or they lie on a line: give "
        "three points or more, not on one line, equal numbers from 1 on both.");
  }
  return FitSimilarity(fromPoints, source(to, Eigen::all));
}

Points CoatingByLaplacians(const TriangleMesh& mesh, const Points& base, const Points& detailed,
  const PlaceFrames& frames, bool scales, const Eigen::VectorXd& strengths, const Points& guess,
  const ExecutionContext& context)
{
  const LaplaceOperator laplace(mesh, base, LaplacianWeights::Cotangent, context);
  const SparseMatrix matrix = Laplacian(mesh, laplace.GetWeights());
  Points turned = ApplyLaplacian(matrix, detailed - base);
  Points means = Points::Zero(mesh.NumberOfComponents(), 3);
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(mesh.NumberOfComponents());
  const std::vector<int> used = UsedVertices(mesh);
  for (const int v : used)
  {
    const double factor = strengths[v] * (scales ? frames.Scales[v] : 1.0);
    const Eigen::Vector3d u = MatrixAt(frames.Rotations, v) * turned.row(v).transpose();
    turned.row(v) = factor * u.transpose();
    means.row(mesh.Component(v)) += turned.row(v);
    ++counts[mesh.Component(v)];
  }
  // L u sums to zero, and what differs after turning is spread over all vertices.
  for (const int v : used)
  {
    turned.row(v) -= means.row(mesh.Component(v)) / counts[mesh.Component(v)];
  }
  AnchoredSystem system;
  system.Factorize(matrix, Anchors::Hard(mesh.Grounded()), context);
  Field displacements = Field::Zero(mesh.NumberOfVertices(), 3);
  system.Solve(turned, displacements);
  Points shifts = Points::Zero(mesh.NumberOfComponents(), 3);
  for (const int v : used)
  {
    shifts.row(mesh.Component(v)) += guess.row(v) - displacements.row(v);
  }
  for (const int v : used)
  {
    displacements.row(v) += shifts.row(mesh.Component(v)) / counts[mesh.Component(v)];
  }
  return displacements;
}
}
