// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/FilterRun.h"
#include "Kernel/Morph/KeyInterpolation.h"

#include <string>
#include <vector>

namespace cartan
{
/// Sets the point and cell arrays of `output`, which has those of the nearest key
/// frame, to what they are at t, outside of key frames: floating-point arrays that
/// all of `keys` have are interpolated, others stay those of the nearest one.
/// Normals are left alone. An array that some key frame lacks, or has in another
/// size, is removed. Returns a warning that names these, but for those
/// `expected`, which only the first one needs.
std::string InterpolateArrays(const std::vector<vtkPolyData*>& keys,
  const std::vector<double>& parameters, double t, const std::vector<std::string>& expected,
  FilterRun& run);
}
