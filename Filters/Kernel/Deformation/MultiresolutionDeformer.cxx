// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/MultiresolutionDeformer.h"

#include "Algebra/Rotation.h"
#include "Differential/RotationFit.h"

namespace cartan
{
namespace
{
/// The unit normal of one vertex, as VertexNormals has it.
Eigen::Vector3d RingNormal(const TriangleMesh& mesh, const Points& points, int v)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double size = 0.0;
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    if (mesh.LeftTriangle(d) >= 0)
    {
      const Eigen::Vector3d edge = points.row(mesh.Neighbor(d)) - points.row(v);
      const Eigen::Vector3d next = points.row(mesh.Opposite(d)) - points.row(v);
      sum += edge.cross(next);
      size += edge.cross(next).norm();
    }
  }
  return sum.norm() > 1e-12 * size ? Eigen::Vector3d(sum.normalized())
                                   : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

/// What FitRotations has at one vertex, at no cost for the others.
Eigen::Matrix3d FitRotation(
  const TriangleMesh& mesh, const Points& reference, const Points& current, int v)
{
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double size = 0.0;
  for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
  {
    const Eigen::RowVector3d before = reference.row(mesh.Neighbor(d)) - reference.row(v);
    const Eigen::RowVector3d after = current.row(mesh.Neighbor(d)) - current.row(v);
    covariance += after.transpose() * before;
    size += before.norm() * after.norm();
  }
  // The edges of a flat ring leave the rotation to rounding; the normal settles it.
  covariance += size * RingNormal(mesh, current, v) * RingNormal(mesh, reference, v).transpose();
  return size > 0.0 ? ProjectOnRotations(covariance / size)
                    : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}
}

MultiresolutionDeformer::MultiresolutionDeformer(
  HandleProblem problem, int order, SolverBackend backend, const ExecutionContext& context)
  : SurfaceDeformer(RequirePositions(std::move(problem), "Multiresolution editing"))
  , System(this->Problem, order, backend, context.Part(0.0, 0.9))
  , MovingHandles(MovingHandleOfVertices(this->Problem))
  , Zero(Points::Zero(this->System.NumberOfLocals(), 3))
  , RestBase(*this->Problem.Rest)
{
  this->System.Solve(this->Zero, this->RestBase);
  context.Report(1.0);
}

void MultiresolutionDeformer::Deform(const HandleTargets& targets, bool wantTransforms,
  DeformedSurface& result, const ExecutionContext& context)
{
  const Points& rest = *this->Problem.Rest;
  result.Positions = HandlePositions(this->Problem, targets, this->MovingHandles);
  result.FrameScale.setOnes(rest.rows());
  this->System.Solve(this->Zero, result.Positions);
  context.Report(0.5);
  if (wantTransforms)
  {
    result.Transforms =
      FitRotations(*this->Problem.Mesh, this->RestBase, result.Positions, context);
  }
  // The base's local frame turns as its one-ring and normal do.
  const std::vector<int>& vertices = this->System.GetVertices();
  const int numberOfUnknowns = this->System.NumberOfUnknowns();
  this->Rotations.resize(numberOfUnknowns, 9);
  context.For(numberOfUnknowns,
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        MatrixAt(this->Rotations, i) =
          FitRotation(*this->Problem.Mesh, this->RestBase, result.Positions, vertices[i]);
      }
    });
  context.For(numberOfUnknowns,
    [&](int begin, int end)
    {
      for (int i = begin; i < end; ++i)
      {
        const int v = vertices[i];
        const Eigen::Vector3d detail = (rest.row(v) - this->RestBase.row(v)).transpose();
        result.Positions.row(v) += (MatrixAt(this->Rotations, i) * detail).transpose();
      }
    });
  context.Report(1.0);
}
}
