// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkType.h"

#include <vector>

class vtkPolyData;

namespace cartan
{
/// The point ids along the one open line that the line cells make: a polyline, or lines
/// that meet at their ends, whichever way they run; it runs as the first cell does,
/// without points at the place of the one before.
/// Throws Error(BadInput) where there is none, or several, a branch or a ring, and for
/// points that are not finite.
std::vector<vtkIdType> ReadCurve(vtkPolyData* input);
}
