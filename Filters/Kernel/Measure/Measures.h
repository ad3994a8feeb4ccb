// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Numbers that compare a surface with a reference of the same connectivity.
/// `mesh` is that connectivity, `reference` and `current` are positions
/// (#V x 3). Nothing here changes when either surface is moved rigidly.
#include "Measure/Areas.h"
#include "Measure/ComponentVolumes.h"
#include "Measure/EdgeLengths.h"
#include "Measure/LocalVolumes.h"
#include "Measure/ShapeDistance.h"
