// SPDX-License-Identifier: BSD-3-Clause
#include "Differential/DifferentialCoordinates.h"

#include "Base/Bytes.h"
#include "Differential/LaplaceOperator.h"
#include "Mesh/Geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cartan
{
namespace
{
/// Throws where a component has no anchor: it could be anywhere.
void RequireAnchors(const TriangleMesh& mesh, const std::vector<int>& anchors)
{
  std::vector<char> isAnchored(mesh.NumberOfComponents(), 0);
  for (const int v : anchors)
  {
    if (mesh.IsUsed(v))
    {
      isAnchored[mesh.Component(v)] = 1;
    }
  }
  IdSample floating;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v) && !isAnchored[mesh.Component(v)])
    {
      isAnchored[mesh.Component(v)] = 1;
      floating.Add(v);
    }
  }
  if (!floating.IsEmpty())
  {
    throw Error(ErrorCode::SingularSystem,
      "Differential coordinates do not say where a surface is, and " +
        std::to_string(floating.GetCount()) +
        " of its components have no anchor: mark at least one point of each, such as " +
        floating.Describe("point", "points") + " (Mark Handle).");
  }
}

/// The masses in which the equations of a fit are weighted.
Eigen::VectorXd MassesOfFit(const TriangleMesh& mesh, const Points& points,
  const DifferentialReconstruction::Settings& settings, const DifferentialOperator& row,
  const ExecutionContext& context)
{
  if (settings.Normalization != DeltaNormalization::Row)
  {
    return LaplaceOperator(mesh, points, settings.Weights, context).GetMass();
  }
  // Mean value weights have a unit; their mean takes it away.
  return row.GetDivisors() / row.GetDivisors().mean();
}

/// Weights beyond this multiple of the median come from triangles so low that rounding of
/// their corners changes them.
constexpr double LargeWeight = 1e4;

bool HasLargeWeights(const Eigen::VectorXd& weights)
{
  Eigen::VectorXd sizes = weights.cwiseAbs();
  const Eigen::Index middle = sizes.size() / 2;
  std::nth_element(sizes.data(), sizes.data() + middle, sizes.data() + sizes.size());
  return sizes.size() > 0 && sizes.maxCoeff() > LargeWeight * sizes[middle];
}

/// Each coordinate up to `rounding` off, by golden-ratio steps: the same everywhere.
Points WithOtherDigits(const Points& points, double rounding)
{
  constexpr double GoldenRatio = 0.6180339887498949;
  Points other = points;
  double* const coordinates = other.data();
  double phase = 0.0;
  for (Eigen::Index i = 0; i < other.size(); ++i)
  {
    phase += GoldenRatio;
    phase -= std::floor(phase);
    coordinates[i] += rounding * (2.0 * phase - 1.0);
  }
  return other;
}
}

DifferentialOperator::DifferentialOperator(const TriangleMesh& mesh, const Points& points,
  LaplacianWeights weights, DeltaNormalization normalization, const ExecutionContext& context)
  : Weights(EdgeWeights(mesh, points, weights, context))
  , Divisors(Eigen::VectorXd::Ones(mesh.NumberOfVertices()))
{
  if (normalization == DeltaNormalization::Integrated)
  {
    return;
  }
  const bool isByArea = normalization == DeltaNormalization::Area;
  const Eigen::VectorXd areas =
    isByArea ? MixedVoronoiAreas(mesh, points, context) : Eigen::VectorXd();
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (!mesh.IsUsed(v))
    {
      continue;
    }
    if (isByArea)
    {
      this->Divisors[v] = areas[v] > 0.0 ? areas[v] : areas.mean();
      continue;
    }
    // Also cotangents sum to more than zero, as in a triangle cot b + cot c =
    // sin a / (sin b sin c), but for the rounding of slivers.
    const auto ring = this->Weights.segment(mesh.RingBegin(v), mesh.RingEnd(v) - mesh.RingBegin(v));
    this->Divisors[v] = std::max(ring.sum(), 1e-12 * ring.cwiseAbs().sum());
  }
}

Points DifferentialOperator::Apply(
  const TriangleMesh& mesh, const Points& values, const ExecutionContext& context) const
{
  Points deltas(values.rows(), 3);
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
        for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
        {
          sum += this->Weights[d] * (values.row(v) - values.row(mesh.Neighbor(d)));
        }
        deltas.row(v) = sum / this->Divisors[v];
      }
    });
  return deltas;
}

DifferentialReconstruction::DifferentialReconstruction(std::shared_ptr<const TriangleMesh> mesh,
  std::shared_ptr<const Points> points, std::vector<int> anchors,
  const Eigen::VectorXd& anchorWeights, const Settings& settings, const ExecutionContext& context)
  : Mesh(std::move(mesh))
  , Rest(std::move(points))
  , AnchorVertices(std::move(anchors))
  , Operator(
      *this->Mesh, *this->Rest, settings.Weights, settings.Normalization, context.Part(0.0, 0.1))
  , System(settings.Backend)
{
  RequireAnchors(*this->Mesh, this->AnchorVertices);
  if (settings.Rounding > 0.0 && HasLargeWeights(this->Operator.GetWeights()))
  {
    this->OfOtherDigits.emplace(*this->Mesh, WithOtherDigits(*this->Rest, settings.Rounding),
      settings.Weights, settings.Normalization, context);
  }
  this->Masses =
    MassesOfFit(*this->Mesh, *this->Rest, settings, this->Operator, context.Part(0.1, 0.2));
  const bool isSoft = settings.Mode == AnchorMode::Soft;
  Anchors held = Anchors::After(this->Mesh->NumberOfVertices(), this->Mesh->NumberOfVertices());
  held.Stiffness = Eigen::VectorXd::Zero(this->Mesh->NumberOfVertices());
  for (int v = 0; v < this->Mesh->NumberOfVertices(); ++v)
  {
    held.IsHard[v] = this->Mesh->IsUsed(v) ? 0 : 1;
  }
  for (std::size_t i = 0; i < this->AnchorVertices.size(); ++i)
  {
    const int v = this->AnchorVertices[i];
    const double omega = anchorWeights[static_cast<Eigen::Index>(i)];
    held.IsHard[v] = isSoft && this->Mesh->IsUsed(v) ? 0 : 1;
    held.Stiffness[v] = held.IsHard[v] ? 0.0 : omega * omega;
  }
  this->System.FactorizeFit(Laplacian(*this->Mesh, this->Operator.GetWeights()),
    this->Masses.cwiseInverse(), held, settings.Mode, context.Part(0.2, 1.0));
}

Points DifferentialReconstruction::Residual(const Points& deltas, const Points& positions) const
{
  const Points residual = deltas - this->Operator.Apply(*this->Mesh, positions);
  // The equations are M^-1 L x = d, the deltas N^-1 L x.
  return this->Operator.GetDivisors().cwiseQuotient(this->Masses).asDiagonal() * residual;
}

/// How much larger the deltas are than those of the given positions: coordinates that were
/// made of these and scaled hang on the same digits.
double DifferentialReconstruction::Exaggeration(const Points& deltas) const
{
  const Points own = this->Operator.Apply(*this->Mesh, *this->Rest);
  std::vector<double> ratios;
  for (Eigen::Index v = 0; v < own.rows(); ++v)
  {
    if (own.row(v).squaredNorm() > 0.0)
    {
      ratios.push_back(deltas.row(v).dot(own.row(v)) / own.row(v).squaredNorm());
    }
  }
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return ratios.empty() ? 1.0 : *middle;
}

Points DifferentialReconstruction::ChangeOfOtherDigits(
  const Points& deltas, const Points& positions) const
{
  const Points difference = positions - this->Exaggeration(deltas) * *this->Rest;
  Points change = Points::Zero(positions.rows(), 3);
  const Points other = this->OfOtherDigits->Apply(*this->Mesh, difference);
  this->System.Solve(this->Residual(other, difference), change);
  return change;
}

Points DifferentialReconstruction::Reconstruct(const Points& deltas, const Points& anchorPositions,
  const ExecutionContext& context, Points* uncertainty) const
{
  // Steps of refinement gain as many digits as the factors have; a step that does
  // not halve the one before is rounding.
  constexpr int MostSteps = 10;
  Points positions = *this->Rest;
  double before = std::numeric_limits<double>::infinity();
  for (int step = 0; step < MostSteps; ++step)
  {
    Points change = Points::Zero(positions.rows(), 3);
    for (std::size_t i = 0; i < this->AnchorVertices.size(); ++i)
    {
      const int v = this->AnchorVertices[i];
      change.row(v) = anchorPositions.row(static_cast<Eigen::Index>(i)) - positions.row(v);
    }
    this->System.Solve(this->Residual(deltas, positions), change);
    const double size = change.norm();
    if (uncertainty)
    {
      *uncertainty = change;
    }
    if (step > 0 && !(size < 0.5 * before))
    {
      break;
    }
    positions += change;
    before = size;
    context.Report((step + 1.0) / MostSteps);
  }
  if (uncertainty && this->OfOtherDigits)
  {
    const Points other = this->ChangeOfOtherDigits(deltas, positions);
    for (Eigen::Index v = 0; v < other.rows(); ++v)
    {
      if (!(other.row(v).norm() <= uncertainty->row(v).norm()))
      {
        uncertainty->row(v) = other.row(v);
      }
    }
  }
  return positions;
}

std::size_t DifferentialReconstruction::GetBytes() const
{
  return this->System.GetBytes() +
    TotalBytes(this->Masses, this->Operator.GetWeights(), this->Operator.GetDivisors(),
      this->AnchorVertices) +
    (this->OfOtherDigits
        ? TotalBytes(this->OfOtherDigits->GetWeights(), this->OfOtherDigits->GetDivisors())
        : 0);
}
}
