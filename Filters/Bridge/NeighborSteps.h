// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <vector>

class vtkInformation;

namespace cartan
{
/// The time steps before and after the one that is asked for. The pipeline executes three
/// times for them: for the one before, the one after, and the one itself.
class NeighborSteps
{
public:
  /// In RequestInformation: the times of the input.
  void ReadTimes(vtkInformation* input);

  /// In RequestUpdateExtent: asks the input for the next one that is missing. Does nothing where
  /// there is one time at most, or a composite data set.
  void Request(vtkInformation* input, double time);

  /// In RequestData: takes what was asked for. Returns whether it was the one itself; if not,
  /// the pipeline has to execute again.
  bool Take(vtkPolyData* input);

  /// Whether both are there. At the first and the last time one of them is the step itself.
  bool IsComplete() const { return this->Before && this->After; }
  vtkPolyData* GetBefore() const { return this->Before; }
  vtkPolyData* GetAfter() const { return this->After; }

  /// From the one before to the one after.
  double GetInterval() const { return this->Interval; }

  void Clear();

private:
  std::vector<double> Times;
  vtkSmartPointer<vtkPolyData> Before;
  vtkSmartPointer<vtkPolyData> After;
  double Interval = 0.0;
  bool IsActive = false;
};
}
