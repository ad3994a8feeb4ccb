// SPDX-License-Identifier: BSD-3-Clause
#include "RigidPlacement.h"

#include "Rotation.h"

#include <algorithm>

namespace cartan
{
namespace
{
Points WeightedCenters(
  const TriangleMesh& mesh, const Points& positions, const Eigen::VectorXd& weights)
{
  Points centers = Points::Zero(mesh.NumberOfComponents(), 3);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v))
    {
      centers.row(mesh.Component(v)) += weights[v] * positions.row(v);
    }
  }
  return centers;
}

/// The rotation of each component that best takes it to `to` about the centers:
/// the orthogonal factor of sum w (q - center q) (p - center p)^T (Kabsch, A
/// solution for the best rotation to relate two sets of vectors, 1976).
std::vector<Eigen::Matrix3d> BestRotations(const TriangleMesh& mesh, const Points& from,
  const Points& fromCenters, const Points& to, const Points& toCenters,
  const Eigen::VectorXd& weights)
{
  std::vector<Eigen::Matrix3d> rotations(mesh.NumberOfComponents(), Eigen::Matrix3d::Zero());
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v) && weights[v] > 0.0)
    {
      const int c = mesh.Component(v);
      rotations[c] += weights[v] * (to.row(v) - toCenters.row(c)).transpose() *
        (from.row(v) - fromCenters.row(c));
    }
  }
  for (Eigen::Matrix3d& rotation : rotations)
  {
    rotation = ProjectOnRotations(rotation);
  }
  return rotations;
}
}

RigidPlacement::RigidPlacement(const KeyFrames& keys, Eigen::VectorXd weights)
  : Keys(keys)
  , Weights(std::move(weights))
{
  const TriangleMesh& mesh = *this->Keys.Mesh;
  const int components = mesh.NumberOfComponents();
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(components);
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(components);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v))
    {
      sums[mesh.Component(v)] += this->Weights[v];
      counts[mesh.Component(v)] += 1.0;
    }
  }
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v))
    {
      const int c = mesh.Component(v);
      this->Weights[v] = sums[c] > 0.0 ? this->Weights[v] / sums[c] : 1.0 / counts[c];
    }
  }
  const int count = static_cast<int>(this->Keys.Positions.size());
  Field paths(3 * components, count);
  for (int k = 0; k < count; ++k)
  {
    this->Centers.push_back(WeightedCenters(mesh, this->Keys.Positions[k], this->Weights));
    paths.col(k) = Eigen::Map<const Eigen::VectorXd>(this->Centers[k].data(), 3 * components);
  }
  this->CenterPaths = KeyInterpolation(this->Keys.Parameters, std::move(paths));
  for (int k = 0; k + 1 < count; ++k)
  {
    const std::vector<Eigen::Matrix3d> rotations = BestRotations(mesh, this->Keys.Positions[k],
      this->Centers[k], this->Keys.Positions[k + 1], this->Centers[k + 1], this->Weights);
    Points turns(components, 3);
    for (int c = 0; c < components; ++c)
    {
      turns.row(c) = VectorFromRotation(rotations[c]).transpose();
    }
    this->Turns.push_back(std::move(turns));
  }
}

void RigidPlacement::Place(double t, Points& positions) const
{
  const TriangleMesh& mesh = *this->Keys.Mesh;
  const std::vector<double>& parameters = this->Keys.Parameters;
  // The key frames before and after t, the outermost two beyond them.
  const auto after = std::upper_bound(parameters.begin() + 1, parameters.end() - 1, t);
  const std::size_t k = static_cast<std::size_t>(after - parameters.begin()) - 1;
  const double part = (t - parameters[k]) / (parameters[k + 1] - parameters[k]);

  const Points own = WeightedCenters(mesh, positions, this->Weights);
  const auto rotationsTo = [&](std::size_t key)
  {
    return BestRotations(mesh, positions, own, this->Keys.Positions[key], this->Centers[key],
      this->Weights);
  };
  std::vector<Eigen::Matrix3d> rotations = rotationsTo(k);
  const std::vector<Eigen::Matrix3d> toAfter = rotationsTo(k + 1);
  for (std::size_t c = 0; c < rotations.size(); ++c)
  {
    const Eigen::Vector3d guess = this->Turns[k].row(static_cast<Eigen::Index>(c));
    const Eigen::Vector3d turn =
      VectorFromRotation(toAfter[c] * rotations[c].transpose(), guess);
    rotations[c] = RotationFromVector(part * turn) * rotations[c];
  }
  const Eigen::VectorXd centers = this->CenterPaths.Evaluate(t);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v))
    {
      const int c = mesh.Component(v);
      const Eigen::Vector3d arm = positions.row(v) - own.row(c);
      positions.row(v) = (centers.segment<3>(3 * c) + rotations[c] * arm).transpose();
    }
  }
}
}
