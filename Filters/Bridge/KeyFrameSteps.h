// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <cstddef>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

/// Private to the filters, not installed.
namespace cartan
{
/// Of one input: its time steps, and those of the surfaces there that are in use.
struct KeyFrameSteps
{
  std::vector<double> Times;
  std::map<int, vtkSmartPointer<vtkPolyData>> Steps;
  int Requested = 0;

  /// The first time step that is not after the one before it; 0 if all are.
  std::size_t FirstOutOfOrder() const
  {
    for (std::size_t k = 1; k < this->Times.size(); ++k)
    {
      if (!(this->Times[k] > this->Times[k - 1]))
      {
        return k;
      }
    }
    return 0;
  }

  /// The first time step of the window that is not there; -1 if none.
  int NextMissing(const std::pair<int, int>& window) const
  {
    for (int k = window.first; k < window.second; ++k)
    {
      if (!this->Steps.count(k))
      {
        return k;
      }
    }
    return -1;
  }

  /// The surface of the time step that was asked for.
  void TakeStep(vtkPolyData* surface)
  {
    vtkNew<vtkPolyData> step;
    step->ShallowCopy(surface);
    this->Steps[this->Requested] = step.Get();
  }

  void KeepSteps(const std::pair<int, int>& window)
  {
    for (auto entry = this->Steps.begin(); entry != this->Steps.end();)
    {
      const bool isUsed = entry->first >= window.first && entry->first < window.second;
      entry = isUsed ? std::next(entry) : this->Steps.erase(entry);
    }
  }
};
}
