// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/PoissonDeformer.h"

#include "Deformation/MotionBlend.h"
#include "Mesh/GeodesicDistance.h"

#include <cmath>

namespace cartan
{
namespace
{
Field GeodesicWeights(
  const HandleProblem& problem, const HandleLaplacian& frames, const ExecutionContext& context)
{
  const TriangleMesh& mesh = *problem.Mesh;
  const std::vector<int> moving = MovingHandleOfVertices(problem);
  const int numberOfMoving = static_cast<int>(problem.Moving.size());
  // The pinned ones first, then each moving handle.
  std::vector<std::vector<int>> sources(numberOfMoving + 1);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (problem.Handle[v] > 0 && mesh.IsUsed(v))
    {
      sources[moving[v] + 1].push_back(v);
    }
  }
  Field distances(frames.NumberOfLocals(), numberOfMoving + 1);
  for (int k = 0; k <= numberOfMoving; ++k)
  {
    const Eigen::VectorXd distance = GeodesicDistance(mesh, *problem.Rest, sources[k]);
    for (int i = 0; i < frames.NumberOfLocals(); ++i)
    {
      distances(i, k) = distance[frames.Vertex(i)];
    }
    context.Report(static_cast<double>(k) / (numberOfMoving + 1));
  }
  Field weights = Field::Zero(frames.NumberOfLocals(), numberOfMoving);
  for (int i = 0; i < frames.NumberOfLocals(); ++i)
  {
    Eigen::Index nearest = 0;
    if (distances.row(i).minCoeff(&nearest) == 0.0)
    {
      if (nearest > 0)
      {
        weights(i, nearest - 1) = 1.0;
      }
      continue;
    }
    // An infinite distance has no influence.
    const double sum = distances.row(i).cwiseInverse().sum();
    for (int k = 0; k < numberOfMoving; ++k)
    {
      weights(i, k) = 1.0 / (distances(i, k + 1) * sum);
    }
  }
  return weights;
}
}

PoissonDeformer::PoissonDeformer(HandleProblem problem, Propagation propagation,
  SolverBackend backend, const ExecutionContext& context)
  : FrameDeformer(std::move(problem), backend, context.Part(0.0, 0.6))
{
  if (propagation == Propagation::Harmonic)
  {
    this->Harmonic.emplace(this->Problem, this->FrameSystem);
  }
  else
  {
    this->Geodesic = GeodesicWeights(this->Problem, *this->FrameSystem, context.Part(0.6, 1.0));
  }
  for (const HandleLaplacian::Triangle& triangle : this->PositionSystem->Triangles(this->Problem))
  {
    this->TriangleIds.push_back(triangle.Id);
  }
  this->TriangleTransforms.resize(static_cast<Eigen::Index>(this->TriangleIds.size()), 9);
  context.Report(1.0);
}

void PoissonDeformer::RequireMotions(const HandleTargets& targets)
{
  cartan::RequireMotions(targets, "Poisson editing");
}

void PoissonDeformer::ComputeTransforms(
  const HandleTargets& targets, const ExecutionContext& context)
{
  RequireMotions(targets);
  const Field ofHandles = MotionBlend(targets.Motions).Coordinates();
  const HandleLaplacian& frames = *this->FrameSystem;
  const Field ofLocals =
    this->Harmonic ? this->Harmonic->Blend(ofHandles, context) : Field(this->Geodesic * ofHandles);
  Field blends = Field::Zero(this->Problem.Mesh->NumberOfVertices(), ofHandles.cols());
  for (const HandleVertex& held : this->HandleVertices)
  {
    blends.row(held.Vertex) = ofHandles.row(held.Handle);
  }
  for (int i = 0; i < frames.NumberOfLocals(); ++i)
  {
    blends.row(frames.Vertex(i)) = ofLocals.row(i);
  }
  context.For(static_cast<int>(this->TriangleIds.size()),
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        const auto corners = this->Problem.Mesh->GetTriangles().row(this->TriangleIds[i]);
        MatrixAt(this->TriangleTransforms, i) = MotionBlend::FromCoordinates(
          (blends.row(corners[0]) + blends.row(corners[1]) + blends.row(corners[2])) / 3.0);
      }
    });
  if (!this->NeedsVertices)
  {
    return;
  }
  for (const HandleVertex& held : this->HandleVertices)
  {
    MatrixAt(this->Transforms, held.Vertex) = targets.Motions[held.Handle].Linear;
  }
  context.For(frames.NumberOfUnknowns(),
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        const int v = frames.Vertex(i);
        MatrixAt(this->Transforms, v) = MotionBlend::FromCoordinates(blends.row(v));
      }
    });
}
}
