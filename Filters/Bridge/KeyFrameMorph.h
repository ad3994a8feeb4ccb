// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/FilterRun.h"
#include "Kernel/Morph/SurfaceMorph.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

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
  ContentKey Settings;     ///< of all that NewMorph depends on
  bool NeedsPlacement;     ///< whether the method leaves the places of components open
  bool IsPinned;           ///< placed by the points with a handle, else by area
  std::string HandleArray; ///< where these are
  bool CloseVolume;
};

struct MorphNumbers
{
  int Iterations = 0;
  double SetupTime = 0.0; ///< in seconds; 0 if the key frames were prepared already
  double EvaluationTime = 0.0;
};

/// Writes the surface at parameter t, a finite number.
MorphNumbers MorphAt(
  double t, const KeySurfaces& keys, const MorphOptions& options, FilterRun& run);
}
