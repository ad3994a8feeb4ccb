// SPDX-License-Identifier: BSD-3-Clause
#include "vtkExampleBasedDeformation.h"

#include "Bridge/DeformationMethod.h"
#include "Bridge/MatchedSurfaces.h"
#include "Kernel/Deformation/ExampleBasedDeformer.h"

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <string>
#include <vector>

namespace
{
constexpr vtkIdType MostWeightsInCharts = 16; // each is a line of a chart over time

/// The weights as one array, and as numbers of their own: charts over time leave out arrays
/// of several.
void AddToFieldData(vtkDoubleArray* weights, vtkPolyData* output)
{
  vtkNew<vtkDoubleArray> copy;
  copy->DeepCopy(weights);
  output->GetFieldData()->AddArray(copy);
  const vtkIdType count = weights->GetNumberOfTuples();
  for (vtkIdType k = 0; k < count && count <= MostWeightsInCharts; ++k)
  {
    vtkNew<vtkDoubleArray> weight;
    weight->SetName(("Weight of example " + std::to_string(k)).c_str());
    weight->InsertNextValue(weights->GetValue(k));
    output->GetFieldData()->AddArray(weight);
  }
}
}

vtkStandardNewMacro(vtkExampleBasedDeformation);

class vtkExampleBasedDeformation::Internals
{
public:
  vtkNew<vtkDoubleArray> Weights;
  /// While an update goes on.
  std::vector<std::shared_ptr<const cartan::Points>> Examples;
  cartan::ContentKey Key;
};

vtkExampleBasedDeformation::vtkExampleBasedDeformation()
  : Own(std::make_unique<Internals>())
{
  this->SetNumberOfInputPorts(2);
}

vtkExampleBasedDeformation::~vtkExampleBasedDeformation() = default;

void vtkExampleBasedDeformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "WarmStart: " << this->WarmStart << "\n";
  os << indent << "Rigidness: " << this->Rigidness << "\n";
  os << indent << "MaximumIterations: " << this->MaximumIterations << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "SpanDistance: " << this->SpanDistance << "\n";
  os << indent << "NumberOfIterations: " << this->NumberOfIterations << "\n";
  os << indent << "Converged: " << this->Converged << "\n";
}

void vtkExampleBasedDeformation::AddExampleData(vtkPolyData* example)
{
  this->AddInputDataInternal(1, example);
}

vtkDoubleArray* vtkExampleBasedDeformation::GetExampleWeights()
{
  return this->Own->Weights;
}

int vtkExampleBasedDeformation::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_REPEATABLE(), 1);
    return SetPortType(info, "vtkPolyData", true);
  }
  return this->Superclass::FillInputPortInformation(port, info);
}

void vtkExampleBasedDeformation::ForgetResults()
{
  this->Superclass::ForgetResults();
  this->Own->Weights->Initialize();
  this->SpanDistance = 0.0;
  this->NumberOfIterations = 0;
  this->Converged = false;
}

void vtkExampleBasedDeformation::AddSettings(cartan::ContentKey& settings) const
{
  this->Superclass::AddSettings(settings);
  settings.Add(this->Own->Key.GetValue());
}

void vtkExampleBasedDeformation::Execute(cartan::FilterRun& run)
{
  std::vector<vtkPolyData*> surfaces = { run.Input() };
  std::vector<std::string> roles = { "input" };
  for (int k = 0; k < run.NumberOfConnections(1); ++k)
  {
    surfaces.push_back(run.Input(1, k));
    roles.push_back("example " + std::to_string(k));
  }
  if (surfaces.size() < 2)
  {
    throw cartan::Error(cartan::ErrorCode::BadInput,
      "There are no examples: connect other poses of the surface (Examples).");
  }
  const cartan::MatchedSurfaces matched = cartan::ReadMatchedSurfaces(surfaces, roles,
    "Examples are poses of one surface: give the same points and cells in the same order.",
    run.Context().Part(0.0, 0.1));
  Internals& own = *this->Own;
  own.Key = {};
  own.Examples.clear();
  for (std::size_t k = 0; k < surfaces.size(); ++k)
  {
    run.KeepSurface(matched.Surfaces[k]);
    own.Key.Add(matched.Surfaces[k]->Key.GetValue());
    if (k > 0)
    {
      own.Examples.push_back(matched.Positions[k]);
    }
  }
  this->Superclass::Execute(run);
  own.Examples.clear();
}

cartan::DeformationMethod vtkExampleBasedDeformation::NewMethod(
  const cartan::HandleProblem& problem, cartan::SolverBackend backend,
  const cartan::ExecutionContext& context)
{
  std::vector<cartan::Points> examples;
  for (const auto& example : this->Own->Examples)
  {
    examples.push_back(*example);
  }
  auto deformer =
    std::make_unique<cartan::ExampleBasedDeformer>(problem, examples, backend, context);
  auto* fitted = deformer.get();
  cartan::DeformationMethod method;
  method.Deformer = std::move(deformer);
  method.Configure = [this, fitted](cartan::FilterRun&, const cartan::ExecutionContext&)
  {
    fitted->SetIteration(this->MaximumIterations, this->Tolerance);
    fitted->SetWarmStart(this->WarmStart);
    fitted->SetRigidness(this->Rigidness);
  };
  method.Decorate = [this, fitted](const cartan::DeformedSurface&, cartan::FilterRun& run)
  {
    vtkDoubleArray* weights = this->Own->Weights;
    weights->SetName("ExampleWeights");
    weights->SetNumberOfTuples(fitted->GetWeights().size());
    for (Eigen::Index k = 0; k < fitted->GetWeights().size(); ++k)
    {
      weights->SetValue(k, fitted->GetWeights()[k]);
    }
    AddToFieldData(weights, run.Output());
    this->SpanDistance = fitted->GetDistance();
    this->NumberOfIterations = fitted->GetNumberOfIterations();
    this->Converged = fitted->HasConverged();
  };
  return method;
}
