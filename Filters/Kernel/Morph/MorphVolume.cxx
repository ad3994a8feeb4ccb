// SPDX-License-Identifier: BSD-3-Clause
#include "Morph/MorphVolume.h"

#include "Differential/Laplacian.h"
#include "Measure/Measures.h"
#include "Measure/VolumePreservation.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
MorphVolume::MorphVolume(const KeyFrames& keys, const ExecutionContext& context)
  : Mesh(keys.Mesh)
  , TakesPart(keys.Mesh->NumberOfComponents(), 1)
{
  const TriangleMesh& mesh = *this->Mesh;
  Field volumes(mesh.NumberOfComponents(), keys.Positions.size());
  for (Eigen::Index k = 0; k < volumes.cols(); ++k)
  {
    const std::vector<ComponentVolume> components = MeasureComponents(mesh, keys.Positions[k]);
    for (std::size_t c = 0; c < components.size(); ++c)
    {
      volumes(static_cast<Eigen::Index>(c), k) = components[c].Volume;
      this->TakesPart[c] =
        this->TakesPart[c] && components[c].IsClosed && components[c].Volume > 0.0;
    }
  }
  this->Volumes = KeyInterpolation(keys.Parameters, std::move(volumes));
  IdSample left;
  for (std::size_t c = 0; c < this->TakesPart.size(); ++c)
  {
    if (!this->TakesPart[c])
    {
      left.Add(static_cast<long long>(c));
    }
  }
  if (!left.IsEmpty())
  {
    this->Warning = "The volume of " + left.Describe("component", "components") +
      " is not closed, because it is open or inside out in a key frame: close its holes, or "
      "orient it with the Surface Normals filter.";
  }
  this->Laplacian.Factorize(
    cartan::Laplacian(mesh, Eigen::VectorXd::Ones(mesh.NumberOfDirectedEdges())), mesh.Grounded(),
    {}, {}, context);
}

std::string MorphVolume::Close(double t, Points& positions) const
{
  const TriangleMesh& mesh = *this->Mesh;
  const Eigen::VectorXd interpolated = this->Volumes.Evaluate(t);
  const std::vector<double> volumes(interpolated.data(), interpolated.data() + interpolated.size());
  Field solution = Field::Zero(mesh.NumberOfVertices(), 3);
  this->Laplacian.Solve(VolumeGradient(mesh, positions), solution);
  const Points direction = solution;
  const std::vector<double> steps =
    VolumeClosingSteps(mesh, positions, direction, this->TakesPart, volumes);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v))
    {
      positions.row(v) += steps[mesh.Component(v)] * direction.row(v);
    }
  }
  IdSample notClosed;
  const std::vector<ComponentVolume> components = MeasureComponents(mesh, positions);
  for (std::size_t c = 0; c < steps.size(); ++c)
  {
    if (this->TakesPart[c] &&
      !(std::abs(components[c].Volume - volumes[c]) <= 1e-9 * std::abs(volumes[c])))
    {
      notClosed.Add(static_cast<long long>(c));
    }
  }
  return notClosed.IsEmpty() ? std::string()
                             : "The volume of " + notClosed.Describe("component", "components") +
      " at the parameter " + std::to_string(t) + " could not be closed on those of the key frames.";
}
}
