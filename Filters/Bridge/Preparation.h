// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/DeformationMethod.h"
#include "Kernel/Deformation/RoundingCheck.h"

#include <cstddef>
#include <memory>

class vtkPolyData;

namespace cartan
{
/// What is kept of a surface, its handles and the settings between motions.
struct Preparation
{
  HandleProblem Problem;
  DeformationMethod Method;
  DeformedSurface Result;
  /// The same with points moved by rounding, where that is checked (see
  /// WithMovedPoints).
  std::unique_ptr<Preparation> Moved;

  std::size_t GetBytes() const;
};

/// Hands over what may change from one motion to the next.
void Configure(Preparation& prepared, FilterRun& run, const ExecutionContext& context);

/// Deforms, with transforms where those are compared; with Moved a second time. Writes `surface`
/// as it is then (WriteSurface) to the output. Warns of what is odd, and of what differs. The
/// positions are in Result only with `keepsPositions`: else they may go from the kernel's fields
/// to the output in one pass over memory.
void DeformAndWrite(Preparation& prepared, const HandleTargets& targets,
  const ComparedFields& fields, bool keepsPositions, const Surface& surface, FilterRun& run,
  const ExecutionContext& context);
}
