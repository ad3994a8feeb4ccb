// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDiscreteForms.h"

#include "Bridge/FilterRun.h"
#include "Bridge/PointArrays.h"
#include "Kernel/Differential/DiscreteForms.h"

#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
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
  return port == 1 ? SetOutputType(info, "vtkTable")
                   : this->Superclass::FillOutputPortInformation(port, info);
}

vtkTable* vtkDiscreteForms::GetFormsTable()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(1));
}

void vtkDiscreteForms::Execute(cartan::FilterRun& run)
{
  const cartan::ExecutionContext& context = run.Context();
  const auto surface = run.ReadSurface();
  const cartan::Matrices frames =
    cartan::VertexFrames(*surface->Mesh, *surface->Positions, context.Part(0.1, 0.5));
  const cartan::DiscreteForms forms = cartan::ComputeDiscreteForms(
    *surface->Mesh, *surface->Positions, frames, context.Part(0.5, 0.8));
  run.Output()->ShallowCopy(run.Input());
  cartan::AddFrameArrays(run.Output(), frames);
  FillTable(*surface->Mesh, forms, run.OutputTable(1));
  context.Report(1.0);
}
