// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/Preparation.h"

#include "Bridge/SurfaceWriter.h"

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

namespace
{
/// Whether the surface is written: else its positions are in Result.
bool DeformIntoOutput(Preparation& prepared, const HandleTargets& targets, const Surface& surface,
  FilterRun& run, const ExecutionContext& context)
{
  DeformedSurface& result = prepared.Result;
  const PositionRows rows = prepared.Method.Deformer->DeformInRows(targets, result, context);
  run.Warn(prepared.Method.Deformer->GetWarning());
  if (!rows ||
    WriteSurfaceRows(
      surface, rows, ShortMotion(prepared.Problem), run.Input(), run.Output(), run.Context()))
  {
    return static_cast<bool>(rows);
  }
  // What is odd about them is found as for others.
  const int count = surface.Mesh->NumberOfVertices();
  result.Positions.resize(count, 3);
  result.FrameScale.setOnes(count);
  rows(0, count, result.Positions.data());
  return false;
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
    moved.Method.Deformer->Deform(
      WithMovedTargets(targets), fields.Transforms, moved.Result, context.Part(part, 1.0));
    RoundingDifference difference =
      CompareResults(prepared.Problem, prepared.Result, moved.Result, fields);
    difference.IsOfSlivers = !HaveSameTriangles(*prepared.Problem.Mesh, *moved.Problem.Mesh);
    run.Warn(difference.Describe());
  }
}
}

void DeformAndWrite(Preparation& prepared, const HandleTargets& targets,
  const ComparedFields& fields, bool keepsPositions, const Surface& surface, FilterRun& run,
  const ExecutionContext& context)
{
  const bool isAlone = !keepsPositions && !fields.Transforms && !fields.Normals && !prepared.Moved;
  if (isAlone && DeformIntoOutput(prepared, targets, surface, run, context))
  {
    return;
  }
  if (!isAlone)
  {
    DeformAndCheck(prepared, targets, fields, run, context);
  }
  run.WarnHere(DescribeLostDigits(prepared.Problem, prepared.Result));
  run.WarnHere(
    WriteSurface(surface, prepared.Result.Positions, run.Input(), run.Output(), run.Context()));
}
}
