// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Parameters.h"

namespace fuzz
{
/// What can be set in filters that are steered by landmarks, curves, examples or a surface.
Parameters CarryParameters();
Parameters CurveParameters();
Parameters ExampleParameters();
Parameters LandmarkParameters();
Parameters VolumetricParameters();
}
