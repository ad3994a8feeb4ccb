// SPDX-License-Identifier: BSD-3-Clause
#include "vtkRestoreSurface.h"

#include "Bridge/FilterRun.h"
#include "Bridge/RestoredSurface.h"

#include "vtkInformation.h"
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
  return port == 1 ? SetPortType(info, "vtkPolyData")
                   : this->Superclass::FillInputPortInformation(port, info);
}

void vtkRestoreSurface::Execute(cartan::FilterRun& run)
{
  run.Warn(cartan::WriteRestoredSurface(run.Input(0), run.Input(1), run.Output()));
}
