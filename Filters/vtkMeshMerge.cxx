// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshMerge.h"

#include "Bridge/FilterRun.h"
#include "Bridge/HandleArrays.h"
#include "Bridge/MergedSurfaceWriter.h"
#include "Bridge/PointArrays.h"
#include "Kernel/Base/Constants.h"
#include "Kernel/Merging/LoopPairing.h"
#include "Kernel/Merging/SeamFairing.h"
#include "Kernel/Merging/Transition.h"
#include "Kernel/Mesh/GeodesicDistance.h"
#include "Kernel/Mesh/GrowByRings.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>

vtkStandardNewMacro(vtkMeshMerge);

using cartan::Error;
using cartan::ErrorCode;

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
  cartan::Points Positions; ///< from the target's origin
  cartan::Fading Fading;    ///< empty without a transition
  /// The target's points, with those where a transition cuts it.
  std::shared_ptr<const cartan::Points> TargetPoints;
};

namespace
{
/// #V; zeros where there is no such array.
std::vector<int> ReadKeys(
  vtkPolyData* input, const cartan::TriangleMesh& mesh, const std::string& name)
{
  vtkDataArray* array = input->GetPointData()->GetArray(name.c_str());
  std::vector<int> keys(mesh.NumberOfVertices(), 0);
  if (array)
  {
    keys = cartan::ReadHandleIds(array, name, input->GetNumberOfPoints(),
      "0 is no key, equal numbers from 1 belong together.");
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      keys[v] = mesh.IsUsed(v) ? keys[v] : 0;
    }
  }
  return keys;
}

/// A line of points with its pair and kind.
class LineWriter
{
public:
  explicit LineWriter(vtkPolyData* output)
    : Output(output)
  {
    this->Pairs->SetName("Pair");
    this->Kinds->SetName("Kind");
  }

  void Add(const cartan::Points& points, bool isClosed, int pair, int kind)
  {
    this->Lines->InsertNextCell(static_cast<int>(points.rows()) + isClosed);
    vtkIdType first = -1;
    for (Eigen::Index i = 0; i < points.rows(); ++i)
    {
      const vtkIdType id = this->Coordinates->InsertNextPoint(points.row(i).data());
      first = i == 0 ? id : first;
      this->Lines->InsertCellPoint(id);
    }
    if (isClosed)
    {
      this->Lines->InsertCellPoint(first);
    }
    this->Pairs->InsertNextValue(pair);
    this->Kinds->InsertNextValue(kind);
  }

  void Finish()
  {
    this->Output->SetPoints(this->Coordinates);
    this->Output->SetLines(this->Lines);
    this->Output->GetCellData()->AddArray(this->Pairs);
    this->Output->GetCellData()->AddArray(this->Kinds);
  }

private:
  vtkPolyData* Output;
  vtkNew<vtkPoints> Coordinates;
  vtkNew<vtkCellArray> Lines;
  vtkNew<vtkIntArray> Pairs;
  vtkNew<vtkIntArray> Kinds;
};

/// Loops, lines from the points of the source's to their places, and those of keys.
void WriteCorrespondences(const cartan::PairedLoops& paired, const cartan::FittedSource& fitted,
  const cartan::Points& targetPoints, const cartan::Points& sourcePoints, vtkPolyData* output)
{
  LineWriter lines(output);
  for (std::size_t p = 0; p < fitted.Loops.size(); ++p)
  {
    const cartan::SeamLoop& loop = fitted.Loops[p];
    const int pair = static_cast<int>(p) + 1;
    const cartan::Points target = targetPoints(loop.Target, Eigen::all);
    const cartan::Points source = sourcePoints(loop.Source, Eigen::all);
    lines.Add(target, true, pair, 0);
    lines.Add(source, true, pair, 1);
    for (Eigen::Index i = 0; i < source.rows(); ++i)
    {
      const bool isKey = paired.GivenKeys[p] > 0 &&
        std::any_of(paired.Keys[p].begin(), paired.Keys[p].end(),
          [i](const cartan::LoopKey& key) { return key.Source == i; });
      cartan::Points ends(2, 3);
      ends << source.row(i), cartan::PointAt(target, loop.Places[i]);
      lines.Add(ends, false, pair, isKey ? 3 : 2);
    }
  }
  lines.Finish();
}
}

vtkMeshMerge::vtkMeshMerge()
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
}

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
  os << indent << "SeamFairing: " << this->SeamFairing << "\n";
  os << indent << "BoundaryKeyArrayName: " << this->BoundaryKeyArrayName << "\n";
  os << indent << "HandleArrayName: " << this->HandleArrayName << "\n";
  os << indent << "NumberOfPairs: " << this->NumberOfPairs << "\n";
  os << indent << "SeamAngleMean: " << this->SeamAngleMean << "\n";
  os << indent << "SeamAngleMaximum: " << this->SeamAngleMaximum << "\n";
  os << indent << "NumberOfFactorizations: " << this->NumberOfFactorizations << "\n";
}

void vtkMeshMerge::ForgetResults()
{
  this->NumberOfPairs = 0;
  this->NumberOfFactorizations = 0;
  this->SeamAngleMean = 0.0;
  this->SeamAngleMaximum = 0.0;
}

vtkMeshMerge::Sides vtkMeshMerge::ReadSides(cartan::FilterRun& run) const
{
  Sides sides{ run.Input(0), run.Input(1), run.ReadSurface(0, "target"),
    run.ReadSurface(1, "source"), {}, {}, Eigen::Vector3d::Zero() };
  sides.Target = { { sides.TargetSurface->Mesh, sides.TargetSurface->Positions }, "target",
    ReadKeys(sides.TargetData, *sides.TargetSurface->Mesh, this->BoundaryKeyArrayName) };
  sides.Source = { { sides.SourceSurface->Mesh, sides.SourceSurface->Positions }, "source",
    ReadKeys(sides.SourceData, *sides.SourceSurface->Mesh, this->BoundaryKeyArrayName) };
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

std::vector<char> vtkMeshMerge::HeldPoints(
  const Sides& sides, const std::vector<std::vector<int>>& loops, cartan::FilterRun& run) const
{
  std::vector<char> held;
  if (this->Configuration == INDEPENDENT)
  {
    return held;
  }
  const cartan::TriangleMesh& mesh = *sides.Source.Surface.Mesh;
  held.assign(mesh.NumberOfVertices(), 0);
  if (sides.SourceData->GetPointData()->GetArray(this->HandleArrayName.c_str()))
  {
    for (const int v : cartan::ReadHandles(sides.SourceData, mesh, this->HandleArrayName).Points)
    {
      held[v] = 1;
    }
  }
  if (this->BendWidth > 0.0)
  {
    std::vector<int> seam;
    for (const std::vector<int>& loop : loops)
    {
      seam.insert(seam.end(), loop.begin(), loop.end());
    }
    const Eigen::VectorXd distances = cartan::GeodesicDistance(
      mesh, *sides.Source.Surface.Positions, seam, this->BendWidth, run.Context().Part(0.2, 0.25));
    for (int v = 0; v < mesh.NumberOfVertices(); ++v)
    {
      held[v] |= mesh.IsUsed(v) && !(distances[v] <= this->BendWidth);
    }
  }
  if (std::find(held.begin(), held.end(), 1) == held.end())
  {
    throw Error(ErrorCode::BadInput,
      "Nothing of the source is held, so its place cannot count: mark handles on it (Mark "
      "Handle), set a BendWidth smaller than the source, or choose INDEPENDENT.");
  }
  return held;
}

vtkMeshMerge::Sewn vtkMeshMerge::Sew(
  const Sides& sides, const cartan::PairedLoops& paired, cartan::FilterRun& run)
{
  const cartan::ExecutionContext& context = run.Context();
  std::vector<std::vector<int>> loops;
  cartan::ContentKey key = sides.SourceSurface->Key;
  key.Add(static_cast<std::uint64_t>(this->Configuration));
  key.AddBytes(sides.SourceOffset.data(), 3 * sizeof(double));
  for (const cartan::LoopPair& pair : paired.Pairs)
  {
    loops.push_back(pair.Source);
    key.Add(static_cast<std::uint64_t>(pair.Source.size()));
    key.AddBytes(pair.Source.data(), pair.Source.size() * sizeof(int));
  }
  const std::vector<char> held = this->HeldPoints(sides, loops, run);
  key.AddBytes(held.data(), held.size());
  const auto merge = run.Keep<cartan::MeshMerge>(key,
    [&]
    {
      return std::make_unique<cartan::MeshMerge>(sides.Source.Surface, loops, held,
        cartan::SolverBackend::Automatic, context.Part(0.25, 0.75));
    });
  this->NumberOfFactorizations = merge->GetNumberOfFactorizations();

  Sewn sewn;
  const cartan::TriangleMesh& source = *sides.SourceSurface->Mesh;
  const auto join = [&](const cartan::MergeInput& target,
                      const std::vector<cartan::LoopPair>& pairs,
                      const std::vector<std::vector<cartan::LoopKey>>& keys)
  {
    sewn.Fit = merge->Fit(target, pairs, keys, context.Part(0.8, 0.85));
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
  const cartan::Transition transition(
    sides.Target.Surface, paired.Pairs, this->TransitionWidth, context.Part(0.75, 0.8));
  const cartan::CutSurface& cut = transition.GetCut();
  join({ cut.Mesh, cut.Positions }, transition.GetPairs(), transition.MoveKeys(paired.Keys));
  sewn.Fading = transition.Fade(
    source, sewn.Fit, held, sewn.Joined, sewn.Mesh, sewn.Positions, context.Part(0.85, 0.9));
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
  WriteCorrespondences(paired, sewn.Fit, target, source, run.Output(1));
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
    cartan::FairRegion(sewn.Mesh,
      cartan::GrowByRings(sewn.Mesh, cartan::SeamVertices(sewn.Joined), this->SeamFairing),
      sewn.Positions, run.Context().Part(0.9, 0.95));
  }
  this->WriteOutputs(sides, paired, sewn, run);
  run.Context().Report(1.0);
}
