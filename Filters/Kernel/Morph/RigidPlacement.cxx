// SPDX-License-Identifier: BSD-3-Clause
#include "Morph/RigidPlacement.h"

#include "Algebra/Rotation.h"
#include "Differential/RotationFit.h"
#include "Measure/Areas.h"
#include "Measure/ComponentVolumes.h"

#include <Eigen/SVD>

namespace cartan
{
namespace
{
/// The rotation from which those to the others sum to zero with these weights (Karcher, Riemannian
/// center of mass and mollifier smoothing, 1977), from the one of the largest weight on.
Eigen::Matrix3d MeanRotation(
  const std::vector<Eigen::Matrix3d>& rotations, const Eigen::VectorXd& weights)
{
  // Rotations within a quarter turn agree to 1e-15 after a dozen steps.
  constexpr int mostSteps = 30;
  Eigen::Index largest = 0;
  weights.maxCoeff(&largest);
  Eigen::Matrix3d mean = rotations[largest];
  for (int step = 0; step < mostSteps; ++step)
  {
    Eigen::Vector3d turn = Eigen::Vector3d::Zero();
    for (Eigen::Index k = 0; k < weights.size(); ++k)
    {
      turn += weights[k] * VectorFromRotation(Eigen::Matrix3d(rotations[k] * mean.transpose()));
    }
    mean = (RotationFromVector(turn) * mean).eval();
    if (turn.norm() < 1e-15)
    {
      break;
    }
  }
  return mean;
}
}

Eigen::VectorXd AreaWeights(const KeyFrames& keys, const ExecutionContext& context)
{
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(keys.Mesh->NumberOfVertices());
  for (const Points& positions : keys.Positions)
  {
    weights += BarycentricAreas(*keys.Mesh, TriangleAreas(*keys.Mesh, positions, context));
  }
  return weights;
}

Eigen::VectorXd PinWeights(const KeyFrames& keys, const std::vector<char>& isPinned)
{
  const TriangleMesh& mesh = *keys.Mesh;
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(mesh.NumberOfVertices());
  std::vector<std::vector<int>> pinned(mesh.NumberOfComponents());
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v) && isPinned[v])
    {
      weights[v] = 1.0;
      pinned[mesh.Component(v)].push_back(v);
    }
  }
  IdSample flat;
  for (std::size_t c = 0; c < pinned.size(); ++c)
  {
    if (!pinned[c].empty())
    {
      Points points(pinned[c].size(), 3);
      for (std::size_t i = 0; i < pinned[c].size(); ++i)
      {
        points.row(static_cast<Eigen::Index>(i)) = keys.Positions[0].row(pinned[c][i]);
      }
      points.rowwise() -= points.colwise().mean().eval();
      const Eigen::Vector3d sizes = (points.transpose() * points).jacobiSvd().singularValues();
      if (!(sizes[1] > 1e-12 * sizes[0]))
      {
        flat.Add(static_cast<long long>(c));
      }
    }
  }
  if (!flat.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The points to pin are all on one line in " + flat.Describe("component", "components") +
        ": mark three points or more that are not.");
  }
  return weights;
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
    this->Centers.push_back(ComponentCenters(mesh, this->Keys.Positions[k], this->Weights));
    paths.col(k) = Eigen::Map<const Eigen::VectorXd>(this->Centers[k].data(), 3 * components);
  }
  this->CenterPaths = KeyInterpolation(this->Keys.Parameters, std::move(paths), 3);
  for (int k = 0; k + 1 < count; ++k)
  {
    const std::vector<Eigen::Matrix3d> rotations =
      FitComponentRotations(mesh, this->Keys.Positions[k], this->Centers[k],
        this->Keys.Positions[k + 1], this->Centers[k + 1], this->Weights);
    Points turns(components, 3);
    for (int c = 0; c < components; ++c)
    {
      turns.row(c) = VectorFromRotation(rotations[c]).transpose();
    }
    this->Turns.push_back(std::move(turns));
  }
}

Eigen::VectorXd RigidPlacement::ComponentParameters(const MorphPlace& place) const
{
  const TriangleMesh& mesh = *this->Keys.Mesh;
  if (!place.IsLocal())
  {
    return Eigen::VectorXd::Constant(mesh.NumberOfComponents(), place.GetParameter());
  }
  Eigen::VectorXd parameters = Eigen::VectorXd::Zero(mesh.NumberOfComponents());
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v))
    {
      parameters[mesh.Component(v)] += this->Weights[v] * place.GetParameters()[v];
    }
  }
  return parameters;
}

void RigidPlacement::Place(const MorphPlace& place, Points& positions) const
{
  const TriangleMesh& mesh = *this->Keys.Mesh;
  const Eigen::VectorXd parameters = this->ComponentParameters(place);
  const Points own = ComponentCenters(mesh, positions, this->Weights);
  // To the key frames that are needed, once each.
  std::vector<std::vector<Eigen::Matrix3d>> all(this->Keys.Positions.size());
  const auto rotationsTo = [&](std::size_t key) -> const std::vector<Eigen::Matrix3d>&
  {
    if (all[key].empty())
    {
      all[key] = FitComponentRotations(
        mesh, positions, own, this->Keys.Positions[key], this->Centers[key], this->Weights);
    }
    return all[key];
  };
  const int components = mesh.NumberOfComponents();
  std::vector<Eigen::Matrix3d> rotations(components);
  for (int c = 0; c < components; ++c)
  {
    if (place.IsBlend())
    {
      std::vector<Eigen::Matrix3d> toKeys;
      for (std::size_t key = 0; key < all.size(); ++key)
      {
        toKeys.push_back(rotationsTo(key)[c]);
      }
      rotations[c] = MeanRotation(toKeys, place.GetWeights());
      continue;
    }
    const auto [k, part] = PlaceBetweenKeys(parameters[c], this->Keys.Parameters);
    const Eigen::Matrix3d& before = rotationsTo(k)[c];
    const Eigen::Vector3d guess = this->Turns[k].row(c);
    const Eigen::Vector3d turn =
      VectorFromRotation(rotationsTo(k + 1)[c] * before.transpose(), guess);
    rotations[c] = RotationFromVector(part * turn) * before;
  }
  const Eigen::VectorXd centers = place.IsBlend() ? this->CenterPaths.Blend(place.GetWeights())
                                                  : this->CenterPaths.EvaluateEach(parameters);
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
