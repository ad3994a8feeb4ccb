// SPDX-License-Identifier: BSD-3-Clause
#include "Compression/HighPassQuantization.h"

#include "Base/Bytes.h"
#include "Differential/DifferentialCoordinates.h"
#include "Mesh/FarthestPoints.h"
#include "Mesh/Geometry.h"
#include "Mesh/UsedVertices.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
/// The geometric Laplacian S(v) of VisualError. Edges without length weigh as
/// neighbors in the same place should: next to everything.
Eigen::RowVector3d GeometricLaplacian(const TriangleMesh& mesh, const Points& points, int v)
{
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  double weights = 0.0;
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    const Eigen::RowVector3d edge = points.row(mesh.Neighbor(d)) - points.row(v);
    const double weight = 1.0 / std::max(edge.norm(), 1e-150);
    sum += weight * edge;
    weights += weight;
  }
  return weights > 0.0 ? Eigen::RowVector3d(-sum / weights) : sum;
}

/// A value less than this part of a cell below its upper bound counts as on it. Zero lies on a
/// bound where the extreme values are opposite, as on symmetric surfaces, and rounding would
/// choose the cell for each vertex. Far above rounding, far below what a cell rounds anyway.
constexpr double OnBound = 1e-6;

/// The number of the cell of [low, low + range] that has `value`, of 2^bits cells.
std::int32_t CellOf(double value, double low, double range, int bits)
{
  const double cells = std::ldexp(1.0, bits);
  const double cell = range > 0.0 ? std::floor((value - low) / range * cells + OnBound) : 0.0;
  return static_cast<std::int32_t>(std::clamp(cell, 0.0, cells - 1.0));
}

double CenterOf(std::int32_t cell, double low, double range, int bits)
{
  return low + range * std::ldexp(cell + 0.5, -bits);
}

double Entropy(const std::vector<int>& counts)
{
  double sum = 0.0;
  double entropy = 0.0;
  for (const int count : counts)
  {
    sum += count;
  }
  for (const int count : counts)
  {
    entropy -= count > 0 ? count / sum * std::log2(count / sum) : 0.0;
  }
  return entropy;
}
}

double HighPassCode::BitsPerVertex(const TriangleMesh& mesh) const
{
  const std::vector<int> used = UsedVertices(mesh);
  double bits = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    std::vector<int> counts(std::size_t{ 1 } << this->Bits, 0);
    for (const int v : used)
    {
      ++counts[static_cast<std::size_t>(this->Deltas(v, axis))];
    }
    bits += Entropy(counts);
  }
  return bits +
    3.0 * AnchorBits * static_cast<double>(this->Anchors.size()) / static_cast<double>(used.size());
}

HighPassCoder::HighPassCoder(std::shared_ptr<const TriangleMesh> mesh, const Points& points,
  int numberOfAnchors, SolverBackend backend, const ExecutionContext& context)
  : Mesh(std::move(mesh))
{
  const int least = std::max(numberOfAnchors, this->Mesh->NumberOfComponents());
  this->AnchorVertices = FarthestPoints(*this->Mesh, points, least, context.Part(0.0, 0.2));
  if (static_cast<int>(this->AnchorVertices.size()) < numberOfAnchors)
  {
    throw Error(ErrorCode::BadInput,
      std::to_string(numberOfAnchors) + " anchors are asked for, and the surface has " +
        std::to_string(this->AnchorVertices.size()) +
        " points in different places: ask for at most as many.");
  }
  std::sort(this->AnchorVertices.begin(), this->AnchorVertices.end());
  this->Factorize(backend, context.Part(0.2, 1.0));
}

HighPassCoder::HighPassCoder(std::shared_ptr<const TriangleMesh> mesh, std::vector<int> anchors,
  SolverBackend backend, const ExecutionContext& context)
  : Mesh(std::move(mesh))
  , AnchorVertices(std::move(anchors))
{
  this->Factorize(backend, context);
}

void HighPassCoder::Factorize(SolverBackend backend, const ExecutionContext& context)
{
  DifferentialReconstruction::Settings settings;
  settings.Weights = LaplacianWeights::Uniform;
  settings.Normalization = DeltaNormalization::Integrated;
  settings.Backend = backend;
  // Uniform weights do not look at points: a code is decoded without any.
  const auto nowhere = std::make_shared<Points>(Points::Zero(this->Mesh->NumberOfVertices(), 3));
  this->Reconstruction =
    std::make_shared<DifferentialReconstruction>(this->Mesh, nowhere, this->AnchorVertices,
      Eigen::VectorXd::Ones(static_cast<Eigen::Index>(this->AnchorVertices.size())), settings,
      context);
}

Eigen::AlignedBox3d HighPassCoder::BoxOf(const Points& points) const
{
  Eigen::AlignedBox3d box;
  for (int v = 0; v < this->Mesh->NumberOfVertices(); ++v)
  {
    if (this->Mesh->IsUsed(v))
    {
      box.extend(points.row(v).transpose());
    }
  }
  return box;
}

HighPassScale HighPassScale::Joined(const HighPassScale& other) const
{
  return { std::max(this->Side, other.Side), std::min(this->Low, other.Low),
    std::max(this->High, other.High) };
}

HighPassScale HighPassCoder::ScaleOf(const Points& points) const
{
  const Points deltas = this->Reconstruction->GetOperator().Apply(*this->Mesh, points);
  return { this->BoxOf(points).sizes().maxCoeff(), deltas.minCoeff(), deltas.maxCoeff() };
}

HighPassCode HighPassCoder::Encode(const Points& points, int bits, const HighPassScale& scale) const
{
  HighPassCode code;
  code.Bits = bits;
  code.Anchors = this->AnchorVertices;
  code.Corner = this->BoxOf(points).min();
  code.Side = scale.Side;
  const double unit = code.Side > 0.0 ? code.Side : 1.0;
  const Points deltas = this->Reconstruction->GetOperator().Apply(*this->Mesh, points) / unit;
  code.Low = scale.Low / unit;
  code.Range = scale.High / unit - code.Low;
  code.Deltas.setZero(points.rows(), 3);
  for (int v = 0; v < this->Mesh->NumberOfVertices(); ++v)
  {
    for (int axis = 0; this->Mesh->IsUsed(v) && axis < 3; ++axis)
    {
      code.Deltas(v, axis) = CellOf(deltas(v, axis), code.Low, code.Range, bits);
    }
  }
  code.AnchorPositions.resize(static_cast<Eigen::Index>(code.Anchors.size()), 3);
  for (std::size_t i = 0; i < code.Anchors.size(); ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      code.AnchorPositions(static_cast<Eigen::Index>(i), axis) = CellOf(
        points(code.Anchors[i], axis), code.Corner[axis], code.Side, HighPassCode::AnchorBits);
    }
  }
  return code;
}

Points HighPassCoder::Decode(const HighPassCode& code, const ExecutionContext& context) const
{
  Points deltas = Points::Zero(code.Deltas.rows(), 3);
  for (int v = 0; v < this->Mesh->NumberOfVertices(); ++v)
  {
    for (int axis = 0; this->Mesh->IsUsed(v) && axis < 3; ++axis)
    {
      deltas(v, axis) = CenterOf(code.Deltas(v, axis), code.Low, code.Range, code.Bits);
    }
  }
  Points anchors(code.AnchorPositions.rows(), 3);
  for (Eigen::Index i = 0; i < anchors.rows(); ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      anchors(i, axis) =
        CenterOf(code.AnchorPositions(i, axis), 0.0, 1.0, HighPassCode::AnchorBits);
    }
  }
  const Points unit = this->Reconstruction->Reconstruct(deltas, anchors, context);
  return (code.Side * unit).rowwise() + code.Corner.transpose();
}

std::size_t HighPassCoder::GetBytes() const
{
  return this->Reconstruction->GetBytes() + BytesOf(this->AnchorVertices);
}

Eigen::VectorXd VisualError(const TriangleMesh& mesh, const Points& original, const Points& decoded,
  double alpha, const ExecutionContext& context)
{
  const Points normals = VertexNormals(mesh, original, context);
  Eigen::VectorXd errors = Eigen::VectorXd::Zero(mesh.NumberOfVertices());
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        if (!mesh.IsUsed(v))
        {
          continue;
        }
        const Eigen::RowVector3d moved = decoded.row(v) - original.row(v);
        const double rough =
          (GeometricLaplacian(mesh, original, v) - GeometricLaplacian(mesh, decoded, v)).norm();
        const double sign = moved.dot(normals.row(v)) < 0.0 ? -1.0 : 1.0;
        errors[v] = sign * (alpha * moved.norm() + (1.0 - alpha) * rough);
      }
    });
  return errors;
}
}
