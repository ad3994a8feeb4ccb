// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/FilterRun.h"
#include "Kernel/Morph/SurfaceMorph.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

class vtkCompositeDataSet;
class vtkDataObject;

namespace cartan
{
/// The key frames around a parameter.
struct KeySurfaces
{
  std::vector<vtkPolyData*> Surfaces;
  std::vector<std::string> Roles; ///< their names in messages
  std::vector<double> Parameters; ///< increasing
};

struct MorphOptions
{
  std::function<std::unique_ptr<SurfaceMorph>(const KeyFrames&, const ExecutionContext&)> NewMorph;
  ContentKey Settings;        ///< of all that NewMorph depends on
  bool NeedsPlacement;        ///< whether the method leaves the places of components open
  bool IsPinned;              ///< placed by the points with a handle, else by area
  std::string HandleArray;    ///< where these are
  std::string ParameterArray; ///< which only the first key frame needs
  bool CloseVolume;
};

struct MorphNumbers
{
  int Iterations = 0;
  double SetupTime = 0.0; ///< in seconds; 0 if the key frames were prepared already
  double EvaluationTime = 0.0;
};

/// Writes the surface at a place of finite numbers. Arrays are those at its parameter.
MorphNumbers MorphAt(
  const MorphPlace& at, const KeySurfaces& keys, const MorphOptions& options, FilterRun& run);

/// At `weights` of the key frames, unless there are none; with a parameter for each point in the
/// array `parameterArray` of the first key frame, unless that is empty; else at t everywhere.
/// Throws Error(BadInput) for both, for another number of weights, and unless these are finite and
/// sum to one; for parameters that are not finite.
MorphPlace ReadPlace(double t, const std::vector<double>& weights,
  const std::string& parameterArray, const KeySurfaces& keys);

/// Whether a composite data set, if there is one, has this block.
bool IsBlockOf(vtkCompositeDataSet* composite, vtkDataObject* block);
}
