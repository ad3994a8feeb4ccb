// SPDX-License-Identifier: BSD-3-Clause
#include "vtkRestoreSurface.h"

#include "Bridge/RestoredSurface.h"
#include "KernelBridge.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

vtkStandardNewMacro(vtkRestoreSurface);

vtkRestoreSurface::vtkRestoreSurface()
{
  this->SetNumberOfInputPorts(2);
}

void vtkRestoreSurface::SetOriginalConnection(vtkAlgorithmOutput* original)
{
  this->SetInputConnection(1, original);
}

void vtkRestoreSurface::SetOriginalData(vtkPolyData* original)
{
  this->SetInputData(1, original);
}

int vtkRestoreSurface::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
    return 1;
  }
  return this->Superclass::FillInputPortInformation(port, info);
}

int vtkRestoreSurface::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPolyData* prepared = vtkPolyData::GetData(inputVector[0]);
  vtkPolyData* original = vtkPolyData::GetData(inputVector[1]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  return cartan::RunGuarded(
    this, [&] { cartan::Warn(this, cartan::WriteRestoredSurface(prepared, original, output)); });
}
