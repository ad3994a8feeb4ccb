// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDiscreteForms.h"

#include "Kernel/Differential/DiscreteForms.h"
#include "KernelBridge.h"

#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

vtkStandardNewMacro(vtkDiscreteForms);

namespace
{
template <typename Array>
Array* AddColumn(vtkTable* table, const char* name, int numberOfRows)
{
  vtkNew<Array> column;
  column->SetName(name);
  column->SetNumberOfValues(numberOfRows);
  table->AddColumn(column);
  return column;
}

void FillTable(
  const cartan::TriangleMesh& mesh, const cartan::DiscreteForms& forms, vtkTable* table)
{
  const int numberOfRows = mesh.NumberOfDirectedEdges();
  auto* vertices = AddColumn<vtkIdTypeArray>(table, "Vertex", numberOfRows);
  auto* neighbors = AddColumn<vtkIdTypeArray>(table, "Neighbor", numberOfRows);
  auto* lengths = AddColumn<vtkDoubleArray>(table, "Length", numberOfRows);
  auto* angles = AddColumn<vtkDoubleArray>(table, "Angle", numberOfRows);
  auto* heights = AddColumn<vtkDoubleArray>(table, "Height", numberOfRows);
  auto* orientations = AddColumn<vtkIntArray>(table, "Orientation", numberOfRows);
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      vertices->SetValue(d, v);
      neighbors->SetValue(d, mesh.Neighbor(d));
      lengths->SetValue(d, forms.Length[d]);
      angles->SetValue(d, forms.Angle[d]);
      heights->SetValue(d, forms.Height[d]);
      orientations->SetValue(d, forms.Orientation[d]);
    }
  }
}
}

vtkDiscreteForms::vtkDiscreteForms()
{
  this->SetNumberOfOutputPorts(2);
}

int vtkDiscreteForms::FillOutputPortInformation(int port, vtkInformation* info)
{
  if (port == 1)
  {
    info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkTable");
    return 1;
  }
  return this->Superclass::FillOutputPortInformation(port, info);
}

vtkTable* vtkDiscreteForms::GetFormsTable()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(1));
}

int vtkDiscreteForms::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPolyData* input = vtkPolyData::GetData(inputVector[0]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector, 0);
  vtkTable* table = vtkTable::GetData(outputVector, 1);
  return cartan::RunGuarded(this,
    [this, input, output, table]()
    {
      const cartan::ExecutionContext context = cartan::MakeContext(this);
      const cartan::Surface surface = cartan::ReadSurface(input);
      cartan::Warn(this, surface.Warning);
      context.Report(0.3);
      const cartan::Matrices frames =
        cartan::VertexFrames(surface.Mesh, surface.Positions, context);
      context.Report(0.5);
      const cartan::DiscreteForms forms =
        cartan::ComputeDiscreteForms(surface.Mesh, surface.Positions, frames, context);
      context.Report(0.7);
      output->ShallowCopy(input);
      cartan::AddFrameArrays(output, frames);
      FillTable(surface.Mesh, forms, table);
      context.Report(1.0);
    });
}
