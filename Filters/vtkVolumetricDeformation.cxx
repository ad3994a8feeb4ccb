// SPDX-License-Identifier: BSD-3-Clause
#include "vtkVolumetricDeformation.h"

#include "Bridge/DeformationMethod.h"
#include "Bridge/VolumeMesh.h"
#include "Kernel/Deformation/LatticeGraph.h"
#include "Kernel/Deformation/VolumetricDeformer.h"

#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <utility>

vtkStandardNewMacro(vtkVolumetricDeformation);

vtkVolumetricDeformation::vtkVolumetricDeformation()
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
}

vtkVolumetricDeformation::~vtkVolumetricDeformation() = default;

void vtkVolumetricDeformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "LatticeSpacing: " << this->LatticeSpacing << "\n";
  os << indent << "OuterLayer: " << this->OuterLayer << "\n";
  os << indent << "VolumeRounds: " << this->VolumeRounds << "\n";
  os << indent << "NumberOfAddedPoints: " << this->NumberOfAddedPoints << "\n";
  os << indent << "NumberOfInvertedCells: " << this->NumberOfInvertedCells << "\n";
}

void vtkVolumetricDeformation::SetVolumeMeshData(vtkUnstructuredGrid* mesh)
{
  this->SetInputData(1, mesh);
}

vtkUnstructuredGrid* vtkVolumetricDeformation::GetVolumeMesh()
{
  return vtkUnstructuredGrid::SafeDownCast(this->GetOutputDataObject(1));
}

int vtkVolumetricDeformation::FillInputPortInformation(int port, vtkInformation* info)
{
  return port == 1 ? SetPortType(info, "vtkUnstructuredGrid", true)
                   : this->Superclass::FillInputPortInformation(port, info);
}

int vtkVolumetricDeformation::FillOutputPortInformation(int port, vtkInformation* info)
{
  return port == 1 ? SetOutputType(info, "vtkUnstructuredGrid")
                   : this->Superclass::FillOutputPortInformation(port, info);
}

void vtkVolumetricDeformation::ForgetResults()
{
  this->Superclass::ForgetResults();
  this->NumberOfAddedPoints = 0;
  this->NumberOfInvertedCells = 0;
}

void vtkVolumetricDeformation::RequireTargets(const cartan::HandleTargets& targets) const
{
  cartan::VolumetricDeformer::RequireMotions(targets);
}

void vtkVolumetricDeformation::AddSettings(cartan::ContentKey& settings) const
{
  this->Superclass::AddSettings(settings);
  settings.Add(this->LatticeSpacing);
  settings.Add(static_cast<std::uint64_t>(this->OuterLayer));
  settings.Add(this->Mesh ? this->Mesh->Key.GetValue() : 0);
}

void vtkVolumetricDeformation::Execute(cartan::FilterRun& run)
{
  this->Mesh.reset();
  auto* grid = vtkUnstructuredGrid::SafeDownCast(run.InputObject(1));
  if (grid && grid->GetNumberOfPoints() + grid->GetNumberOfCells() > 0)
  {
    this->Surface = cartan::ReadSurface(run.Input(), "input", run.Context().Part(0.0, 0.1));
    this->Mesh = run.Keep<cartan::VolumeMesh>(cartan::KeyOfVolumeMesh(*this->Surface, grid),
      [&] {
        return std::make_unique<cartan::VolumeMesh>(cartan::ReadVolumeMesh(*this->Surface, grid));
      });
  }
  this->Superclass::Execute(run);
  this->Mesh.reset();
  this->Surface.reset();
}

cartan::DeformationMethod vtkVolumetricDeformation::NewMethod(const cartan::HandleProblem& problem,
  cartan::SolverBackend backend, const cartan::ExecutionContext& context)
{
  cartan::VolumeGraph graph;
  const cartan::Points& rest = *problem.Rest;
  if (this->Mesh)
  {
    cartan::Points nodes(rest.rows() + this->Mesh->Inner.rows(), 3);
    nodes << rest, this->Mesh->Inner;
    graph = cartan::MakeTetrahedronGraph(nodes, this->Mesh->Cells);
  }
  else
  {
    cartan::LatticeOptions options;
    options.Spacing = this->LatticeSpacing;
    options.OuterLayer = this->OuterLayer;
    options.Weights = problem.Weights;
    graph = cartan::MakeLatticeGraph(*problem.GetWhole(), rest, options, context.Part(0.0, 0.5));
  }
  auto deformer = std::make_unique<cartan::VolumetricDeformer>(
    problem, std::move(graph), backend, context.Part(0.5, 1.0));
  auto* volumetric = deformer.get();
  cartan::DeformationMethod method;
  method.Deformer = std::move(deformer);
  method.Configure = [this, volumetric](cartan::FilterRun&, const cartan::ExecutionContext&)
  { volumetric->SetVolumeRounds(this->VolumeRounds); };
  method.Decorate = [this, volumetric](
                      const cartan::DeformedSurface& result, cartan::FilterRun& run)
  {
    const cartan::VolumeGraph& ofMethod = volumetric->GetGraph();
    this->NumberOfAddedPoints =
      ofMethod.NumberOfNodes() - static_cast<int>(result.Positions.rows());
    if (!this->Mesh)
    {
      return;
    }
    const cartan::Points nodes = volumetric->NodesAfter(result);
    cartan::WriteVolumeMesh(*this->Surface, *this->Mesh, nodes,
      vtkUnstructuredGrid::SafeDownCast(run.InputObject(1)),
      vtkUnstructuredGrid::SafeDownCast(run.OutputObject(1)));
    const std::vector<long long> names(this->Mesh->CellIds.begin(), this->Mesh->CellIds.end());
    const cartan::IdSample inverted =
      cartan::InvertedTetrahedra(ofMethod.Nodes, nodes, this->Mesh->Cells).Renamed(names);
    this->NumberOfInvertedCells = static_cast<int>(inverted.GetCount());
    if (!inverted.IsEmpty())
    {
      run.Warn(inverted.Describe("cell", "cells") +
        " of the volume mesh turned inside out: move the handles less far.");
    }
  };
  return method;
}
