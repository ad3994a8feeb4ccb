// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/Preparation.h"

namespace cartan
{
namespace
{
bool HaveSameTriangles(const TriangleMesh& a, const TriangleMesh& b)
{
  return a.NumberOfTriangles() == b.NumberOfTriangles() && a.GetTriangles() == b.GetTriangles();
}
}

std::size_t Preparation::GetBytes() const
{
  return this->Method.Deformer->GetBytes() +
    TotalBytes(this->Problem.Handle, this->Problem.SoftWeights, this->Result.Positions,
      this->Result.Transforms, this->Result.FrameScale) +
    (this->Moved ? this->Moved->GetBytes() + TotalBytes(*this->Moved->Problem.Rest) : 0);
}

void Configure(Preparation& prepared, FilterRun& run, const ExecutionContext& context)
{
  prepared.Method.Configure(run, context.Part(0.0, prepared.Moved ? 0.5 : 1.0));
  if (prepared.Moved)
  {
    prepared.Moved->Method.Configure(run, context.Part(0.5, 1.0));
  }
}

void DeformAndCheck(Preparation& prepared, const HandleTargets& targets,
  const ComparedFields& fields, FilterRun& run, const ExecutionContext& context)
{
  SurfaceDeformer& deformer = *prepared.Method.Deformer;
  const double part = prepared.Moved ? 0.5 : 1.0;
  deformer.Deform(targets, fields.Transforms, prepared.Result, context.Part(0.0, part));
  run.Warn(deformer.GetWarning());
  run.Warn(DescribeLostDigits(prepared.Problem, prepared.Result));
  if (prepared.Moved)
  {
    Preparation& moved = *prepared.Moved;
    moved.Method.Deformer->Deform(
      targets, fields.Transforms, moved.Result, context.Part(part, 1.0));
    RoundingDifference difference =
      CompareResults(prepared.Problem, prepared.Result, moved.Result, fields);
    difference.IsOfSlivers = !HaveSameTriangles(*prepared.Problem.Mesh, *moved.Problem.Mesh);
    run.Warn(difference.Describe());
  }
}
}
