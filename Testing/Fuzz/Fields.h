// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run.h"

namespace fuzz
{
/// What a filter has made of `input`: the points first, then all arrays that `input` has not.
std::vector<Field> FieldsOf(const Case& of, const Outcome& outcome, vtkPolyData* input);
}
