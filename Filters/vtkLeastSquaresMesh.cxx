// SPDX-License-Identifier: BSD-3-Clause
#include "vtkLeastSquaresMesh.h"

#include "Bridge/CountSteps.h"
#include "Bridge/FilterRun.h"
#include "Bridge/HandleArrays.h"
#include "Bridge/PointArrays.h"
#include "Bridge/SurfaceWriter.h"
#include "Kernel/Spectral/LeastSquaresMesh.h"

#include "vtkInformation.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>

vtkStandardNewMacro(vtkLeastSquaresMesh);

static_assert(
  static_cast<int>(cartan::AnchorSelection::FarthestPoint) == vtkLeastSquaresMesh::FARTHEST_POINT &&
    static_cast<int>(cartan::AnchorSelection::Greedy) == vtkLeastSquaresMesh::GREEDY,
  "the enumerations agree");

namespace
{
void FillTable(const cartan::LeastSquaresMesh& mesh, vtkTable* table)
{
  const auto rows = static_cast<vtkIdType>(mesh.GetRootMeanSquares().size());
  vtkNew<vtkIntArray> counts;
  counts->SetName("NumberOfAnchors");
  for (vtkIdType row = 0; row < rows; ++row)
  {
    counts->InsertNextValue(mesh.NumberOfBaseAnchors() + static_cast<int>(row));
  }
  table->AddColumn(counts);
  const auto column = [table](const char* name, const std::vector<double>& values)
  {
    cartan::AddColumn(table, name,
      Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
  };
  column("RootMeanSquareError", mesh.GetRootMeanSquares());
  column("MaximumError", mesh.GetMaxima());
}

void AddAnchors(const cartan::LeastSquaresMesh& mesh, int count, vtkPolyData* output)
{
  vtkNew<vtkIntArray> anchors;
  anchors->SetName("Anchor");
  anchors->SetNumberOfValues(output->GetNumberOfPoints());
  anchors->Fill(0.0);
  for (int i = 0; i < count; ++i)
  {
    anchors->SetValue(mesh.GetAnchors()[i], i + 1);
  }
  output->GetPointData()->AddArray(anchors);
}
}

vtkLeastSquaresMesh::vtkLeastSquaresMesh()
{
  this->SetNumberOfOutputPorts(2);
}

void vtkLeastSquaresMesh::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "AnchorSelection: " << this->AnchorSelection << "\n";
  os << indent << "NumberOfAnchors: " << this->NumberOfAnchors << "\n";
  os << indent << "HandleArrayName: " << this->HandleArrayName << "\n";
  os << indent << "PlayAnchors: " << this->PlayAnchors << "\n";
  os << indent << "GenerateBasisFunctions: " << this->GenerateBasisFunctions << "\n";
  os << indent << "BasisMemoryLimit: " << this->BasisMemoryLimit << "\n";
}

int vtkLeastSquaresMesh::FillOutputPortInformation(int port, vtkInformation* info)
{
  return port == 1 ? SetOutputType(info, "vtkTable")
                   : this->Superclass::FillOutputPortInformation(port, info);
}

vtkTable* vtkLeastSquaresMesh::GetErrorTable()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(1));
}

int vtkLeastSquaresMesh::RequestInformation(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (this->PlayAnchors && this->AnchorSelection != HANDLE)
  {
    cartan::SetCountSteps(outputVector, 1, this->NumberOfAnchors);
  }
  return this->Superclass::RequestInformation(request, inputVector, outputVector);
}

void vtkLeastSquaresMesh::Execute(cartan::FilterRun& run)
{
  const cartan::ExecutionContext& context = run.Context();
  vtkPolyData* input = run.Input();
  const auto surface = run.ReadSurface();
  const bool isGiven = this->AnchorSelection == HANDLE;
  cartan::ContentKey key = surface->Key;
  key.Add(static_cast<std::uint64_t>(this->AnchorSelection));
  std::vector<int> handles;
  if (isGiven)
  {
    handles = cartan::ReadHandles(input, *surface->Mesh, this->HandleArrayName).Points;
    std::sort(handles.begin(), handles.end());
    key.AddBytes(handles.data(), handles.size() * sizeof(int));
  }
  key.Add(static_cast<std::uint64_t>(isGiven ? 0 : this->NumberOfAnchors));
  key.Add(static_cast<std::uint64_t>(this->BasisMemoryLimit)); // which may refuse
  const std::uint64_t maximumBytes = std::uint64_t{ 1000000 } * this->BasisMemoryLimit;
  const auto mesh = run.Keep<cartan::LeastSquaresMesh>(key,
    [&]
    {
      if (isGiven)
      {
        return std::make_unique<cartan::LeastSquaresMesh>(*surface->Mesh, *surface->Positions,
          handles, maximumBytes, cartan::SolverBackend::Automatic, context.Part(0.1, 0.9));
      }
      cartan::LeastSquaresMesh::Settings settings;
      settings.Selection = static_cast<cartan::AnchorSelection>(this->AnchorSelection);
      settings.NumberOfAnchors = this->NumberOfAnchors;
      settings.MaximumBytes = maximumBytes;
      return std::make_unique<cartan::LeastSquaresMesh>(
        *surface->Mesh, *surface->Positions, settings, context.Part(0.1, 0.9));
    });

  const auto all = static_cast<int>(mesh->GetAnchors().size());
  const bool isPlayed = this->PlayAnchors && !isGiven;
  const int count = std::clamp(isPlayed ? cartan::CountOfTime(run.OutputInformation(), all) : all,
    mesh->NumberOfBaseAnchors(), all);
  const cartan::Points points = mesh->Surface(count);
  run.Warn(cartan::WriteSurface(*surface, points, input, run.Output(), context.Part(0.9, 1.0)));
  AddAnchors(*mesh, count, run.Output());
  cartan::AddPointArray(run.Output(), "ApproximationError",
    Eigen::VectorXd((points - *surface->Positions).rowwise().norm()));
  if (this->GenerateBasisFunctions)
  {
    cartan::AddArray(run.Output()->GetPointData(), "BasisFunctions", mesh->BasisFunctions(count));
  }
  FillTable(*mesh, run.OutputTable(1));
  if (isPlayed)
  {
    run.Output()->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), count);
  }
  context.Report(1.0);
}
