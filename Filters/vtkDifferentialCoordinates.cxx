// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDifferentialCoordinates.h"

#include "Bridge/FilterRun.h"
#include "Bridge/PointArrays.h"
#include "Kernel/Differential/DifferentialCoordinates.h"

#include "vtkFieldData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

vtkStandardNewMacro(vtkDifferentialCoordinates);

void vtkDifferentialCoordinates::Execute(cartan::FilterRun& run)
{
  const cartan::ExecutionContext& context = run.Context();
  const auto surface = run.ReadSurface();
  const cartan::TriangleMesh& mesh = *surface->Mesh;
  const cartan::DifferentialOperator row(mesh, *surface->Positions,
    static_cast<cartan::LaplacianWeights>(this->LaplacianWeights),
    static_cast<cartan::DeltaNormalization>(this->Normalization), context.Part(0.1, 0.7));
  run.Output()->ShallowCopy(run.Input());
  const std::string& name = this->DifferentialCoordinatesArrayName;
  cartan::AddPointArray(
    run.Output(), name, row.Apply(mesh, *surface->Positions, context.Part(0.7, 1.0)));
  vtkNew<vtkUnsignedCharArray> areDefined;
  areDefined->SetName((name + "AreDefined").c_str());
  areDefined->SetNumberOfValues(run.Input()->GetNumberOfPoints());
  for (int v = 0; v < static_cast<int>(areDefined->GetNumberOfValues()); ++v)
  {
    areDefined->SetValue(v, mesh.IsUsed(v) && !mesh.IsBoundary(v) ? 1 : 0);
  }
  run.Output()->GetPointData()->AddArray(areDefined);
  vtkNew<vtkIntArray> operation;
  operation->SetName((name + "Operator").c_str());
  operation->InsertNextValue(this->LaplacianWeights);
  operation->InsertNextValue(this->Normalization);
  run.Output()->GetFieldData()->AddArray(operation);
  context.Report(1.0);
}
