// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/CountSteps.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace cartan
{
using Pipeline = vtkStreamingDemandDrivenPipeline;

void SetCountSteps(vtkInformationVector* outputs, int first, int last)
{
  constexpr int MostSteps = 1000;
  const int steps = std::min(std::max(last - first, 0), MostSteps - 1);
  std::vector<double> times;
  for (int i = 0; i <= steps; ++i)
  {
    times.push_back(
      first + (steps > 0 ? std::floor(static_cast<double>(i) * (last - first) / steps) : 0.0));
  }
  const double range[2] = { times.front(), times.back() };
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkInformation* info = outputs->GetInformationObject(port);
    info->Set(Pipeline::TIME_STEPS(), times.data(), static_cast<int>(times.size()));
    info->Set(Pipeline::TIME_RANGE(), range, 2);
  }
}

int CountOfTime(vtkInformation* output, int otherwise)
{
  if (!output->Has(Pipeline::UPDATE_TIME_STEP()))
  {
    return otherwise;
  }
  // Whatever time an application asks for, a NaN too.
  const double time = std::floor(output->Get(Pipeline::UPDATE_TIME_STEP()) + 1e-9);
  return time >= 1.0 ? static_cast<int>(std::min(time, 2e9)) : 1;
}
}
