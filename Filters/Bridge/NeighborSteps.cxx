// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/NeighborSteps.h"

#include "vtkCompositeDataSet.h"
#include "vtkInformation.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>

namespace cartan
{
using Pipeline = vtkStreamingDemandDrivenPipeline;

void NeighborSteps::ReadTimes(vtkInformation* input)
{
  const int count =
    input && input->Has(Pipeline::TIME_STEPS()) ? input->Length(Pipeline::TIME_STEPS()) : 0;
  const double* times = count > 0 ? input->Get(Pipeline::TIME_STEPS()) : nullptr;
  this->Times.assign(times, times + count);
  this->Clear();
}

void NeighborSteps::Request(vtkInformation* input, double time)
{
  this->IsActive = this->Times.size() > 1 && !vtkCompositeDataSet::GetData(input);
  if (!this->IsActive)
  {
    return;
  }
  const auto after = std::upper_bound(this->Times.begin() + 1, this->Times.end(), time);
  const auto step = static_cast<std::size_t>(after - this->Times.begin()) - 1;
  const double before = this->Times[std::max<std::size_t>(step, 1) - 1];
  const double next = this->Times[std::min(step + 1, this->Times.size() - 1)];
  this->Interval = next - before;
  input->Set(Pipeline::UPDATE_TIME_STEP(), !this->Before ? before : !this->After ? next : time);
}

bool NeighborSteps::Take(vtkPolyData* input)
{
  if (!this->IsActive || this->IsComplete() || !input)
  {
    return true;
  }
  auto step = vtkSmartPointer<vtkPolyData>::New();
  step->ShallowCopy(input);
  (this->Before ? this->After : this->Before) = step;
  return false;
}

void NeighborSteps::Clear()
{
  this->Before = nullptr;
  this->After = nullptr;
}
}
