// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkType.h"

#include <vector>

class vtkPolyData;

namespace cartan
{
/// The point ids along the one open line that the line cells make: a polyline, or lines
/// that meet at their ends, whichever way they run; it runs as the first cell does,
/// without points at the place of the one before. With `isClosed` a ring, or a line whose ends
/// are joined; its first point is not repeated.
/// Throws Error(BadInput) where there is none, or several, a branch, a ring instead of a line,
/// or a ring of less than three points, and for points that are not finite.
std::vector<vtkIdType> ReadCurve(vtkPolyData* input, bool isClosed = false);
}
