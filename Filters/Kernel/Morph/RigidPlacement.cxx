// SPDX-License-Identifier: BSD-3-Clause
#include "Morph/RigidPlacement.h"

#include "Algebra/Rotation.h"
#include "Differential/RotationFit.h"
#include "Measure/Areas.h"
#include "Measure/ComponentVolumes.h"

#include <Eigen/SVD>

namespace cartan
{
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

void RigidPlacement::Place(double t, Points& positions) const
{
  const TriangleMesh& mesh = *this->Keys.Mesh;
  const auto [k, part] = PlaceBetweenKeys(t, this->Keys.Parameters);

  const Points own = ComponentCenters(mesh, positions, this->Weights);
  const auto rotationsTo = [&](int key)
  {
    return FitComponentRotations(
      mesh, positions, own, this->Keys.Positions[key], this->Centers[key], this->Weights);
  };
  std::vector<Eigen::Matrix3d> rotations = rotationsTo(k);
  const std::vector<Eigen::Matrix3d> toAfter = rotationsTo(k + 1);
  for (std::size_t c = 0; c < rotations.size(); ++c)
  {
    const Eigen::Vector3d guess = this->Turns[k].row(static_cast<Eigen::Index>(c));
    const Eigen::Vector3d turn = VectorFromRotation(toAfter[c] * rotations[c].transpose(), guess);
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
