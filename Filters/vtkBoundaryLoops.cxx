// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBoundaryLoops.h"

#include "Bridge/FilterRun.h"
#include "Bridge/PointArrays.h"
#include "Kernel/Mesh/BoundaryLoops.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

vtkStandardNewMacro(vtkBoundaryLoops);

namespace
{
/// The boundary's points with their arrays, and a closed polyline per loop.
void WriteCurves(
  const std::vector<cartan::BoundaryLoop>& loops, vtkPolyData* input, vtkPolyData* output)
{
  vtkIdType count = 0;
  for (const cartan::BoundaryLoop& loop : loops)
  {
    count += static_cast<vtkIdType>(loop.Vertices.size());
  }
  vtkNew<vtkPoints> points;
  points->SetDataType(input->GetPoints()->GetDataType());
  points->SetNumberOfPoints(count);
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("OriginalPointIds");
  vtkNew<vtkCellArray> lines;
  output->GetPointData()->CopyAllocate(input->GetPointData(), count);
  for (const cartan::BoundaryLoop& loop : loops)
  {
    const vtkIdType first = ids->GetNumberOfValues();
    lines->InsertNextCell(static_cast<int>(loop.Vertices.size()) + 1);
    for (const vtkIdType v : loop.Vertices)
    {
      const vtkIdType point = ids->InsertNextValue(v);
      points->SetPoint(point, input->GetPoint(v));
      output->GetPointData()->CopyData(input->GetPointData(), v, point);
      lines->InsertCellPoint(point);
    }
    lines->InsertCellPoint(first);
  }
  output->SetPoints(points);
  output->SetLines(lines);
  output->GetPointData()->AddArray(ids);
}

void AddMeasures(const std::vector<cartan::BoundaryLoop>& loops, const cartan::Surface& surface,
  vtkPolyData* output)
{
  const auto count = static_cast<Eigen::Index>(loops.size());
  Eigen::VectorXd lengths(count);
  Eigen::VectorXd areas(count);
  cartan::Points normals(count, 3);
  cartan::Points centers(count, 3);
  vtkNew<vtkIntArray> numbers;
  numbers->SetName("Loop");
  vtkNew<vtkIntArray> sizes;
  sizes->SetName("NumberOfPoints");
  vtkNew<vtkIntArray> components;
  components->SetName("Component");
  for (Eigen::Index i = 0; i < count; ++i)
  {
    const cartan::BoundaryLoop& loop = loops[i];
    const cartan::LoopMeasures measures =
      cartan::MeasureLoop((*surface.Positions)(loop.Vertices, Eigen::all));
    lengths[i] = measures.Length;
    areas[i] = measures.AreaVector.norm();
    normals.row(i).setZero();
    if (areas[i] > 0.0)
    {
      normals.row(i) = -measures.AreaVector.transpose() / areas[i];
    }
    centers.row(i) = (measures.Center + surface.Origin).transpose();
    numbers->InsertNextValue(static_cast<int>(i) + 1);
    sizes->InsertNextValue(static_cast<int>(loop.Vertices.size()));
    components->InsertNextValue(loop.Component);
  }
  vtkCellData* cells = output->GetCellData();
  cells->AddArray(numbers);
  cells->AddArray(sizes);
  cells->AddArray(components);
  cartan::AddArray(cells, "Length", lengths);
  cartan::AddArray(cells, "Area", areas);
  cartan::AddArray(cells, "Normal", normals);
  cartan::AddArray(cells, "Center", centers);
}
}

void vtkBoundaryLoops::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NumberOfLoops: " << this->NumberOfLoops << "\n";
}

void vtkBoundaryLoops::Execute(cartan::FilterRun& run)
{
  const auto surface = run.ReadSurface();
  const std::vector<cartan::BoundaryLoop> loops = cartan::FindBoundaryLoops(*surface->Mesh);
  WriteCurves(loops, run.Input(), run.Output());
  AddMeasures(loops, *surface, run.Output());
  this->NumberOfLoops = static_cast<int>(loops.size());
  run.Context().Report(1.0);
}
