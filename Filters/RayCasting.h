// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/VolumePreservation.h"

namespace cartan
{
/// Rays against a surface, by VTK's static cell locator. The caster may be used
/// from several threads and outlives nothing it was made of.
RayCaster MakeRayCaster(const TriangleMesh& mesh, const Points& points);
}
