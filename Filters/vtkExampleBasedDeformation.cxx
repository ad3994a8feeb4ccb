// SPDX-License-Identifier: BSD-3-Clause
#include "vtkExampleBasedDeformation.h"

#include "Bridge/CarryingMethod.h"
#include "Bridge/DeformationMethod.h"
#include "Bridge/KeyFrameSteps.h"
#include "Bridge/MatchedSurfaces.h"
#include "Kernel/Deformation/ExampleBasedDeformer.h"

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

using cartan::Error;
using cartan::ErrorCode;
using Pipeline = vtkStreamingDemandDrivenPipeline;

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

  /// The examples over time, and the states of their input, and of the surface at rest that
  /// they are prepared like (0 where they are not), that they belong to.
  cartan::KeyFrameSteps OverTime;
  std::pair<vtkMTimeType, vtkMTimeType> Times;
  std::pair<int, int> AllSteps() const
  {
    return { 0, static_cast<int>(this->OverTime.Times.size()) };
  }

  /// While an update goes on.
  std::vector<vtkPolyData*> Surfaces; // at rest, then the examples
  std::vector<std::string> Roles;
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
  os << indent << "ExamplesOverTime: " << this->ExamplesOverTime << "\n";
  os << indent << "WarmStart: " << this->WarmStart << "\n";
  os << indent << "Rigidness: " << this->Rigidness << "\n";
  os << indent << "RigidMethod: " << this->RigidMethod << "\n";
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
  settings.Add(static_cast<std::uint64_t>(this->RigidMethod));
}

int vtkExampleBasedDeformation::RequestInformation(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  Internals& own = *this->Own;
  own.OverTime.Times.clear();
  if (this->ExamplesOverTime && this->GetNumberOfInputConnections(1) == 1)
  {
    vtkInformation* info = inputVector[1]->GetInformationObject(0);
    const int steps = info->Has(Pipeline::TIME_STEPS()) ? info->Length(Pipeline::TIME_STEPS()) : 0;
    const double* times = info->Get(Pipeline::TIME_STEPS());
    own.OverTime.Times.assign(times, times + steps);
    const auto timeOf = [this](int port) -> vtkMTimeType
    {
      auto* upstream = vtkDemandDrivenPipeline::SafeDownCast(this->GetInputExecutive(port, 0));
      return upstream ? upstream->GetPipelineMTime() : 0;
    };
    const std::pair<vtkMTimeType, vtkMTimeType> inputTimes = { timeOf(1),
      this->GetPrepareInput() ? timeOf(0) : 0 };
    if (inputTimes != own.Times)
    {
      own.OverTime.Steps.clear();
      own.Times = inputTimes;
    }
  }
  else
  {
    own.OverTime.Steps.clear();
  }
  return this->Superclass::RequestInformation(request, inputVector, outputVector);
}

int vtkExampleBasedDeformation::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const int result = this->Superclass::RequestUpdateExtent(request, inputVector, outputVector);
  cartan::KeyFrameSteps& steps = this->Own->OverTime;
  if (!steps.Times.empty())
  {
    const int missing = steps.NextMissing(this->Own->AllSteps());
    // With all there, what was asked for last costs the input nothing.
    steps.Requested =
      std::min(missing >= 0 ? missing : steps.Requested, this->Own->AllSteps().second - 1);
    inputVector[1]->GetInformationObject(0)->Set(
      Pipeline::UPDATE_TIME_STEP(), steps.Times[steps.Requested]);
  }
  return result;
}

int vtkExampleBasedDeformation::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  request->Remove(Pipeline::CONTINUE_EXECUTING());
  const int result = this->Superclass::RequestData(request, inputVector, outputVector);
  this->Own->Surfaces.clear();
  this->Own->Roles.clear();
  if (this->GetErrorCode())
  {
    this->Own->OverTime.Steps.clear();
  }
  return result;
}

void vtkExampleBasedDeformation::FollowFirstRank(
  vtkInformation* vtkNotUsed(request), vtkInformationVector** inputVector, bool hasEnded)
{
  cartan::KeyFrameSteps& steps = this->Own->OverTime;
  if (hasEnded)
  {
    steps.Steps.clear();
  }
  else if (!steps.Times.empty())
  {
    steps.TakeStep(vtkPolyData::GetData(inputVector[1]));
  }
}

/// Returns whether all examples are there; else the pipeline is asked for the next one.
bool vtkExampleBasedDeformation::CollectExamples(cartan::FilterRun& run)
{
  Internals& own = *this->Own;
  own.Surfaces = { run.Input() };
  own.Roles = { "input" };
  const int connections = run.NumberOfConnections(1);
  if (this->ExamplesOverTime && connections > 1)
  {
    throw Error(ErrorCode::BadInput,
      "Time steps of one surface are to be the examples, but there are " +
        std::to_string(connections) +
        " surfaces: connect one with time steps, or turn ExamplesOverTime off.");
  }
  cartan::KeyFrameSteps& steps = own.OverTime;
  if (steps.Times.empty())
  {
    for (int k = 0; k < connections; ++k)
    {
      own.Surfaces.push_back(run.Input(1, k));
      own.Roles.push_back("example " + std::to_string(k));
    }
    return true;
  }
  if (const std::size_t k = steps.FirstOutOfOrder())
  {
    throw Error(ErrorCode::BadInput,
      "The times of the examples do not increase: time step " + std::to_string(k) + " is at " +
        std::to_string(steps.Times[k]) + " after " + std::to_string(steps.Times[k - 1]) +
        ". Give each time once, in increasing order.");
  }
  steps.TakeStep(run.Input(1, 0));
  if (steps.NextMissing(own.AllSteps()) >= 0)
  {
    run.Request()->Set(Pipeline::CONTINUE_EXECUTING(), 1);
    return false;
  }
  steps.KeepSteps(own.AllSteps());
  for (int k = 0; k < own.AllSteps().second; ++k)
  {
    own.Surfaces.push_back(steps.Steps.at(k));
    own.Roles.push_back(
      "example " + std::to_string(k) + " (time " + std::to_string(steps.Times[k]) + ")");
  }
  return true;
}

void vtkExampleBasedDeformation::Execute(cartan::FilterRun& run)
{
  if (!this->CollectExamples(run))
  {
    return;
  }
  Internals& own = *this->Own;
  if (own.Surfaces.size() < 2)
  {
    throw Error(
      ErrorCode::BadInput, "There are no examples: connect other poses of the surface (Examples).");
  }
  const cartan::MatchedSurfaces matched = cartan::ReadMatchedSurfaces(own.Surfaces, own.Roles,
    "Examples are poses of one surface: give the same points and cells in the same order.",
    run.Context().Part(0.0, 0.1));
  own.Key = {};
  own.Examples.clear();
  for (std::size_t k = 0; k < own.Surfaces.size(); ++k)
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
  const auto rigid = [backend, kind = static_cast<cartan::CarryingMethod>(this->RigidMethod)](
                       const cartan::HandleProblem& ofRigid, const cartan::ExecutionContext& part)
  { return cartan::NewCarryingDeformer(kind, true, ofRigid, backend, part); };
  method.Configure = [this, fitted, rigid](cartan::FilterRun&, const cartan::ExecutionContext&)
  {
    fitted->SetIteration(this->MaximumIterations, this->Tolerance);
    fitted->SetWarmStart(this->WarmStart);
    fitted->SetRigidness(this->Rigidness, rigid);
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
