// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Deformation/HandleProblem.h"

#include <string>

class vtkPolyData;

namespace cartan
{
/// Adds the point arrays FrameChange, the Frobenius norm of what the transforms add to the
/// identity, and RotationVector, in radians, those that are asked for. Returns a warning of
/// points whose rotation is any of several, empty if there is none.
std::string AddTransformArrays(
  const DeformedSurface& result, bool frameChange, bool rotationVector, vtkPolyData* output);
}
