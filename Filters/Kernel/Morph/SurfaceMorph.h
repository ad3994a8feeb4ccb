// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/Bytes.h"
#include "Base/ExecutionContext.h"
#include "Mesh/TriangleMesh.h"
#include "Morph/MorphPlace.h"

#include <memory>
#include <string>
#include <vector>

namespace cartan
{
/// A surface at several parameters, with one connectivity.
struct KeyFrames
{
  std::shared_ptr<const TriangleMesh> Mesh;
  std::vector<Points> Positions;  ///< at least two, #V x 3 each, finite where used
  std::vector<double> Parameters; ///< one per key frame, finite and increasing
};

/// A method that computes surfaces between key frames, with the data that it
/// keeps from one parameter to the next.
class SurfaceMorph
{
public:
  virtual ~SurfaceMorph() = default;

  /// The surface at a place: #V x 3, each component up to a rigid motion,
  /// which RigidPlacement determines; the key frames at their parameters.
  /// Parameters outside of the key frames extrapolate.
  virtual Points Evaluate(const MorphPlace& place, const ExecutionContext& context) = 0;

  /// The number of iterations of the last Evaluate; 0 for direct methods.
  virtual int GetNumberOfIterations() const { return 0; }

  /// Warnings about the last result, in sentences; empty if there are none.
  virtual std::string GetWarning() const { return {}; }

  /// The memory that is kept from one parameter to the next, without the mesh.
  virtual std::size_t GetBytes() const = 0;
};
}
