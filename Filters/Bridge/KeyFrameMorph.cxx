// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/KeyFrameMorph.h"

#include "Bridge/HandleArrays.h"
#include "Bridge/JoinedCopies.h"
#include "Bridge/KeyArrays.h"
#include "Bridge/MatchedPieces.h"
#include "Bridge/PointArrays.h"
#include "Bridge/SurfaceWriter.h"
#include "Kernel/Base/Bytes.h"
#include "Kernel/Morph/KeyInterpolation.h"
#include "Kernel/Morph/MorphVolume.h"
#include "Kernel/Morph/RigidPlacement.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkTimerLog.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
/// What is kept while the key frames and the method are the same.
struct PreparedMorph
{
  Surface First;           ///< with the triangles that all key frames use
  KeyFrames Keys;          ///< about the origin of First
  std::vector<int> Unused; ///< the vertices in no triangle
  std::unique_ptr<SurfaceMorph> Morph;
  std::unique_ptr<MorphVolume> Volume; ///< once it is needed

  /// A key frame as long as this is kept: its positions are lent, not copied.
  Surface SurfaceAt(std::size_t key) const
  {
    Surface surface = this->First;
    surface.Positions = { std::shared_ptr<const Points>(), &this->Keys.Positions[key] };
    return surface;
  }

  std::size_t GetBytes() const
  {
    const std::size_t positions =
      this->Keys.Positions.size() * this->Keys.Positions.front().size() * sizeof(double);
    return positions + TotalBytes(this->Unused) + this->First.GetBytes() + this->Morph->GetBytes() +
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
  for (int v = 0; v < matched.Mesh->NumberOfVertices(); ++v)
  {
    if (!matched.Mesh->IsUsed(v))
    {
      prepared->Unused.push_back(v);
    }
  }
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

Points PositionsAt(const MorphPlace& at, vtkPolyData* first, const MorphOptions& options,
  const ContentKey& preparedKey, PreparedMorph& prepared, FilterRun& run)
{
  Points positions = prepared.Morph->Evaluate(at, run.Context().Part(0.7, 0.9));
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
    placement->Place(at, positions);
  }
  if (options.CloseVolume)
  {
    if (!prepared.Volume)
    {
      prepared.Volume = std::make_unique<MorphVolume>(prepared.Keys, run.Context().Part(0.9, 0.95));
    }
    run.Warn(prepared.Volume->GetWarning());
    run.Warn(prepared.Volume->Close(at.GetParameter(), positions));
  }
  // A linear morph keeps copies together, unless their parameters differ.
  if (options.NeedsPlacement || at.IsLocal())
  {
    run.Warn(DescribePartedCopies(first, prepared.SurfaceAt(0), positions,
      "choose Method Linear, which keeps them together, or one of the deformations."));
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
  const Surface surface = prepared.SurfaceAt(model);
  run.Warn(WriteSurface(surface, positions, keys[model], run.Output(), run.Context()));
  for (const int v : prepared.Unused)
  {
    const Eigen::Vector3d from(keys[place.Before]->GetPoint(v));
    const Eigen::Vector3d to(keys[place.Before + 1]->GetPoint(v));
    const Eigen::Vector3d point = from + place.Part * (to - from);
    run.Output()->GetPoints()->SetPoint(v, point.data());
  }
}

MorphPlace ReadLocalPlace(vtkPolyData* first, const std::string& name)
{
  vtkDataArray* array = RequirePointArray(first, name, 1);
  Eigen::VectorXd parameters(array->GetNumberOfTuples());
  IdSample bad;
  for (Eigen::Index v = 0; v < parameters.size(); ++v)
  {
    parameters[v] = array->GetTuple1(v);
    if (!std::isfinite(parameters[v]))
    {
      bad.Add(v);
    }
  }
  if (!bad.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The point array \"" + name + "\" has " + bad.Describe("value", "values") +
        " that are NaN or infinite: give each point a parameter, from 0 at the first key "
        "frame to 1 at the last.");
  }
  const double mean = parameters.mean();
  // One parameter everywhere is no local place, and a key frame can be met to the last bit.
  return (parameters.array() == parameters[0]).all() ? MorphPlace(parameters[0])
                                                     : MorphPlace::Local(parameters, mean);
}

MorphPlace ReadBlend(const std::vector<double>& weights, const std::vector<double>& parameters)
{
  const Eigen::VectorXd all =
    Eigen::Map<const Eigen::VectorXd>(weights.data(), static_cast<Eigen::Index>(weights.size()));
  if (weights.size() != parameters.size())
  {
    throw Error(ErrorCode::BadInput,
      "There are " + std::to_string(weights.size()) + " weights for " +
        std::to_string(parameters.size()) + " key frames: give each key frame one weight.");
  }
  if (!(std::abs(all.sum() - 1.0) < 1e-9))
  {
    throw Error(ErrorCode::BadInput,
      "The weights of the key frames sum to " + std::to_string(all.sum()) +
        ": make them sum to 1.");
  }
  Eigen::Index largest = 0;
  const bool isKey = all.maxCoeff(&largest) == 1.0 && all.cwiseAbs().sum() == 1.0;
  return isKey ? MorphPlace(parameters[largest]) : MorphPlace::Blend(all, parameters);
}
}

MorphNumbers MorphAt(
  const MorphPlace& at, const KeySurfaces& keys, const MorphOptions& options, FilterRun& run)
{
  if (options.CloseVolume && !at.IsUniform())
  {
    throw Error(ErrorCode::BadInput,
      "CloseVolume needs one parameter for the whole surface: turn it off, or use neither weights "
      "nor an array of parameters.");
  }
  const double t = at.GetParameter();
  MorphNumbers numbers;
  const std::string advice =
    "Key frames need the same points and cells in the same order, such as one surface in several "
    "poses.";
  const MatchedSurfaces matched = run.Pieces()
    ? ReadMatchedPieces(run, keys.Surfaces, keys.Roles, 0, {}, advice).Matched
    : ReadMatchedSurfaces(keys.Surfaces, keys.Roles, advice, run.Context().Part(0.0, 0.1));
  for (const auto& surface : matched.Surfaces)
  {
    run.KeepSurface(surface);
  }
  run.Warn(matched.Warning);
  ContentKey key = options.Settings;
  for (std::size_t k = 0; k < keys.Surfaces.size(); ++k)
  {
    key.Add(
      (run.Pieces() ? KeyOfPiece(keys.Surfaces[k]) : KeyOfSurface(keys.Surfaces[k])).GetValue());
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
  if (at.IsUniform() && (place.Part == 0.0 || place.Part == 1.0))
  {
    // Key frames to the last bit, with all their arrays.
    run.Output()->ShallowCopy(keys.Surfaces[place.Before + (place.Part == 1.0)]);
  }
  else
  {
    const Points positions = PositionsAt(at, keys.Surfaces.front(), options, key, *prepared, run);
    numbers.Iterations = prepared->Morph->GetNumberOfIterations();
    WriteBetween(keys.Surfaces, place, *prepared, positions, run);
    run.Warn(InterpolateArrays(
      keys.Surfaces, keys.Parameters, t, { options.HandleArray, options.ParameterArray }, run));
  }
  numbers.EvaluationTime = vtkTimerLog::GetUniversalTime() - start;
  return numbers;
}

MorphPlace ReadPlace(double t, const std::vector<double>& weights,
  const std::string& parameterArray, const KeySurfaces& keys)
{
  if (!weights.empty() && !parameterArray.empty())
  {
    throw Error(
      ErrorCode::BadInput, "There are weights and an array of parameters: choose one of the two.");
  }
  if (!weights.empty())
  {
    return ReadBlend(weights, keys.Parameters);
  }
  return parameterArray.empty() ? MorphPlace(t)
                                : ReadLocalPlace(keys.Surfaces.front(), parameterArray);
}

bool IsBlockOf(vtkCompositeDataSet* composite, vtkDataObject* block)
{
  if (!composite)
  {
    return false;
  }
  bool isFound = false;
  auto blocks = vtk::TakeSmartPointer(composite->NewIterator());
  for (blocks->InitTraversal(); !blocks->IsDoneWithTraversal(); blocks->GoToNextItem())
  {
    isFound = isFound || blocks->GetCurrentDataObject() == block;
  }
  return isFound;
}
}
