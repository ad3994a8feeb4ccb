// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceMorph.h"

#include "Bridge/FilterRun.h"
#include "Bridge/KeyFrameMorph.h"
#include "Bridge/KeyFrameSteps.h"
#include "Kernel/Morph/DiscreteFormsMorph.h"
#include "Kernel/Morph/IsometricMorph.h"
#include "Kernel/Morph/LinearMorph.h"
#include "Kernel/Morph/PyramidCoordinatesMorph.h"
#include "Kernel/Morph/TriangleGradientMorph.h"

#include "vtkCompositeDataSet.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkWeakPointer.h"

#include <algorithm>
#include <cmath>
#include <map>

vtkStandardNewMacro(vtkSurfaceMorph);

using cartan::Error;
using cartan::ErrorCode;
using Pipeline = vtkStreamingDemandDrivenPipeline;

namespace
{
/// Up to this many key frames are used at a time.
constexpr int WindowSize = 4;

constexpr int MostWeights = 1000000;

/// The key frames that matter at t, first and one past the last, of those at
/// `parameters`: the two before and the two after.
std::pair<int, int> WindowAt(double t, const std::vector<double>& parameters)
{
  const int count = static_cast<int>(parameters.size());
  if (count <= WindowSize)
  {
    return { 0, count };
  }
  const int before = cartan::PlaceBetweenKeys(t, parameters).Before;
  return { std::max(before - 1, 0), std::min(before + 3, count) };
}
}

class vtkSurfaceMorph::Internals : public cartan::KeyFrameSteps
{
public:
  vtkMTimeType InputTime = 0;

  /// The last composite input: the executive shows only its blocks to RequestData.
  vtkWeakPointer<vtkCompositeDataSet> Composite;

  /// Where the key frames are in [0, 1].
  std::vector<double> Parameters;

  /// The key frames around the parameter that is asked for.
  cartan::KeySurfaces Keys;

  double ToTime(double parameter) const
  {
    return this->Times.empty()
      ? parameter
      : this->Times.front() + parameter * (this->Times.back() - this->Times.front());
  }
  double ToParameter(double time) const
  {
    const double parameter = this->Times.empty()
      ? time
      : (time - this->Times.front()) / (this->Times.back() - this->Times.front());
    return std::clamp(parameter, 0.0, 1.0);
  }

  /// The times of the output's steps, `count` from each key frame to the next. Each is
  /// one rounded quotient, .6 and not .6000000000000001, so that the times of several
  /// filters meet.
  std::vector<double> StepsBetween(int count) const
  {
    const std::size_t last = this->Parameters.size() - 1;
    std::vector<double> steps;
    for (std::size_t k = 0; k < last; ++k)
    {
      for (int step = 0; step < count; ++step)
      {
        steps.push_back(this->Times.empty()
            ? static_cast<double>(k * count + step) / static_cast<double>(last * count)
            : ((count - step) * this->Times[k] + step * this->Times[k + 1]) / count);
      }
    }
    steps.push_back(this->ToTime(1.0));
    return steps;
  }
};

vtkSurfaceMorph::vtkSurfaceMorph()
  : State(std::make_unique<Internals>())
{
}

vtkSurfaceMorph::~vtkSurfaceMorph() = default;

int vtkSurfaceMorph::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_IS_REPEATABLE(), 1);
  return this->Superclass::FillInputPortInformation(port, info);
}

int vtkSurfaceMorph::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  Internals& state = *this->State;
  const int inputs = inputVector[0]->GetNumberOfInformationObjects();
  state.Times.clear();
  state.Parameters.clear();
  if (inputs > 1)
  {
    for (int k = 0; k < inputs; ++k)
    {
      state.Parameters.push_back(static_cast<double>(k) / (inputs - 1));
    }
  }
  else if (inputs == 1)
  {
    vtkInformation* info = inputVector[0]->GetInformationObject(0);
    const int steps = info->Has(Pipeline::TIME_STEPS()) ? info->Length(Pipeline::TIME_STEPS()) : 0;
    if (steps > 1)
    {
      const double* times = info->Get(Pipeline::TIME_STEPS());
      state.Times.assign(times, times + steps);
      for (const double time : state.Times)
      {
        state.Parameters.push_back((time - times[0]) / (state.Times.back() - state.Times.front()));
      }
    }
    auto* upstream = vtkDemandDrivenPipeline::SafeDownCast(this->GetInputExecutive(0, 0));
    const vtkMTimeType inputTime = upstream ? upstream->GetPipelineMTime() : 0;
    if (inputTime != state.InputTime)
    {
      state.Steps.clear();
      state.InputTime = inputTime;
    }
  }

  vtkInformation* info = outputVector->GetInformationObject(0);
  info->Remove(Pipeline::TIME_STEPS());
  info->Remove(Pipeline::TIME_RANGE());
  if (this->FollowTime && !this->IsElsewhere() && state.Parameters.size() > 1 &&
    !state.FirstOutOfOrder())
  {
    const std::vector<double> steps = state.StepsBetween(this->StepsBetweenKeyFrames);
    const double range[2] = { steps.front(), steps.back() };
    info->Set(Pipeline::TIME_STEPS(), steps.data(), static_cast<int>(steps.size()));
    info->Set(Pipeline::TIME_RANGE(), range, 2);
  }
  return 1;
}

void vtkSurfaceMorph::SetNumberOfWeights(int count)
{
  if (count < 0 || count > MostWeights)
  {
    vtkErrorMacro("There are 0 to " << MostWeights << " weights; got " << count << ".");
    return;
  }
  std::vector<double> weights = this->Weights;
  weights.resize(count, 0.0);
  this->SetMember(this->Weights, weights);
}

void vtkSurfaceMorph::SetWeight(int keyFrame, double weight)
{
  if (keyFrame < 0 || keyFrame >= MostWeights)
  {
    vtkErrorMacro(
      "Weights are numbered from 0 to " << MostWeights - 1 << "; got " << keyFrame << ".");
    return;
  }
  this->SetNumberOfWeights(std::max(keyFrame + 1, this->GetNumberOfWeights()));
  this->SetMember(this->Weights[keyFrame], weight);
}

double vtkSurfaceMorph::GetWeight(int keyFrame) const
{
  return keyFrame >= 0 && keyFrame < this->GetNumberOfWeights() ? this->Weights[keyFrame] : 0.0;
}

/// All key frames may matter, or those around t.
std::pair<int, int> vtkSurfaceMorph::Window(double t) const
{
  const std::vector<double>& parameters = this->State->Parameters;
  return this->IsElsewhere() ? std::pair(0, static_cast<int>(parameters.size()))
                             : WindowAt(t, parameters);
}

double vtkSurfaceMorph::RequestedParameter(vtkInformation* output) const
{
  return this->FollowTime && output->Has(Pipeline::UPDATE_TIME_STEP())
    ? this->State->ToParameter(output->Get(Pipeline::UPDATE_TIME_STEP()))
    : this->Parameter;
}

int vtkSurfaceMorph::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  Internals& state = *this->State;
  for (int k = 0; k < inputVector[0]->GetNumberOfInformationObjects(); ++k)
  {
    vtkInformation* info = inputVector[0]->GetInformationObject(k);
    if (auto* whole = vtkCompositeDataSet::SafeDownCast(info->Get(vtkDataObject::DATA_OBJECT())))
    {
      state.Composite = whole;
    }
    // The time here is not that of the key frames.
    info->Remove(Pipeline::UPDATE_TIME_STEP());
  }
  if (!state.Times.empty())
  {
    const double requested = this->RequestedParameter(outputVector->GetInformationObject(0));
    const double t = std::isfinite(requested) ? requested : 0.0; // Execute() refuses it
    const int missing = state.NextMissing(this->Window(t));
    // With all there, what was asked for last costs the input nothing.
    state.Requested = missing >= 0 ? missing : state.Requested;
    inputVector[0]->GetInformationObject(0)->Set(
      Pipeline::UPDATE_TIME_STEP(), state.Times[state.Requested]);
  }
  return 1;
}

bool vtkSurfaceMorph::AcceptsEmptyInput() const
{
  return this->State->Parameters.size() < 2;
}

void vtkSurfaceMorph::ForgetResults()
{
  this->NumberOfIterations = 0;
  this->SetupTime = 0.0;
  this->EvaluationTime = 0.0;
}

int vtkSurfaceMorph::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  request->Remove(Pipeline::CONTINUE_EXECUTING());
  const int result = this->Superclass::RequestData(request, inputVector, outputVector);
  this->State->Keys = {};
  if (this->GetErrorCode())
  {
    this->State->Steps.clear();
  }
  else if (!request->Has(Pipeline::CONTINUE_EXECUTING()))
  {
    vtkInformation* info = outputVector->GetInformationObject(0);
    vtkPolyData::GetData(info)->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(),
      info->Has(Pipeline::UPDATE_TIME_STEP())
        ? info->Get(Pipeline::UPDATE_TIME_STEP())
        : this->State->ToTime(this->RequestedParameter(info)));
  }
  return result;
}

void vtkSurfaceMorph::FollowFirstRank(
  vtkInformation* request, vtkInformationVector** inputVector, bool hasEnded)
{
  Internals& state = *this->State;
  if (hasEnded)
  {
    state.Steps.clear();
  }
  else if (!state.Times.empty())
  {
    state.TakeStep(vtkPolyData::GetData(inputVector[0]));
    if (!request->Has(Pipeline::CONTINUE_EXECUTING()))
    {
      state.KeepSteps(this->Window(this->RequestedParameter(this->GetOutputInformation(0))));
    }
  }
}

void vtkSurfaceMorph::RequireKeyFrames(cartan::FilterRun& run) const
{
  const Internals& state = *this->State;
  if (cartan::IsBlockOf(state.Composite, run.InputObject()))
  {
    throw Error(ErrorCode::BadInput,
      "The input is a composite data set: make a surface of it (Merge Blocks, then Extract "
      "Surface), or one of each of its blocks (Extract Block first).");
  }
  if (state.Parameters.size() < 2)
  {
    throw Error(ErrorCode::BadInput,
      "There is one key frame only: give two surfaces or more, or one with time steps.");
  }
  if (const std::size_t k = state.FirstOutOfOrder())
  {
    throw Error(ErrorCode::BadInput,
      "The times of the input do not increase: time step " + std::to_string(k) + " is at " +
        std::to_string(state.Times[k]) + " after " + std::to_string(state.Times[k - 1]) +
        ". Give each time once, in increasing order.");
  }
}

/// Returns whether all key frames around t are there; else the pipeline is asked
/// for the next one.
bool vtkSurfaceMorph::CollectKeyFrames(cartan::FilterRun& run, double t)
{
  Internals& state = *this->State;
  const std::pair<int, int> window = this->Window(t);
  const bool hasTimes = !state.Times.empty();
  if (hasTimes)
  {
    state.TakeStep(run.Input());
    if (state.NextMissing(window) >= 0)
    {
      run.Request()->Set(Pipeline::CONTINUE_EXECUTING(), 1);
      return false;
    }
    state.KeepSteps(window);
  }
  state.Keys = {};
  state.Keys.Parameters.assign(
    state.Parameters.begin() + window.first, state.Parameters.begin() + window.second);
  for (int k = window.first; k < window.second; ++k)
  {
    state.Keys.Surfaces.push_back(hasTimes ? state.Steps.at(k).Get() : run.Input(0, k));
    state.Keys.Roles.push_back("key frame " + std::to_string(k) +
      (hasTimes ? " (time " + std::to_string(state.Times[k]) + ")" : ""));
  }
  return true;
}

void vtkSurfaceMorph::Execute(cartan::FilterRun& run)
{
  this->NumberOfKeyFrames = static_cast<int>(this->State->Parameters.size());
  this->RequireKeyFrames(run);
  const double t = this->RequestedParameter(run.OutputInformation());
  if (!std::isfinite(t))
  {
    throw Error(ErrorCode::BadInput, "Parameter is not a number: give one in [0, 1].");
  }
  if (!this->CollectKeyFrames(run, t))
  {
    return;
  }
  cartan::MorphOptions options;
  options.NewMorph = [this](const cartan::KeyFrames& keys, const cartan::ExecutionContext& context)
  { return this->NewMorph(keys, context); };
  for (const int setting : { this->Method, this->TransitionInterpolation, this->FrameSolver,
         this->Stitching, this->LengthPolish })
  {
    options.Settings.Add(static_cast<std::uint64_t>(setting));
  }
  options.NeedsPlacement = this->Method != LINEAR;
  options.IsPinned = this->Placement == PINNED_HANDLE;
  options.HandleArray = this->HandleArrayName;
  options.ParameterArray = this->ParameterArrayName;
  options.CloseVolume = this->CloseVolume;
  const cartan::MorphNumbers numbers = cartan::MorphAt(
    cartan::ReadPlace(t, this->Weights, this->ParameterArrayName, this->State->Keys),
    this->State->Keys, options, run);
  this->NumberOfIterations = numbers.Iterations;
  this->SetupTime = numbers.SetupTime;
  this->EvaluationTime = numbers.EvaluationTime;
  if (run.Pieces())
  {
    run.Output()->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), t);
  }
}

bool vtkSurfaceMorph::SupportsPieces() const
{
  return this->Method == LINEAR && !this->CloseVolume && this->ParameterArrayName.empty() &&
    this->State->Times.empty();
}

std::unique_ptr<cartan::SurfaceMorph> vtkSurfaceMorph::NewMorph(
  const cartan::KeyFrames& keys, const cartan::ExecutionContext& context) const
{
  static_assert(static_cast<int>(cartan::DiscreteFormsMorph::Transitions::Rotations) == ROTATIONS &&
      static_cast<int>(cartan::DiscreteFormsMorph::Transitions::Forms) == FORMS &&
      static_cast<int>(cartan::DiscreteFormsMorph::FrameSolver::RotationAveraging) ==
        ROTATION_AVERAGING &&
      static_cast<int>(cartan::DiscreteFormsMorph::FrameSolver::ConjugateGradients) ==
        CONJUGATE_GRADIENTS &&
      static_cast<int>(cartan::DiscreteFormsMorph::FrameSolver::Direct) == DIRECT &&
      static_cast<int>(cartan::IsometricMorphOptions::Method::Automatic) == ALL_HINGES &&
      static_cast<int>(cartan::IsometricMorphOptions::Method::TreeStitched) == TREE &&
      static_cast<int>(cartan::IsometricMorphOptions::Method::TreeAverage) == TREE_AVERAGE,
    "the enumerations agree");
  switch (this->Method)
  {
    case DISCRETE_FORMS:
      return std::make_unique<cartan::DiscreteFormsMorph>(keys,
        static_cast<cartan::DiscreteFormsMorph::Transitions>(this->TransitionInterpolation),
        static_cast<cartan::DiscreteFormsMorph::FrameSolver>(this->FrameSolver), context);
    case ISOMETRIC:
    {
      cartan::IsometricMorphOptions options;
      options.Type = static_cast<cartan::IsometricMorphOptions::Method>(this->Stitching);
      options.LengthPolish = this->LengthPolish;
      return std::make_unique<cartan::IsometricMorph>(keys, options, context);
    }
    case DEFORMATION_GRADIENT:
      return std::make_unique<cartan::TriangleGradientMorph>(keys, context);
    case PYRAMID_COORDINATES:
      return std::make_unique<cartan::PyramidCoordinatesMorph>(keys, context);
    default:
      return std::make_unique<cartan::LinearMorph>(keys);
  }
}

void vtkSurfaceMorph::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "Parameter: " << this->Parameter << "\n";
  os << indent << "ParameterArrayName: " << this->ParameterArrayName << "\n";
  for (std::size_t k = 0; k < this->Weights.size(); ++k)
  {
    os << indent << "Weight " << k << ": " << this->Weights[k] << "\n";
  }
  os << indent << "FollowTime: " << this->FollowTime << "\n";
  os << indent << "StepsBetweenKeyFrames: " << this->StepsBetweenKeyFrames << "\n";
  os << indent << "Placement: " << this->Placement << "\n";
  os << indent << "HandleArrayName: " << this->HandleArrayName << "\n";
  os << indent << "CloseVolume: " << this->CloseVolume << "\n";
  os << indent << "TransitionInterpolation: " << this->TransitionInterpolation << "\n";
  os << indent << "FrameSolver: " << this->FrameSolver << "\n";
  os << indent << "Stitching: " << this->Stitching << "\n";
  os << indent << "LengthPolish: " << this->LengthPolish << "\n";
  os << indent << "NumberOfIterations: " << this->NumberOfIterations << "\n";
  os << indent << "NumberOfKeyFrames: " << this->NumberOfKeyFrames << "\n";
  os << indent << "SetupTime: " << this->SetupTime << "\n";
  os << indent << "EvaluationTime: " << this->EvaluationTime << "\n";
}
