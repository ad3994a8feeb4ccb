// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/MarkedPoints.h"
#include "Bridge/SurfaceReader.h"

#include <string>

class vtkPolyData;

namespace cartan
{
/// Marks what so many rings of neighbors of the marked points reach, and what is at most
/// `distance` away over the surface; from each point to the copies that JoinedPoints
/// holds together with it, which are marked alike.
void GrowOverCopies(vtkPolyData* input, const Surface& surface, int rings, double distance,
  PointMask& mask, const ExecutionContext& context);

/// A warning where points of `input` that JoinedPoints holds together are apart in
/// `positions` (#V x 3) by more than 1e-6 of the size, with the advice; empty where none are.
std::string DescribePartedCopies(
  vtkPolyData* input, const Surface& surface, const Points& positions, const std::string& advice);
}
