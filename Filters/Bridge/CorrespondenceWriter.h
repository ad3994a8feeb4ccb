// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Merging/LoopPairing.h"

class vtkPolyData;

namespace cartan
{
/// Makes `output` lines with the cell arrays `Pair` (from 1) and `Kind`: 0 the target's
/// loop, 1 the source's, 2 from a point of the source's to its place, 3 the same for a key that
/// was given. Points are those of both surfaces in the world.
void WriteCorrespondences(const PairedLoops& paired, const FittedSource& fitted,
  const Points& targetPoints, const Points& sourcePoints, vtkPolyData* output);
}
