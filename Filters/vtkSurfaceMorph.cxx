// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceMorph.h"

#include "Kernel/Morph/DiscreteFormsMorph.h"
#include "Kernel/Morph/IsometricMorph.h"
#include "Kernel/Morph/LinearMorph.h"
#include "Kernel/Morph/MorphVolume.h"
#include "Kernel/Morph/RigidPlacement.h"
#include "Kernel/Morph/TriangleGradientMorph.h"
#include "SurfacePair.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTimerLog.h"
#include "vtkWeakPointer.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

vtkStandardNewMacro(vtkSurfaceMorph);

using cartan::Error;
using cartan::ErrorCode;
using Pipeline = vtkStreamingDemandDrivenPipeline;

namespace
{
/// Up to this many key frames are used at a time.
constexpr int WindowSize = 4;

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

bool IsBlockOf(vtkCompositeDataSet* composite, vtkPolyData* surface)
{
  if (!composite)
  {
    return false;
  }
  bool isFound = false;
  auto blocks = vtk::TakeSmartPointer(composite->NewIterator());
  for (blocks->InitTraversal(); !blocks->IsDoneWithTraversal(); blocks->GoToNextItem())
  {
    isFound = isFound || blocks->GetCurrentDataObject() == surface;
  }
  return isFound;
}

/// Floating-point arrays that all have, but for normals.
void InterpolatePointData(const std::vector<vtkPolyData*>& keys,
  const std::vector<double>& parameters, double t, vtkPolyData* output,
  const cartan::ExecutionContext& context)
{
  vtkPointData* first = keys.front()->GetPointData();
  for (int index = 0; index < first->GetNumberOfArrays(); ++index)
  {
    vtkDataArray* array = first->GetArray(index);
    if (!array || !array->GetName() || array == first->GetNormals() ||
      (array->GetDataType() != VTK_FLOAT && array->GetDataType() != VTK_DOUBLE))
    {
      continue;
    }
    const vtkIdType values = array->GetNumberOfValues();
    const int components = array->GetNumberOfComponents();
    cartan::Field columns(values, keys.size());
    bool haveAll = true;
    for (std::size_t k = 0; k < keys.size() && haveAll; ++k)
    {
      vtkDataArray* other = keys[k]->GetPointData()->GetArray(array->GetName());
      haveAll = other && other->GetNumberOfComponents() == components &&
        other->GetNumberOfValues() == values;
      for (vtkIdType i = 0; haveAll && i < values; ++i)
      {
        columns(i, static_cast<Eigen::Index>(k)) =
          other->GetComponent(i / components, static_cast<int>(i % components));
      }
    }
    if (!haveAll)
    {
      continue;
    }
    const Eigen::VectorXd result =
      cartan::KeyInterpolation(parameters, std::move(columns)).Evaluate(t, context);
    auto interpolated = vtk::TakeSmartPointer(array->NewInstance());
    interpolated->SetName(array->GetName());
    interpolated->SetNumberOfComponents(components);
    interpolated->SetNumberOfTuples(array->GetNumberOfTuples());
    for (int c = 0; c < components; ++c)
    {
      if (array->GetComponentName(c))
      {
        interpolated->SetComponentName(c, array->GetComponentName(c));
      }
    }
    for (vtkIdType i = 0; i < values; ++i)
    {
      interpolated->SetComponent(i / components, static_cast<int>(i % components), result[i]);
    }
    output->GetPointData()->AddArray(interpolated);
  }
}

/// Which points of the first key frame are in a handle. Throws if none is.
std::vector<char> ReadPinned(vtkPolyData* first, const std::string& name)
{
  vtkDataArray* array = cartan::RequirePointArray(first, name, 1);
  std::vector<char> isPinned(first->GetNumberOfPoints());
  for (std::size_t v = 0; v < isPinned.size(); ++v)
  {
    isPinned[v] = array->GetComponent(static_cast<vtkIdType>(v), 0) > 0;
  }
  if (std::find(isPinned.begin(), isPinned.end(), 1) == isPinned.end())
  {
    throw Error(ErrorCode::BadInput,
      "No point of the first key frame has a value above 0 in \"" + name +
        "\": mark the points to pin (Mark Handle), or place by rigid interpolation.");
  }
  return isPinned;
}
}

class vtkSurfaceMorph::Internals
{
public:
  /// Everything that is kept while the key frames and the method are the same.
  struct Session
  {
    std::vector<cartan::Surface::Source> ReadFrom;
    std::tuple<int, int, int, int, int> Settings;
    cartan::Surface First;  ///< with the triangles that all key frames use
    cartan::KeyFrames Keys; ///< about the origin of First
    std::unique_ptr<cartan::SurfaceMorph> Morph;
    std::unique_ptr<cartan::MorphVolume> Volume; ///< once it is needed
  };
  Session Current;

  /// Of one input: its time steps, and those of the surfaces there that are in use.
  std::vector<double> Times;
  std::map<int, vtkSmartPointer<vtkPolyData>> Steps;
  vtkMTimeType InputTime = 0;
  int Requested = 0;

  /// The last composite input: the executive shows only its blocks to RequestData.
  vtkWeakPointer<vtkCompositeDataSet> Composite;

  /// Where the key frames are in [0, 1].
  std::vector<double> Parameters;

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

  bool Serves(const std::vector<vtkPolyData*>& keys, const std::vector<double>& parameters,
    const std::tuple<int, int, int, int, int>& settings) const
  {
    const Session& session = this->Current;
    bool isSame = session.Morph && session.Settings == settings &&
      session.Keys.Parameters == parameters && session.ReadFrom.size() == keys.size();
    for (std::size_t k = 0; isSame && k < keys.size(); ++k)
    {
      isSame = cartan::IsSameSurface(session.ReadFrom[k], keys[k]);
    }
    return isSame;
  }

  /// The first time step of the window that is not there; -1 if none.
  int NextMissing(const std::pair<int, int>& window) const
  {
    for (int k = window.first; k < window.second; ++k)
    {
      if (!this->Steps.count(k))
      {
        return k;
      }
    }
    return -1;
  }
};

vtkSurfaceMorph::vtkSurfaceMorph()
  : State(std::make_unique<Internals>())
{
}

vtkSurfaceMorph::~vtkSurfaceMorph() = default;

void vtkSurfaceMorph::SetHandleArrayName(const std::string& name)
{
  if (this->HandleArrayName != name)
  {
    this->HandleArrayName = name;
    this->Modified();
  }
}

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
  if (this->FollowTime && state.Parameters.size() > 1)
  {
    std::vector<double> steps;
    for (std::size_t k = 0; k + 1 < state.Parameters.size(); ++k)
    {
      for (int step = 0; step < this->StepsBetweenKeyFrames; ++step)
      {
        const double part = static_cast<double>(step) / this->StepsBetweenKeyFrames;
        steps.push_back(
          state.ToTime((1.0 - part) * state.Parameters[k] + part * state.Parameters[k + 1]));
      }
    }
    steps.push_back(state.ToTime(1.0));
    const double range[2] = { steps.front(), steps.back() };
    info->Set(Pipeline::TIME_STEPS(), steps.data(), static_cast<int>(steps.size()));
    info->Set(Pipeline::TIME_RANGE(), range, 2);
  }
  return 1;
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
    const double t = this->RequestedParameter(outputVector->GetInformationObject(0));
    const int missing = state.NextMissing(WindowAt(t, state.Parameters));
    // With all there, what was asked for last costs the input nothing.
    state.Requested = missing >= 0 ? missing : state.Requested;
    inputVector[0]->GetInformationObject(0)->Set(
      Pipeline::UPDATE_TIME_STEP(), state.Times[state.Requested]);
  }
  return 1;
}

int vtkSurfaceMorph::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  Internals& state = *this->State;
  vtkInformation* outputInfo = outputVector->GetInformationObject(0);
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  const double t = this->RequestedParameter(outputInfo);
  const std::pair<int, int> window = WindowAt(t, state.Parameters);

  request->Remove(Pipeline::CONTINUE_EXECUTING());
  const int isDone = cartan::RunGuarded(this,
    [&]
    {
      this->NumberOfKeyFrames = static_cast<int>(state.Parameters.size());
      if (IsBlockOf(state.Composite, vtkPolyData::GetData(inputVector[0])))
      {
        throw Error(ErrorCode::BadInput,
          "The input is a composite data set: give its surfaces one by one (Extract Block), or as "
          "one (Merge Blocks, then Extract Surface).");
      }
      if (state.Parameters.size() < 2)
      {
        throw Error(ErrorCode::BadInput,
          "There is one key frame only: give two surfaces or more, or one with time steps.");
      }
      std::vector<vtkPolyData*> keys;
      std::vector<std::string> roles;
      std::vector<double> parameters(
        state.Parameters.begin() + window.first, state.Parameters.begin() + window.second);
      if (!state.Times.empty())
      {
        auto step = vtkSmartPointer<vtkPolyData>::New();
        step->ShallowCopy(vtkPolyData::GetData(inputVector[0]));
        state.Steps[state.Requested] = step;
        if (state.NextMissing(window) >= 0)
        {
          request->Set(Pipeline::CONTINUE_EXECUTING(), 1);
          return;
        }
        for (auto entry = state.Steps.begin(); entry != state.Steps.end();)
        {
          const bool isUsed = entry->first >= window.first && entry->first < window.second;
          entry = isUsed ? std::next(entry) : state.Steps.erase(entry);
        }
      }
      for (int k = window.first; k < window.second; ++k)
      {
        keys.push_back(
          state.Times.empty() ? vtkPolyData::GetData(inputVector[0], k) : state.Steps.at(k).Get());
        roles.push_back("key frame " + std::to_string(k) +
          (state.Times.empty() ? "" : " (time " + std::to_string(state.Times[k]) + ")"));
      }
      this->Morph(keys, roles, parameters, t, output);
    });
  if (!isDone)
  {
    state.Steps.clear();
    return 0;
  }
  if (!request->Has(Pipeline::CONTINUE_EXECUTING()))
  {
    output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(),
      outputInfo->Has(Pipeline::UPDATE_TIME_STEP()) ? outputInfo->Get(Pipeline::UPDATE_TIME_STEP())
                                                    : state.ToTime(t));
  }
  return 1;
}

void vtkSurfaceMorph::Prepare(const std::vector<vtkPolyData*>& keys,
  const std::vector<std::string>& roles, const std::vector<double>& parameters)
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
  const std::tuple<int, int, int, int, int> settings{ this->Method, this->TransitionInterpolation,
    this->FrameSolver, this->Stitching, this->LengthPolish };
  this->SetupTime = 0.0;
  if (this->State->Serves(keys, parameters, settings))
  {
    return;
  }
  const double start = vtkTimerLog::GetUniversalTime();
  const cartan::ExecutionContext context = cartan::MakeContext(this).Part(0.0, 0.7);
  Internals::Session session;
  cartan::MatchedSurfaces matched = cartan::ReadMatchedSurfaces(keys, roles,
    "Key frames need the same points and cells in the same order, such as one surface in several "
    "poses.");
  session.ReadFrom = matched.ReadFrom;
  session.Settings = settings;
  session.Keys.Mesh = std::make_shared<cartan::TriangleMesh>(matched.Mesh);
  session.Keys.Parameters = parameters;
  for (std::size_t k = 0; k < keys.size(); ++k)
  {
    matched.Positions[k].rowwise() += (matched.Origins[k] - matched.Origins[0]).transpose().eval();
  }
  session.Keys.Positions = std::move(matched.Positions);
  session.First.Mesh = std::move(matched.Mesh);
  session.First.CellIds = std::move(matched.CellIds);
  session.First.Positions = session.Keys.Positions[0];
  session.First.Origin = matched.Origins[0];
  switch (this->Method)
  {
    case DISCRETE_FORMS:
      session.Morph = std::make_unique<cartan::DiscreteFormsMorph>(session.Keys,
        static_cast<cartan::DiscreteFormsMorph::Transitions>(this->TransitionInterpolation),
        static_cast<cartan::DiscreteFormsMorph::FrameSolver>(this->FrameSolver), context);
      break;
    case ISOMETRIC:
    {
      cartan::IsometricMorphOptions options;
      options.Type = static_cast<cartan::IsometricMorphOptions::Method>(this->Stitching);
      options.LengthPolish = this->LengthPolish;
      session.Morph = std::make_unique<cartan::IsometricMorph>(session.Keys, options, context);
      break;
    }
    case DEFORMATION_GRADIENT:
      session.Morph = std::make_unique<cartan::TriangleGradientMorph>(session.Keys, context);
      break;
    default:
      session.Morph = std::make_unique<cartan::LinearMorph>(session.Keys);
  }
  cartan::Warn(this, matched.Warning);
  this->State->Current = std::move(session);
  this->SetupTime = vtkTimerLog::GetUniversalTime() - start;
}

void vtkSurfaceMorph::Morph(const std::vector<vtkPolyData*>& keys,
  const std::vector<std::string>& roles, const std::vector<double>& parameters, double t,
  vtkPolyData* output)
{
  this->Prepare(keys, roles, parameters);
  Internals::Session& session = this->State->Current;
  const double start = vtkTimerLog::GetUniversalTime();
  const cartan::ExecutionContext context = cartan::MakeContext(this).Part(0.7, 1.0);
  const cartan::KeyPlace place = cartan::PlaceBetweenKeys(t, parameters);
  const bool isKey = place.Part == 0.0 || place.Part == 1.0;

  cartan::Points positions;
  if (isKey)
  {
    positions = session.Keys.Positions[place.Before + (place.Part == 1.0)];
    this->NumberOfIterations = 0;
  }
  else
  {
    positions = session.Morph->Evaluate(t, context);
    this->NumberOfIterations = session.Morph->GetNumberOfIterations();
    cartan::Warn(this, session.Morph->GetWarning());
    if (this->Method != LINEAR)
    {
      const Eigen::VectorXd weights = this->Placement == PINNED_HANDLE
        ? cartan::PinWeights(session.Keys, ReadPinned(keys.front(), this->HandleArrayName))
        : cartan::AreaWeights(session.Keys, context);
      cartan::RigidPlacement(session.Keys, weights).Place(t, positions);
    }
    if (this->CloseVolume)
    {
      if (!session.Volume)
      {
        session.Volume = std::make_unique<cartan::MorphVolume>(session.Keys, context);
        cartan::Warn(this, session.Volume->GetWarning());
      }
      cartan::Warn(this, session.Volume->Close(t, positions));
    }
  }
  cartan::WriteSurface(session.First, positions, keys.front(), output, context);

  // Key frames to the last bit; and points in no triangle, on straight lines.
  vtkPoints* before = keys[place.Before]->GetPoints();
  vtkPoints* after = keys[place.Before + 1]->GetPoints();
  for (int v = 0; v < session.First.Mesh.NumberOfVertices(); ++v)
  {
    if (isKey || !session.First.Mesh.IsUsed(v))
    {
      const Eigen::Vector3d from(before->GetPoint(v));
      const Eigen::Vector3d to(after->GetPoint(v));
      const Eigen::Vector3d point = place.Part == 0.0 ? from
        : place.Part == 1.0                           ? to
                                                      : from + place.Part * (to - from);
      output->GetPoints()->SetPoint(v, point.data());
    }
  }
  InterpolatePointData(keys, parameters, t, output, context);
  this->EvaluationTime = vtkTimerLog::GetUniversalTime() - start;
}

void vtkSurfaceMorph::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "Parameter: " << this->Parameter << "\n";
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
