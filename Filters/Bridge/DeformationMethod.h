// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/FilterRun.h"
#include "Kernel/Deformation/SurfaceDeformer.h"

#include <functional>
#include <memory>

namespace cartan
{
/// A deformer with what its filter does around each motion.
struct DeformationMethod
{
  std::unique_ptr<SurfaceDeformer> Deformer;
  /// Hands over the parameters that may change from one motion to the next, and
  /// measures what they need.
  std::function<void(FilterRun&, const ExecutionContext&)> Configure =
    [](FilterRun&, const ExecutionContext&) {};
  /// Adds the arrays and takes over the numbers of the concrete method.
  std::function<void(const DeformedSurface&, FilterRun&)> Decorate = [](const DeformedSurface&,
                                                                       FilterRun&) {};
};
}
