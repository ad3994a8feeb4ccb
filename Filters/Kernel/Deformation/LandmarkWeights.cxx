// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/LandmarkWeights.h"

#include "Algebra/AnchoredSystem.h"
#include "Differential/LaplaceOperator.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cartan
{
namespace
{
/// Steps of the secant method; three to five are usual.
constexpr int MostSteps = 12;

/// A miss between this part of what is allowed and all of it is close enough.
constexpr double CloseEnough = 0.8;

/// How much s^2 may change in a step. Where landmarks move by less than their accuracy,
/// no s is the smallest: it stops after LeastShare of the first one.
constexpr double LargestStep = 30.0;
constexpr double LeastShare = 1e-4;

/// The harmonic displacement for weights s / a_k.
class HarmonicModel
{
public:
  HarmonicModel(const TriangleMesh& mesh, const Points& points, const std::vector<char>& pinned,
    const LandmarkTargets& landmarks)
    : Landmarks(landmarks)
    , Matrix(
        Laplacian(mesh, LaplaceOperator(mesh, points, LaplacianWeights::Cotangent).GetWeights()))
    , Values(Field::Zero(mesh.NumberOfVertices(), 3))
  {
    std::vector<char> isReached(mesh.NumberOfComponents(), 0);
    for (const int v : landmarks.Vertices)
    {
      isReached[mesh.Component(v)] = 1;
    }
    this->Holds.Stiffness = Eigen::VectorXd::Zero(mesh.NumberOfVertices());
    this->Holds.IsHard.resize(mesh.NumberOfVertices());
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      this->Holds.IsHard[v] = !mesh.IsUsed(v) || pinned[v] || !isReached[mesh.Component(v)];
    }
    for (std::size_t k = 0; k < landmarks.Vertices.size(); ++k)
    {
      this->Holds.IsHard[landmarks.Vertices[k]] = !this->IsSoft(k);
    }
  }

  bool IsSoft(std::size_t k) const { return this->Landmarks.Accuracies[k] > 0.0; }

  /// An s^2 for which no landmark gives way: all neighbors staying at rest would pull it
  /// with L_kk |d_k|, and w_k^2 / 2 = L_kk |d_k| / a_k holds against that.
  double StiffStart() const
  {
    double start = 0.0;
    for (std::size_t k = 0; k < this->Landmarks.Vertices.size(); ++k)
    {
      const int v = this->Landmarks.Vertices[k];
      start = std::max(start,
        2.0 * this->Matrix.coeff(v, v) * this->Landmarks.Accuracies[k] *
          this->Landmarks.Displacements.row(static_cast<Eigen::Index>(k)).norm());
    }
    return start;
  }

  /// The largest miss in parts of the accuracy.
  double LargestMiss(double squared, const ExecutionContext& context)
  {
    for (std::size_t k = 0; k < this->Landmarks.Vertices.size(); ++k)
    {
      const int v = this->Landmarks.Vertices[k];
      this->Values.row(v) = this->Landmarks.Displacements.row(static_cast<Eigen::Index>(k));
      if (this->IsSoft(k))
      {
        // L stands for one direction of each edge: half of w_k^2.
        const double accuracy = this->Landmarks.Accuracies[k];
        this->Holds.Stiffness[v] = 0.5 * squared / (accuracy * accuracy);
      }
    }
    this->System.Factorize(this->Matrix, this->Holds, context);
    Field values = this->Values;
    this->System.Interpolate(values);
    double largest = 0.0;
    for (std::size_t k = 0; k < this->Landmarks.Vertices.size(); ++k)
    {
      const int v = this->Landmarks.Vertices[k];
      if (this->IsSoft(k))
      {
        const Eigen::RowVector3d miss = values.row(v) - this->Values.row(v);
        largest = std::max(largest, miss.norm() / this->Landmarks.Accuracies[k]);
      }
    }
    return largest;
  }

private:
  const LandmarkTargets& Landmarks;
  SparseMatrix Matrix;
  Anchors Holds;
  AnchoredSystem System;
  Field Values;
};

/// The smallest s^2 of the header.
double SmallestStiffness(HarmonicModel& model, const ExecutionContext& context)
{
  const double start = model.StiffStart();
  double squared = start;
  double best = 0.0;        // the smallest that is stiff enough
  double lastSquared = 0.0; // a step before
  double lastInverse = 0.0; // and its 1 / miss
  for (int step = 0; step < MostSteps; ++step)
  {
    const double part = 1.0 / MostSteps;
    const double share =
      model.LargestMiss(squared, context.Part(step * part, (step + 1) * part)) / MissedShare;
    if (share <= 1.0)
    {
      best = best > 0.0 ? std::min(best, squared) : squared;
      if (share >= CloseEnough || squared <= LeastShare * start)
      {
        break;
      }
    }
    // 1 / share = inverse + slope (s^2 - squared), and a little below 1 is wanted.
    const double inverse = 1.0 / std::max(share, std::numeric_limits<double>::min());
    const double slope = (inverse - lastInverse) / (squared - lastSquared);
    const double wanted = 2.0 / (1.0 + CloseEnough);
    double next = squared + (wanted - inverse) / slope;
    if (!(next > squared / LargestStep))
    {
      next = squared / LargestStep;
    }
    lastSquared = squared;
    lastInverse = inverse;
    squared = std::max(std::min(next, squared * LargestStep), LeastShare * start);
  }
  return best > 0.0 ? best : start;
}
}

Eigen::VectorXd LandmarkWeights(const TriangleMesh& mesh, const Points& points,
  const std::vector<char>& pinned, const LandmarkTargets& landmarks,
  const ExecutionContext& context)
{
  Eigen::VectorXd weights =
    Eigen::VectorXd::Constant(landmarks.Accuracies.size(), std::numeric_limits<double>::infinity());
  const bool moves = landmarks.Displacements.rowwise().squaredNorm().maxCoeff() > 0.0;
  if (!(landmarks.Accuracies.maxCoeff() > 0.0) || !moves)
  {
    return weights;
  }
  HarmonicModel model(mesh, points, pinned, landmarks);
  const double scale = std::sqrt(SmallestStiffness(model, context));
  for (Eigen::Index k = 0; k < weights.size(); ++k)
  {
    if (landmarks.Accuracies[k] > 0.0)
    {
      weights[k] = scale / landmarks.Accuracies[k];
    }
  }
  return weights;
}
}
