// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run.h"

namespace fuzz
{
/// Makes numbers of components comparable when the order of points, in which components are
/// numbered, changes: "... of component 2" becomes that of the component's least PointId, and
/// each row of Volume Change's table, which has some for each component, a field of its own.
void NameByPoints(const Case& of, const Outcome& outcome, std::vector<Field>& fields);
}
