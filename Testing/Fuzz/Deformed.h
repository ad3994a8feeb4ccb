// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh.h"

namespace fuzz
{
/// A bend, a stretch and a rigid motion, which differ from call to call.
std::vector<Eigen::Vector3d> Deformed(const std::vector<Eigen::Vector3d>& points, Random& random);
}
