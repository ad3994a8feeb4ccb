// SPDX-License-Identifier: BSD-3-Clause
// What frame-based deformations do to keep volumes.
#include "Deformation/FrameDeformer.h"
#include "Deformation/JoinedVertices.h"
#include "Measure/VolumeClosing.h"

#include <cmath>

namespace cartan
{
void FrameDeformer::SetVolumeModel(std::shared_ptr<const VolumeModel> model)
{
  if (model == this->Model)
  {
    return;
  }
  this->Model = std::move(model);
  this->RestHeights.resize(0);
  this->JoinedOffsets.resize(0, 3);
  this->MadeWithOffsets = nullptr;
  if (this->Model && !this->Problem.JoinedWith.empty())
  {
    // Each of the bodies that hang together has a middle of its own.
    this->JoinedOffsets = this->Model->Offsets;
    MeetHalfway(this->Problem.JoinedWith, this->JoinedOffsets);
  }
}

void FrameDeformer::ScaleFrames(
  const HandleTargets& targets, DeformedSurface& result, const ExecutionContext& context)
{
  const TriangleMesh& mesh = *this->Problem.GetParted();
  FollowJoined(this->Problem.JoinedWith, result.Positions);
  if (this->RestHeights.size() == 0)
  {
    this->RestHeights = ColumnHeights(mesh, *this->Problem.Rest, this->Model->LocalDepth, context);
  }
  // The depth of the surface at rest serves the deformed one too.
  const Eigen::VectorXd heights =
    ColumnHeights(mesh, result.Positions, this->Model->LocalDepth, context);
  Eigen::VectorXd scales = Eigen::VectorXd::Ones(mesh.NumberOfVertices());
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const bool isMeasured = mesh.IsUsed(v) && this->Model->EnclosesVolume[mesh.Component(v)] &&
      this->Model->IsMeasured[v];
    const double ratio = isMeasured ? this->RestHeights[v] / heights[v] : 1.0;
    scales[v] = std::isfinite(ratio) && ratio > 0.0 ? std::sqrt(ratio) : 1.0;
  }
  MeetHalfway(this->Problem.JoinedWith, scales);
  Matrices scaled = this->Transforms;
  for (int i = 0; i < this->PositionSystem->NumberOfLocals(); ++i)
  {
    const int v = this->PositionSystem->Vertex(i);
    result.FrameScale[v] = scales[v];
    scaled.row(v) *= scales[v];
  }
  this->SolvePositions(targets, scaled, result, context);
}

void FrameDeformer::CloseVolumes(Points& positions)
{
  const HandleLaplacian& system = *this->PositionSystem;
  const std::vector<int>& joinedWith = this->Problem.JoinedWith;
  const auto solve = [&system, &joinedWith](Points gradient)
  {
    for (std::size_t v = 0; v < joinedWith.size(); ++v)
    {
      if (joinedWith[v] != static_cast<int>(v))
      {
        gradient.row(joinedWith[v]) += gradient.row(static_cast<Eigen::Index>(v));
      }
    }
    Eigen::MatrixXd rightHandSide(system.NumberOfUnknowns(), 3);
    for (int i = 0; i < system.NumberOfUnknowns(); ++i)
    {
      rightHandSide.row(i) = gradient.row(system.Vertex(i));
    }
    const Eigen::Map<const Eigen::MatrixXd> solution = system.Solve(rightHandSide);
    Points direction = Points::Zero(gradient.rows(), 3);
    for (int i = 0; i < system.NumberOfUnknowns(); ++i)
    {
      direction.row(system.Vertex(i)) = solution.row(i);
    }
    FollowJoined(joinedWith, direction);
    return direction;
  };
  // Bodies that hang together are closed each by a step of its own, after which joined
  // vertices meet between them: each round leaves less.
  const int rounds = joinedWith.empty() ? 1 : 20;
  IdSample notClosed;
  FollowJoined(joinedWith, positions);
  for (int round = 0; round < rounds; ++round)
  {
    notClosed = cartan::CloseVolumes(*this->Problem.GetParted(), this->Model->EnclosesVolume,
      this->Model->Volumes, solve, positions);
    MeetHalfway(joinedWith, positions);
  }
  if (!notClosed.IsEmpty())
  {
    this->Warning += (this->Warning.empty() ? "" : " ");
    this->Warning += "The volume of " +
      notClosed.Renamed(this->Model->Names).Describe("component", "components") +
      " could not be closed: no displacement of its free points along the volume's gradient "
      "gives it back. Leave more points free, or deform less.";
  }
}
}
