// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/PieceSurface.h"
#include "Kernel/Measure/VolumeModel.h"

namespace cartan
{
/// The rows of the whole surface's model that a piece has, for what looks at LocalDepth,
/// IsMeasured and Offsets alone. Each rank gathers the whole, since rays of one piece meet
/// others. Collective.
std::unique_ptr<VolumeModel> MeasurePieceVolume(
  const PieceSurface& piece, const ExecutionContext& context);
}
