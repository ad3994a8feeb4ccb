// SPDX-License-Identifier: BSD-3-Clause
#pragma once

class vtkInformation;
class vtkInformationVector;

namespace cartan
{
/// Gives all outputs time steps from `first` to `last`, whole numbers, at most a
/// thousand: an animation over a number of modes or anchors.
void SetCountSteps(vtkInformationVector* outputs, int first, int last);

/// The count that is asked of an output at its time; `otherwise` where no time is asked for.
int CountOfTime(vtkInformation* output, int otherwise);
}
