// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Base/ExecutionContext.h"
#include "Base/Types.h"

#include <vector>

namespace cartan
{
/// For each point the first point in the same place, itself if there is none
/// before it: #V. Only points with a non-zero entry in `takesPart` (#V) are
/// compared.
///
/// With `tolerance` 0 the same place means equal coordinates, where 0 equals
/// -0. With a tolerance > 0, in length units, points are taken in the order of
/// their ids: each goes to the nearest point within the tolerance that has not
/// gone to another itself, of equally near ones to that of the smaller id. So
/// no point moves by more than the tolerance, and chains of points closer than
/// that do not shrink to one. The result depends on the points' order only
/// where distances are near the tolerance. A tolerance below rounding, 1e-15 of
/// the bounding diagonal, counts as 0.
///
/// The coordinates of points that take part are finite. O(#V log #V) without, O(#V) with a
/// tolerance that is small against the distances of the points. Throws Error(Aborted).
std::vector<int> FindCoincidentPoints(const Points& points, const std::vector<char>& takesPart,
  double tolerance, const ExecutionContext& context = {});
}
