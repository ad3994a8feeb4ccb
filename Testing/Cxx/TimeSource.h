// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkPolyDataAlgorithm.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace vtktest
{
/// Surfaces at time steps, made on request.
class TimeSource : public vtkPolyDataAlgorithm
{
public:
  static TimeSource* New() { VTK_STANDARD_NEW_BODY(TimeSource); }
  vtkTypeMacro(TimeSource, vtkPolyDataAlgorithm);

  void SetSteps(std::vector<double> times, std::vector<vtkSmartPointer<vtkPolyData>> surfaces)
  {
    this->Times = std::move(times);
    this->Surfaces = std::move(surfaces);
    this->Modified();
  }
  std::vector<double> Requests;

protected:
  TimeSource() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override
  {
    const double range[2] = { this->Times.front(), this->Times.back() };
    vtkInformation* info = outputVector->GetInformationObject(0);
    info->Set(vtkStreamingDemandDrivenPipeline::TIME_STEPS(), this->Times.data(),
      static_cast<int>(this->Times.size()));
    info->Set(vtkStreamingDemandDrivenPipeline::TIME_RANGE(), range, 2);
    return 1;
  }
  int RequestData(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override
  {
    const double time = outputVector->GetInformationObject(0)->Get(
      vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP());
    this->Requests.push_back(time);
    const auto step = std::find(this->Times.begin(), this->Times.end(), time);
    EXPECT_NE(step, this->Times.end()) << "no time step: " << time;
    vtkPolyData::GetData(outputVector)
      ->DeepCopy(this->Surfaces[static_cast<std::size_t>(step - this->Times.begin())]);
    return 1;
  }

private:
  std::vector<double> Times;
  std::vector<vtkSmartPointer<vtkPolyData>> Surfaces;
};
}
