// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"

#include <memory>
#include <string>
#include <vector>

namespace cartan
{
/// A surface at several parameters, all of one connectivity.
struct KeyFrames
{
  std::shared_ptr<const TriangleMesh> Mesh;
  std::vector<Points> Positions;  ///< at least two, #V x 3 each, finite where used
  std::vector<double> Parameters; ///< one per key frame, finite and increasing
};

/// A method that finds surfaces between key frames, with what it keeps from one
/// parameter to the next.
class SurfaceMorph
{
public:
  virtual ~SurfaceMorph() = default;

  /// The surface at parameter t: #V x 3, each component in a place of its own
  /// (RigidPlacement puts it where it belongs), those of the key frames at their
  /// parameters. Outside of the key frames it goes on as at their ends.
  virtual Points Evaluate(double t, const ExecutionContext& context) = 0;

  /// How many steps the last Evaluate took to find what has no closed form; 0
  /// for direct methods.
  virtual int GetNumberOfIterations() const { return 0; }

  /// What is odd about the last result, in sentences; empty if nothing is.
  virtual std::string GetWarning() const { return {}; }
};
}
