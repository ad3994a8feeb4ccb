// SPDX-License-Identifier: BSD-3-Clause
#include "Morph/PyramidCoordinatesMorph.h"

#include "Algebra/AndersonAcceleration.h"
#include "Algebra/Rotation.h"
#include "Base/Constants.h"
#include "Differential/DiscreteForms.h"
#include "Differential/FrameReconstruction.h"
#include "Differential/Laplacian.h"
#include "Differential/PyramidCoordinates.h"
#include "Morph/LengthErrors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>

namespace cartan
{
namespace
{
/// Points that move by less in an iteration, relative to the mean edge, have settled.
constexpr double Settled = 1e-8;

/// Small bars settle in 40 to 100 iterations, scans of 10,000 points in 500.
constexpr int MaximumIterations = 1000;

/// Against Anderson differences that become parallel, see there.
constexpr double Regularization = 1e-12;

/// Edges shorter than this part of the mean one weigh as if they had this length.
constexpr double Negligible = 1e-4;

/// Makes the angles of closed one-rings sum to full turns, by the same change of each. They
/// do already, but where a ring folds and winds about its normal once more in one key frame
/// than in the other.
void CloseRings(const TriangleMesh& mesh, Eigen::VectorXd& angles)
{
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v) && !mesh.IsBoundary(v))
    {
      auto ring = angles.segment(mesh.RingBegin(v), mesh.Valence(v));
      const double turns = ring.sum() / (2.0 * Pi);
      // Half way between two numbers rounding must not choose.
      const double whole = std::floor(turns + 0.5 - 1e-6);
      ring.array() += 2.0 * Pi * (whole - turns) / mesh.Valence(v);
    }
  }
}
}

PyramidCoordinatesMorph::PyramidCoordinatesMorph(
  const KeyFrames& keys, const ExecutionContext& context)
  : Mesh(keys.Mesh)
  , Start(keys, DiscreteFormsMorph::Transitions::Rotations,
      DiscreteFormsMorph::FrameSolver::RotationAveraging, context.Part(0.0, 0.5))
{
  this->InterpolateCoordinates(keys, context.Part(0.5, 0.7));
  this->FindWeights(keys);
  this->Laplacian.Factorize(cartan::Laplacian(*this->Mesh, this->Weights),
    Anchors::Hard(this->Mesh->Grounded()), context.Part(0.7, 1.0));
  context.Report(1.0);
}

void PyramidCoordinatesMorph::InterpolateCoordinates(
  const KeyFrames& keys, const ExecutionContext& context)
{
  const TriangleMesh& mesh = *this->Mesh;
  const auto count = static_cast<Eigen::Index>(mesh.NumberOfDirectedEdges());
  const auto numberOfKeys = static_cast<Eigen::Index>(keys.Positions.size());
  Field lengths(count, numberOfKeys);
  Field angles(count, numberOfKeys);
  Field heights(count, numberOfKeys);
  for (Eigen::Index k = 0; k < numberOfKeys; ++k)
  {
    const Points& positions = keys.Positions[static_cast<std::size_t>(k)];
    const DiscreteForms forms =
      ComputeDiscreteForms(mesh, positions, VertexFrames(mesh, positions, context), context);
    lengths.col(k) = forms.Length;
    heights.col(k) = forms.Height;
    for (Eigen::Index d = 0; d < count; ++d)
    {
      // Behind the last edge of a boundary fan there is none.
      const double angle = std::isnan(forms.Angle[d]) ? 0.0 : forms.Angle[d];
      const double turns = k > 0 ? std::round((angles(d, k - 1) - angle) / (2.0 * Pi)) : 0.0;
      angles(d, k) = angle + 2.0 * Pi * turns;
    }
    context.Report((static_cast<double>(k) + 1.0) / static_cast<double>(numberOfKeys));
  }
  this->KeyLengths = KeyInterpolation(keys.Parameters, std::move(lengths));
  this->KeyAngles = KeyInterpolation(keys.Parameters, std::move(angles));
  this->KeyHeights = KeyInterpolation(keys.Parameters, std::move(heights));
}

void PyramidCoordinatesMorph::FindWeights(const KeyFrames& keys)
{
  const TriangleMesh& mesh = *this->Mesh;
  this->Weights = Eigen::VectorXd::Zero(mesh.NumberOfDirectedEdges());
  for (const Points& positions : keys.Positions)
  {
    for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
    {
      this->Weights[d] += (positions.row(mesh.Neighbor(d)) - positions.row(mesh.Origin(d))).norm() /
        static_cast<double>(keys.Positions.size());
    }
  }
  this->MeanEdge = this->Weights.mean();
  // Relative to the mean, so that the unit of length does not matter.
  this->Weights = this->MeanEdge / this->Weights.array().max(Negligible * this->MeanEdge);
}

std::size_t PyramidCoordinatesMorph::GetBytes() const
{
  return this->Start.GetBytes() + this->KeyLengths.GetBytes() + this->KeyAngles.GetBytes() +
    this->KeyHeights.GetBytes() + this->Laplacian.GetBytes() + TotalBytes(this->Weights);
}

Points PyramidCoordinatesMorph::RingsAt(
  const MorphPlace& place, const ExecutionContext& context) const
{
  // A ring is at the parameter of its center.
  const auto sample = [&](const KeyInterpolation& values)
  {
    return place.Sample(
      values, this->Mesh->NumberOfDirectedEdges(),
      [this](int d) { return std::array{ this->Mesh->Origin(d) }; }, context);
  };
  DiscreteForms forms;
  forms.Length = sample(this->KeyLengths);
  forms.Angle = sample(this->KeyAngles);
  forms.Height = sample(this->KeyHeights);
  CloseRings(*this->Mesh, forms.Angle);
  return RingCoordinates(*this->Mesh, forms);
}

double PyramidCoordinatesMorph::FitFrames(const Points& positions, const Points& rings,
  Matrices& frames, const ExecutionContext& context) const
{
  const TriangleMesh& mesh = *this->Mesh;
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(mesh.NumberOfVertices());
  context.For(mesh.NumberOfVertices(),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        // The rotation closest to the product: the whole ring is fitted, its plane too, and
        // not the plane of the positions as FitPyramid does.
        const Eigen::Matrix3d frame =
          ProjectOnRotations(RingProduct(mesh, positions, rings, this->Weights, v),
            Eigen::Matrix3d(MatrixAt(frames, v)));
        MatrixAt(frames, v) = frame;
        sums[v] = RingResidual(mesh, positions, rings, this->Weights, v, frame);
      }
    });
  return sums.sum();
}

Points PyramidCoordinatesMorph::Improve(
  Points positions, const Points& rings, double t, const ExecutionContext& context)
{
  AndersonAcceleration acceleration(Regularization);
  Matrices frames(positions.rows(), 9);
  for (Eigen::Index v = 0; v < positions.rows(); ++v)
  {
    MatrixAt(frames, v).setIdentity();
  }
  double least = this->FitFrames(positions, rings, frames, context);
  Eigen::VectorXd next;
  double largest = 0.0;
  while (this->Iterations < MaximumIterations)
  {
    ++this->Iterations;
    Field solved = positions;
    this->Laplacian.Solve(
      PositionRightHandSide(*this->Mesh, frames, rings, context, this->Weights), solved);
    const Points step = solved - positions;
    largest = step.rowwise().norm().maxCoeff() / this->MeanEdge;
    const auto flat = [](const auto& points)
    { return Eigen::Map<const Eigen::VectorXd>(points.data(), points.size()); };
    const Points plain = solved;
    acceleration.Next(flat(plain), flat(step), next);
    positions = Eigen::Map<const Points>(next.data(), positions.rows(), 3);
    double sum = this->FitFrames(positions, rings, frames, context);
    if (!(sum <= least))
    {
      // Too far: the plain step never is.
      acceleration.Forget();
      positions = plain;
      sum = this->FitFrames(positions, rings, frames, context);
    }
    least = sum;
    if (!(largest > Settled))
    {
      return positions;
    }
    context.Report(static_cast<double>(this->Iterations) / MaximumIterations);
  }
  std::ostringstream text;
  text << "The surface at the parameter " << t << " is not the best: after " << MaximumIterations
       << " iterations points still move by " << largest
       << " of the mean edge. Use the Isometric method, which does not iterate.";
  this->Warning = text.str();
  return positions;
}

void PyramidCoordinatesMorph::WarnOfLengths(double t, const Points& rings, const Points& positions)
{
  const TriangleMesh& mesh = *this->Mesh;
  Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor> edges(mesh.NumberOfEdges(), 2);
  Eigen::VectorXd lengths(mesh.NumberOfEdges());
  Eigen::Index e = 0;
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    if (d < mesh.Twin(d))
    {
      edges.row(e) << mesh.Origin(d), mesh.Neighbor(d);
      lengths[e++] = 0.5 * (rings.row(d).norm() + rings.row(mesh.Twin(d)).norm());
    }
  }
  const std::string errors = DescribeLengthErrors(t, edges, lengths, positions);
  if (!errors.empty())
  {
    this->Warning += (this->Warning.empty() ? "" : " ") + errors +
      " Try the Isometric method, or add a key frame in between.";
  }
}

Points PyramidCoordinatesMorph::Evaluate(const MorphPlace& place, const ExecutionContext& context)
{
  this->Iterations = 0;
  this->Warning.clear();
  Points positions = this->Start.Evaluate(place, context.Part(0.0, 0.3));
  const Points rings = this->RingsAt(place, context);
  positions =
    this->Improve(std::move(positions), rings, place.GetParameter(), context.Part(0.3, 0.99));
  this->WarnOfLengths(place.GetParameter(), rings, positions);
  context.Report(1.0);
  return positions;
}
}
