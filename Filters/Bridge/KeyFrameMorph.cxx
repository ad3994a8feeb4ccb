// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/KeyFrameMorph.h"

#include "Bridge/HandleArrays.h"
#include "Bridge/KeyArrays.h"
#include "Bridge/MatchedSurfaces.h"
#include "Bridge/PointArrays.h"
#include "Bridge/SurfaceWriter.h"
#include "Kernel/Morph/KeyInterpolation.h"
#include "Kernel/Morph/MorphVolume.h"
#include "Kernel/Morph/RigidPlacement.h"

#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTimerLog.h"

#include <algorithm>

namespace cartan
{
namespace
{
/// What is kept while the key frames and the method are the same.
struct PreparedMorph
{
  Surface First;  ///< with the triangles that all key frames use
  KeyFrames Keys; ///< about the origin of First
  std::unique_ptr<SurfaceMorph> Morph;
  std::unique_ptr<MorphVolume> Volume; ///< once it is needed

  std::size_t GetBytes() const
  {
    const std::size_t positions =
      this->Keys.Positions.size() * this->Keys.Positions.front().size() * sizeof(double);
    return positions + this->First.GetBytes() + this->Morph->GetBytes() +
      (this->Volume ? this->Volume->GetBytes() : 0);
  }
};

/// Which points of the first key frame are in a handle. Throws if none is.
std::vector<char> ReadPinned(vtkPolyData* first, const std::string& name)
{
  const std::vector<int> handles =
    ReadHandleIds(RequirePointArray(first, name, 1), name, first->GetNumberOfPoints());
  std::vector<char> isPinned(handles.size());
  std::transform(handles.begin(), handles.end(), isPinned.begin(),
    [](int handle) -> char { return handle > 0; });
  if (std::find(isPinned.begin(), isPinned.end(), 1) == isPinned.end())
  {
    throw Error(ErrorCode::BadInput,
      "No point of the first key frame has a value above 0 in \"" + name +
        "\": mark the points to pin (Mark Handle), or place by rigid interpolation.");
  }
  return isPinned;
}

std::unique_ptr<PreparedMorph> Prepare(const MatchedSurfaces& matched,
  const std::vector<double>& parameters, const MorphOptions& options,
  const ExecutionContext& context)
{
  auto prepared = std::make_unique<PreparedMorph>();
  prepared->First = matched.First();
  prepared->Keys.Mesh = matched.Mesh;
  prepared->Keys.Parameters = parameters;
  for (std::size_t k = 0; k < matched.Positions.size(); ++k)
  {
    prepared->Keys.Positions.push_back(*matched.Positions[k]);
    prepared->Keys.Positions.back().rowwise() +=
      (matched.Origins[k] - matched.Origins[0]).transpose();
  }
  prepared->Morph = options.NewMorph(prepared->Keys, context);
  return prepared;
}

Points PositionsAt(double t, vtkPolyData* first, const MorphOptions& options,
  const ContentKey& preparedKey, PreparedMorph& prepared, FilterRun& run)
{
  Points positions = prepared.Morph->Evaluate(t, run.Context().Part(0.7, 0.9));
  run.Warn(prepared.Morph->GetWarning());
  if (options.NeedsPlacement)
  {
    ContentKey key = preparedKey;
    key.Add(options.IsPinned ? KeyOfPointArray(first, options.HandleArray).GetValue() : 0);
    const auto placement = run.Keep<RigidPlacement>(key,
      [&]
      {
        return std::make_unique<RigidPlacement>(prepared.Keys,
          options.IsPinned ? PinWeights(prepared.Keys, ReadPinned(first, options.HandleArray))
                           : AreaWeights(prepared.Keys, run.Context().Part(0.9, 0.9)));
      });
    placement->Place(t, positions);
  }
  if (options.CloseVolume)
  {
    if (!prepared.Volume)
    {
      prepared.Volume = std::make_unique<MorphVolume>(prepared.Keys, run.Context().Part(0.9, 0.95));
    }
    run.Warn(prepared.Volume->GetWarning());
    run.Warn(prepared.Volume->Close(t, positions));
  }
  return positions;
}

/// The surface with the nearest key frame's cells and arrays where these have the
/// same ids as the first one's, as they nearly always have. Points in no triangle
/// move on straight lines.
void WriteBetween(const std::vector<vtkPolyData*>& keys, const KeyPlace& place,
  const PreparedMorph& prepared, const Points& positions, FilterRun& run)
{
  const std::size_t nearest = place.Before + (place.Part < 0.5 ? 0 : 1);
  const bool isLikeFirst = KeyOfCells(keys[nearest]) == KeyOfCells(keys[0]);
  const std::size_t model = isLikeFirst ? nearest : 0;
  Surface surface = prepared.First;
  surface.Positions = std::make_shared<const Points>(prepared.Keys.Positions[model]);
  run.Warn(WriteSurface(surface, positions, keys[model], run.Output(), run.Context()));
  for (int v = 0; v < surface.Mesh->NumberOfVertices(); ++v)
  {
    if (!surface.Mesh->IsUsed(v))
    {
      const Eigen::Vector3d from(keys[place.Before]->GetPoint(v));
      const Eigen::Vector3d to(keys[place.Before + 1]->GetPoint(v));
      const Eigen::Vector3d point = from + place.Part * (to - from);
      run.Output()->GetPoints()->SetPoint(v, point.data());
    }
  }
}
}

MorphNumbers MorphAt(double t, const KeySurfaces& keys, const MorphOptions& options, FilterRun& run)
{
  MorphNumbers numbers;
  const MatchedSurfaces matched = ReadMatchedSurfaces(keys.Surfaces, keys.Roles,
    "Key frames need the same points and cells in the same order, such as one surface in several "
    "poses.",
    run.Context().Part(0.0, 0.1));
  for (const auto& surface : matched.Surfaces)
  {
    run.KeepSurface(surface);
  }
  run.Warn(matched.Warning);
  ContentKey key = options.Settings;
  for (std::size_t k = 0; k < keys.Surfaces.size(); ++k)
  {
    key.Add(KeyOfSurface(keys.Surfaces[k]).GetValue());
    key.Add(keys.Parameters[k]);
  }
  const auto prepared = run.Keep<PreparedMorph>(key,
    [&]
    {
      const double start = vtkTimerLog::GetUniversalTime();
      auto fresh = Prepare(matched, keys.Parameters, options, run.Context().Part(0.1, 0.7));
      numbers.SetupTime = vtkTimerLog::GetUniversalTime() - start;
      return fresh;
    });

  const double start = vtkTimerLog::GetUniversalTime();
  const KeyPlace place = PlaceBetweenKeys(t, keys.Parameters);
  if (place.Part == 0.0 || place.Part == 1.0)
  {
    // Key frames to the last bit, with all their arrays.
    run.Output()->ShallowCopy(keys.Surfaces[place.Before + (place.Part == 1.0)]);
  }
  else
  {
    const Points positions = PositionsAt(t, keys.Surfaces.front(), options, key, *prepared, run);
    numbers.Iterations = prepared->Morph->GetNumberOfIterations();
    WriteBetween(keys.Surfaces, place, *prepared, positions, run);
    run.Warn(InterpolateArrays(keys.Surfaces, keys.Parameters, t, options.HandleArray, run));
  }
  numbers.EvaluationTime = vtkTimerLog::GetUniversalTime() - start;
  return numbers;
}
}
