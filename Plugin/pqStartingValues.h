// SPDX-License-Identifier: BSD-3-Clause
/// The values that filters made in ParaView's window start with.
#pragma once

#include "vtkType.h"

#include <vector>

class pqPipelineSource;
class vtkSMProxy;

/// Gives a new filter values that act at once, and records them in a trace.
void SetStartingValues(pqPipelineSource* filter);

/// The ids of the points that are selected in the window, or else in the input of a Mark
/// Handle filter; the points of selected cells count as selected. Empty if there are none.
std::vector<vtkIdType> SelectedPointIds(vtkSMProxy* filter);
