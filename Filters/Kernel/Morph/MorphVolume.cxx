// SPDX-License-Identifier: BSD-3-Clause
#include "Morph/MorphVolume.h"

#include "Differential/Laplacian.h"
#include "Measure/Areas.h"
#include "Measure/ComponentVolumes.h"
#include "Measure/VolumeClosing.h"

#include <utility>

namespace cartan
{
MorphVolume::MorphVolume(const KeyFrames& keys, const ExecutionContext& context)
  : Mesh(keys.Mesh)
  , TakesPart(keys.Mesh->NumberOfComponents(), 1)
{
  const TriangleMesh& mesh = *this->Mesh;
  Field volumes(mesh.NumberOfComponents(), keys.Positions.size());
  std::vector<char> isClosed(mesh.NumberOfComponents(), 0);
  for (Eigen::Index k = 0; k < volumes.cols(); ++k)
  {
    const std::vector<ComponentVolume> components = MeasureComponents(mesh, keys.Positions[k]);
    for (std::size_t c = 0; c < components.size(); ++c)
    {
      const auto row = static_cast<Eigen::Index>(c);
      isClosed[c] = components[c].IsClosed;
      volumes(row, k) = components[c].Volume;
      this->TakesPart[c] = this->TakesPart[c] && components[c].EnclosesVolume() &&
        volumes(row, k) * volumes(row, 0) > 0.0;
    }
  }
  this->Volumes = KeyInterpolation(keys.Parameters, std::move(volumes));
  // Being open is the same in all key frames, since that is connectivity.
  IdSample open;
  IdSample left;
  for (std::size_t c = 0; c < this->TakesPart.size(); ++c)
  {
    if (!this->TakesPart[c])
    {
      (isClosed[c] ? left : open).Add(static_cast<long long>(c));
    }
  }
  if (!open.IsEmpty())
  {
    this->Warning = "The volume of " + open.Describe("open component", "open components") +
      " is not adjusted: fill the holes before the surface is deformed to the key frames (Prepare "
      "Surface, Maximum Hole Edges).";
  }
  if (!left.IsEmpty())
  {
    this->Warning += (this->Warning.empty() ? "" : " ");
    this->Warning += "The volume of " + left.Describe("component", "components") +
      " is not adjusted, because in a key frame it encloses nothing or is turned inside out "
      "against the first one.";
  }
  this->Laplacian.Factorize(
    cartan::Laplacian(mesh, Eigen::VectorXd::Ones(mesh.NumberOfDirectedEdges())),
    Anchors::Hard(mesh.Grounded()), context);
}

std::string MorphVolume::Close(double t, Points& positions) const
{
  const TriangleMesh& mesh = *this->Mesh;
  const Eigen::VectorXd interpolated = this->Volumes.Evaluate(t);
  const std::vector<double> volumes(interpolated.data(), interpolated.data() + interpolated.size());
  const Eigen::VectorXd areas = BarycentricAreas(mesh, TriangleAreas(mesh, positions));
  const auto solve = [&](const Points& gradient)
  {
    Field solution = Field::Zero(gradient.rows(), 3);
    this->Laplacian.Solve(gradient, solution);
    // The grounded vertex, the first of its component, must not decide where the
    // component goes: its center stays.
    Points direction = solution;
    const Points centers = ComponentCenters(mesh, direction, areas);
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      if (mesh.IsUsed(v) && this->TakesPart[mesh.Component(v)])
      {
        direction.row(v) -= centers.row(mesh.Component(v));
      }
    }
    return direction;
  };
  const IdSample notClosed = CloseVolumes(mesh, this->TakesPart, volumes, solve, positions);
  return notClosed.IsEmpty() ? std::string()
                             : "The volume of " + notClosed.Describe("component", "components") +
      " at the parameter " + std::to_string(t) + " could not be set to the interpolated volume.";
}
}
