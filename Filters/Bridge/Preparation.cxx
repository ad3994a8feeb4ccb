// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/Preparation.h"

#include "Bridge/PointArrays.h"
#include "Kernel/Algebra/Rotation.h"

namespace cartan
{
std::size_t Preparation::GetBytes() const
{
  return this->Method.Deformer->GetBytes() +
    TotalBytes(this->Problem.Handle, this->Problem.SoftWeights, this->Result.Positions,
      this->Result.Transforms, this->Result.FrameScale) +
    (this->Moved ? this->Moved->GetBytes() + TotalBytes(*this->Moved->Problem.Rest) : 0);
}

void DeformAndCheck(Preparation& prepared, const HandleTargets& targets,
  const ComparedFields& fields, FilterRun& run, const ExecutionContext& context)
{
  SurfaceDeformer& deformer = *prepared.Method.Deformer;
  const double part = prepared.Moved ? 0.5 : 1.0;
  deformer.Deform(targets, fields.Transforms, prepared.Result, context.Part(0.0, part));
  run.Warn(deformer.GetWarning());
  if (prepared.Moved)
  {
    Preparation& moved = *prepared.Moved;
    moved.Method.Configure(run);
    moved.Method.Deformer->Deform(
      targets, fields.Transforms, moved.Result, context.Part(part, 1.0));
    run.Warn(CompareResults(prepared.Problem, prepared.Result, moved.Result, fields).Describe());
  }
}

void AddTransformArrays(
  const DeformedSurface& result, bool frameChange, bool rotationVector, vtkPolyData* output)
{
  const Eigen::Index size = result.Transforms.rows();
  if (frameChange)
  {
    Eigen::VectorXd change(size);
    for (Eigen::Index v = 0; v < size; ++v)
    {
      change[v] = (MatrixAt(result.Transforms, v) - Eigen::Matrix3d::Identity()).norm();
    }
    AddPointArray(output, "FrameChange", change);
  }
  if (rotationVector)
  {
    Points vectors(size, 3);
    for (Eigen::Index v = 0; v < size; ++v)
    {
      vectors.row(v) =
        VectorFromRotation(ProjectOnRotations(MatrixAt(result.Transforms, v))).transpose();
    }
    AddPointArray(output, "RotationVector", vectors);
  }
}
}
