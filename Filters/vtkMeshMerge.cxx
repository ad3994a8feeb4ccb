// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshMerge.h"

#include "Bridge/CorrespondenceWriter.h"
#include "Bridge/FilterRun.h"
#include "Bridge/HandleArrays.h"
#include "Bridge/MergedSurfaceWriter.h"
#include "Bridge/MotionTable.h"
#include "Bridge/PointArrays.h"
#include "Bridge/PointKeys.h"
#include "Kernel/Base/Constants.h"
#include "Kernel/Merging/LoopPairing.h"
#include "Kernel/Merging/SeamFairing.h"
#include "Kernel/Merging/Transition.h"
#include "Kernel/Mesh/GeodesicDistance.h"
#include "Kernel/Mesh/GrowByRings.h"
#include "vtkHandleMotion.h"

#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>

vtkStandardNewMacro(vtkMeshMerge);

using cartan::Error;
using cartan::ErrorCode;

class vtkMeshMerge::Internals
{
public:
  cartan::MotionTable Motions;
};

/// What holds the source's points.
struct vtkMeshMerge::Holds
{
  std::vector<cartan::SourceHold> Of; ///< empty or #V
  cartan::HandleTargets Moved;        ///< of those that are Moved
};

/// Both inputs as the kernel sees them.
struct vtkMeshMerge::Sides
{
  vtkPolyData* TargetData;
  vtkPolyData* SourceData;
  std::shared_ptr<const cartan::Surface> TargetSurface;
  std::shared_ptr<const cartan::Surface> SourceSurface;
  cartan::MergeBoundary Target;
  cartan::MergeBoundary Source;
  Eigen::Vector3d SourceOffset; ///< from the source's coordinates to the world's
};

/// The surface that they make.
struct vtkMeshMerge::Sewn
{
  cartan::FittedSource Fit;
  cartan::JoinedSurface Joined;
  cartan::TriangleMesh Mesh;
  cartan::Points Positions;                           ///< from the target's origin
  cartan::Fading Fading;                              ///< empty without a transition
  std::shared_ptr<const cartan::Points> TargetPoints; ///< with those where it was cut
};

namespace
{
/// `key` with the loops of one side.
cartan::ContentKey WithLoops(cartan::ContentKey key, const std::vector<cartan::LoopPair>& pairs,
  std::vector<int> cartan::LoopPair::*side)
{
  for (const cartan::LoopPair& pair : pairs)
  {
    const std::vector<int>& loop = pair.*side;
    key.Add(static_cast<std::uint64_t>(loop.size()));
    key.AddBytes(loop.data(), loop.size() * sizeof(int));
  }
  return key;
}
}

vtkMeshMerge::vtkMeshMerge()
  : State(std::make_unique<Internals>())
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
}

vtkMeshMerge::~vtkMeshMerge() = default;

void vtkMeshMerge::SetSourceData(vtkPolyData* source)
{
  this->SetInputData(1, source);
}

vtkPolyData* vtkMeshMerge::GetCorrespondences()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(1));
}

void vtkMeshMerge::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Configuration: " << this->Configuration << "\n";
  os << indent << "BendWidth: " << this->BendWidth << "\n";
  os << indent << "TransitionWidth: " << this->TransitionWidth << "\n";
  os << indent << "SourceTransitionWidth: " << this->SourceTransitionWidth << "\n";
  os << indent << "SeamFairing: " << this->SeamFairing << "\n";
  os << indent << "FairingMethod: " << this->FairingMethod << "\n";
  os << indent << "BoundaryKeyArrayName: " << this->BoundaryKeyArrayName << "\n";
  os << indent << "HandleArrayName: " << this->HandleArrayName << "\n";
  os << indent << "FeatureArrayName: " << this->FeatureArrayName << "\n";
  os << indent << "Motions: " << this->State->Motions.ById.size() << "\n";
  os << indent << "MotionRows: " << this->State->Motions.Rows.size() << "\n";
  os << indent << "NumberOfPairs: " << this->NumberOfPairs << "\n";
  os << indent << "SeamAngleMean: " << this->SeamAngleMean << "\n";
  os << indent << "SeamAngleMaximum: " << this->SeamAngleMaximum << "\n";
  os << indent << "NumberOfFactorizations: " << this->NumberOfFactorizations << "\n";
}

void vtkMeshMerge::SetHandleMotion(int id, vtkHandleMotion* motion)
{
  if (id < 1)
  {
    vtkErrorMacro("Handle ids are >= 1; got " << id << ".");
    return;
  }
  auto& motions = this->State->Motions.ById;
  if (this->GetHandleMotion(id) != motion)
  {
    motion ? void(motions[id] = motion) : void(motions.erase(id));
    this->Modified();
  }
}

vtkHandleMotion* vtkMeshMerge::GetHandleMotion(int id) const
{
  const auto found = this->State->Motions.ById.find(id);
  return found == this->State->Motions.ById.end() ? nullptr : found->second.Get();
}

void vtkMeshMerge::RemoveAllHandleMotions()
{
  if (!this->State->Motions.ById.empty())
  {
    this->State->Motions.ById.clear();
    this->Modified();
  }
}

void vtkMeshMerge::SetNumberOfMotionRows(int count)
{
  if (count < 0 || count > cartan::MotionTable::MaximumNumberOfRows)
  {
    vtkErrorMacro("The motions' table has 0 to " << cartan::MotionTable::MaximumNumberOfRows
                                                 << " rows; got " << count << ".");
    return;
  }
  if (count != this->GetNumberOfMotionRows())
  {
    this->State->Motions.ResizeRows(count);
    this->Modified();
  }
}

int vtkMeshMerge::GetNumberOfMotionRows() const
{
  return static_cast<int>(this->State->Motions.Rows.size());
}

void vtkMeshMerge::SetMotionRow(int row, double id, double scaleX, double scaleY, double scaleZ,
  double angle, double axisX, double axisY, double axisZ, double centerX, double centerY,
  double centerZ, double translationX, double translationY, double translationZ)
{
  if (row < 0 || row >= cartan::MotionTable::MaximumNumberOfRows)
  {
    vtkErrorMacro("Rows are numbered from 0 to " << cartan::MotionTable::MaximumNumberOfRows - 1
                                                 << "; got " << row << ".");
    return;
  }
  this->SetNumberOfMotionRows(std::max(row + 1, this->GetNumberOfMotionRows()));
  cartan::MotionTable::Row& target = this->State->Motions.Rows[row];
  if (target.Id != id)
  {
    target.Id = id;
    this->Modified();
  }
  target.SetMotion(angle, { scaleX, scaleY, scaleZ }, { axisX, axisY, axisZ },
    { centerX, centerY, centerZ }, { translationX, translationY, translationZ });
}

vtkMTimeType vtkMeshMerge::GetMTime()
{
  return std::max(this->Superclass::GetMTime(), this->State->Motions.GetMTime());
}

void vtkMeshMerge::ForgetResults()
{
  this->NumberOfPairs = this->NumberOfFactorizations = 0;
  this->SeamAngleMean = this->SeamAngleMaximum = 0.0;
}

vtkMeshMerge::Sides vtkMeshMerge::ReadSides(cartan::FilterRun& run) const
{
  Sides sides{ run.Input(0), run.Input(1), run.ReadSurface(0, "target"),
    run.ReadSurface(1, "source"), {}, {}, Eigen::Vector3d::Zero() };
  sides.Target = { { sides.TargetSurface->Mesh, sides.TargetSurface->Positions }, "target",
    cartan::ReadKeys(sides.TargetData, *sides.TargetSurface->Mesh, this->BoundaryKeyArrayName) };
  sides.Source = { { sides.SourceSurface->Mesh, sides.SourceSurface->Positions }, "source",
    cartan::ReadKeys(sides.SourceData, *sides.SourceSurface->Mesh, this->BoundaryKeyArrayName) };
  sides.SourceOffset = sides.SourceSurface->Origin;
  if (this->Configuration == DEPENDENT)
  {
    // Both in the target's coordinates.
    const Eigen::Vector3d shift = sides.SourceSurface->Origin - sides.TargetSurface->Origin;
    sides.Source.Surface.Positions = std::make_shared<cartan::Points>(
      sides.SourceSurface->Positions->rowwise() + shift.transpose());
    sides.SourceOffset = sides.TargetSurface->Origin;
  }
  return sides;
}

void vtkMeshMerge::HoldHandles(const Sides& sides, Holds& holds) const
{
  const cartan::MotionsById motions = this->State->Motions.Collect(0);
  if (!sides.SourceData->GetPointData()->GetArray(this->HandleArrayName.c_str()) && motions.empty())
  {
    return;
  }
  const cartan::Handles handles =
    cartan::ReadHandles(sides.SourceData, *sides.SourceSurface->Mesh, this->HandleArrayName);
  cartan::RequireMeaningfulMotions(motions, handles);
  for (const int v : handles.Points)
  {
    holds.Of[v] =
      motions.count(handles.OfVertex[v]) ? cartan::SourceHold::Moved : cartan::SourceHold::Kept;
  }
  std::vector<int> moving;
  for (const auto& entry : motions)
  {
    moving.push_back(entry.first);
  }
  cartan::Surface source = *sides.SourceSurface;
  source.Positions = sides.Source.Surface.Positions;
  source.Origin = sides.SourceOffset;
  holds.Moved = cartan::MotionTargets(*source.Positions, handles.OfVertex, moving,
    cartan::MakeTargets(source, moving, motions, handles, {}).Motions);
}

vtkMeshMerge::Holds vtkMeshMerge::FindHolds(
  const Sides& sides, const std::vector<cartan::LoopPair>& pairs, cartan::FilterRun& run) const
{
  Holds holds;
  const cartan::TriangleMesh& mesh = *sides.Source.Surface.Mesh;
  if (this->Configuration == INDEPENDENT)
  {
    if (!this->State->Motions.Collect(0).empty())
    {
      throw Error(ErrorCode::BadInput,
        "Handles have motions, but the source's place does not count: choose DEPENDENT, or remove "
        "the motions.");
    }
    return holds;
  }
  holds.Of.resize(mesh.NumberOfVertices());
  this->HoldHandles(sides, holds);
  if (this->BendWidth > 0.0)
  {
    std::vector<int> seam;
    for (const cartan::LoopPair& pair : pairs)
    {
      seam.insert(seam.end(), pair.Source.begin(), pair.Source.end());
    }
    const Eigen::VectorXd distances = cartan::GeodesicDistance(
      mesh, *sides.Source.Surface.Positions, seam, this->BendWidth, run.Context().Part(0.2, 0.25));
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      if (mesh.IsUsed(v) && !(distances[v] <= this->BendWidth) &&
        holds.Of[v] == cartan::SourceHold::Free)
      {
        holds.Of[v] = cartan::SourceHold::Kept;
      }
    }
  }
  if (std::all_of(holds.Of.begin(), holds.Of.end(),
        [](cartan::SourceHold hold) { return hold == cartan::SourceHold::Free; }))
  {
    throw Error(ErrorCode::BadInput,
      "Nothing of the source is held, so its place cannot count: mark handles on it (Mark "
      "Handle), set a BendWidth smaller than the source, or choose INDEPENDENT.");
  }
  return holds;
}

std::vector<int> vtkMeshMerge::ReadFeatures(const Sides& sides, const Holds& holds) const
{
  if (!sides.SourceData->GetPointData()->GetArray(this->FeatureArrayName.c_str()))
  {
    return {};
  }
  const cartan::Handles features =
    cartan::ReadHandles(sides.SourceData, *sides.SourceSurface->Mesh, this->FeatureArrayName);
  cartan::IdSample both;
  for (std::size_t v = 0; v < holds.Of.size(); ++v)
  {
    if (features.OfVertex[v] > 0 && holds.Of[v] != cartan::SourceHold::Free)
    {
      both.Add(static_cast<long long>(v));
    }
  }
  if (!both.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      both.Describe("point", "points") +
        " of the source are held and in a feature, which finds its own place: unmark them as one "
        "of both.");
  }
  return features.Ids.empty() ? std::vector<int>{} : features.OfVertex;
}

cartan::FittedSource vtkMeshMerge::Fit(const Sides& sides, const cartan::MergeInput& target,
  const std::vector<cartan::LoopPair>& pairs, const std::vector<std::vector<cartan::LoopKey>>& keys,
  Holds& holds, cartan::FilterRun& run)
{
  const cartan::ExecutionContext& context = run.Context();
  std::vector<std::vector<int>> loops;
  cartan::ContentKey key = WithLoops(sides.SourceSurface->Key, pairs, &cartan::LoopPair::Source);
  key.Add(static_cast<std::uint64_t>(this->Configuration));
  key.AddBytes(sides.SourceOffset.data(), 3 * sizeof(double));
  for (const cartan::LoopPair& pair : pairs)
  {
    loops.push_back(pair.Source);
  }
  const auto fit = [&](double from, double to)
  {
    cartan::ContentKey held = key;
    held.AddBytes(holds.Of.data(), holds.Of.size());
    const auto merge = run.Keep<cartan::MeshMerge>(held,
      [&]
      {
        return std::make_unique<cartan::MeshMerge>(sides.Source.Surface, loops, holds.Of,
          cartan::SolverBackend::Automatic, context.Part(from, from + 0.9 * (to - from)));
      });
    this->NumberOfFactorizations += merge->GetNumberOfFactorizations();
    return merge->Fit(target, pairs, keys, holds.Moved, context.Part(from + 0.9 * (to - from), to));
  };
  const std::vector<int> features = this->ReadFeatures(sides, holds);
  if (features.empty())
  {
    return fit(0.3, 0.85);
  }
  const cartan::Points& rest = *sides.Source.Surface.Positions;
  const cartan::HandleTargets targets =
    cartan::FeatureTargets(rest, fit(0.3, 0.55).Positions, features);
  holds.Of.resize(features.size());
  for (const int v : targets.Vertices)
  {
    holds.Of[v] = cartan::SourceHold::Moved;
  }
  cartan::AddTargets(targets, holds.Moved);
  return fit(0.55, 0.85);
}

vtkMeshMerge::Sewn vtkMeshMerge::Sew(
  const Sides& sides, const cartan::PairedLoops& paired, cartan::FilterRun& run)
{
  const cartan::ExecutionContext& context = run.Context();
  Holds holds = this->FindHolds(sides, paired.Pairs, run);
  Sewn sewn;
  const cartan::TriangleMesh& source = *sides.SourceSurface->Mesh;
  const auto join = [&](const cartan::MergeInput& target,
                      const std::vector<cartan::LoopPair>& pairs,
                      const std::vector<std::vector<cartan::LoopKey>>& keys)
  {
    sewn.Fit = this->Fit(sides, target, pairs, keys, holds, run);
    run.Warn(sewn.Fit.Warning);
    sewn.Joined = cartan::JoinSurfaces(*target.Mesh, source, sewn.Fit.Loops);
    sewn.Positions = cartan::JoinedPositions(sewn.Joined, *target.Positions, sewn.Fit.Positions);
    sewn.Mesh = cartan::TriangleMesh(sewn.Joined.NumberOfVertices(), sewn.Joined.Faces);
    sewn.TargetPoints = target.Positions;
  };
  if (!(this->TransitionWidth > 0.0))
  {
    join(sides.Target.Surface, paired.Pairs, paired.Keys);
    return sewn;
  }
  cartan::TransitionWidths widths{ this->TransitionWidth, this->SourceTransitionWidth };
  widths.Source = widths.Source > 0.0 ? widths.Source : widths.Target;
  cartan::ContentKey key =
    WithLoops(WithLoops(sides.TargetSurface->Key, paired.Pairs, &cartan::LoopPair::Target),
      paired.Pairs, &cartan::LoopPair::Source);
  key.AddBytes(&widths, sizeof(widths));
  const auto transition = run.Keep<cartan::Transition>(key,
    [&]
    {
      return std::make_unique<cartan::Transition>(
        sides.Target.Surface, paired.Pairs, widths, context.Part(0.25, 0.3));
    });
  const cartan::CutSurface& cut = transition->GetCut();
  join({ cut.Mesh, cut.Positions }, transition->GetPairs(), transition->MoveKeys(paired.Keys));
  sewn.Fading = transition->Fade(
    source, sewn.Fit, holds.Of, sewn.Joined, sewn.Mesh, sewn.Positions, context.Part(0.85, 0.9));
  cartan::NameWholeFaces(cut, sewn.Joined);
  return sewn;
}

void vtkMeshMerge::WriteOutputs(
  const Sides& sides, const cartan::PairedLoops& paired, const Sewn& sewn, cartan::FilterRun& run)
{
  const cartan::SeamAngles angles = cartan::MeasureSeam(sewn.Joined, sewn.Mesh, sewn.Positions);
  cartan::WriteMergedSurface({ sides.TargetSurface.get(), sides.TargetData },
    { sides.SourceSurface.get(), sides.SourceData }, sewn.Joined, sewn.Mesh, sewn.Positions,
    sewn.Fading, run.Output());
  this->NumberOfPairs = static_cast<int>(paired.Pairs.size());
  this->SeamAngleMean =
    cartan::AddFieldValue(run.Output(), "SeamAngleMean", angles.Mean * 180.0 / cartan::Pi);
  this->SeamAngleMaximum =
    cartan::AddFieldValue(run.Output(), "SeamAngleMaximum", angles.Maximum * 180.0 / cartan::Pi);
  const cartan::Points target =
    sewn.TargetPoints->rowwise() + sides.TargetSurface->Origin.transpose();
  const cartan::Points source =
    sides.Source.Surface.Positions->rowwise() + sides.SourceOffset.transpose();
  cartan::WriteCorrespondences(paired, sewn.Fit, target, source, run.Output(1));
}

void vtkMeshMerge::Execute(cartan::FilterRun& run)
{
  const Sides sides = this->ReadSides(run);
  const cartan::PairedLoops paired = cartan::PairLoops(sides.Target, sides.Source,
    this->Configuration == DEPENDENT ? cartan::LoopAlignment::AsTheyLie
                                     : cartan::LoopAlignment::BySimilarity);
  run.Warn(paired.Warning);
  Sewn sewn = this->Sew(sides, paired, run);
  if (this->SeamFairing > 0)
  {
    const std::vector<int> seam = cartan::SeamVertices(sewn.Joined);
    const cartan::ExecutionContext context = run.Context().Part(0.9, 0.95);
    if (this->FairingMethod == DELTA_BLEND)
    {
      cartan::BlendSeam(sewn.Mesh, seam, this->SeamFairing, sewn.Positions, context);
    }
    else
    {
      cartan::FairRegion(sewn.Mesh, cartan::GrowByRings(sewn.Mesh, seam, this->SeamFairing),
        sewn.Positions, context);
    }
  }
  this->WriteOutputs(sides, paired, sewn, run);
  run.Context().Report(1.0);
}
