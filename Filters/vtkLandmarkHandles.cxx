// SPDX-License-Identifier: BSD-3-Clause
#include "vtkLandmarkHandles.h"

#include "Bridge/ContentKey.h"
#include "Bridge/FilterRun.h"
#include "Bridge/HandleArrays.h"
#include "Bridge/LandmarkReader.h"
#include "Bridge/PointArrays.h"
#include "Kernel/Base/Bytes.h"
#include "Kernel/Deformation/LandmarkWeights.h"
#include "Kernel/Mesh/Geometry.h"
#include "Kernel/Mesh/UsedVertices.h"

#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <sstream>

vtkStandardNewMacro(vtkLandmarkHandles);

using cartan::Error;
using cartan::ErrorCode;

/// The landmarks on the surface.
struct vtkLandmarkHandles::Placed
{
  std::shared_ptr<const cartan::Surface> Surface;
  cartan::LandmarkSet From;
  cartan::LandmarkSet To;
  cartan::LandmarkTargets Targets;
  Eigen::VectorXd Distances; ///< #L
  std::vector<int> Handles;  ///< #V, with the landmarks'
  std::vector<int> Ids;      ///< #L
  Eigen::VectorXd Weights;   ///< #L
};

namespace
{
const char* const TargetArray = "TargetPosition";
const char* const WeightArray = "ConstraintWeight";

/// Landmarks farther away, in parts of the surface's size, look like those of another
/// coordinate system.
constexpr double FarPart = 0.1;

/// What is kept of one surface and its landmarks.
struct KeptWeights
{
  Eigen::VectorXd Weights;

  std::size_t GetBytes() const { return cartan::BytesOf(this->Weights); }
};

/// Of all that LandmarkWeights depends on.
cartan::ContentKey KeyOfWeights(const cartan::Surface& surface, const std::vector<char>& pinned,
  const cartan::LandmarkTargets& targets)
{
  const std::size_t count = targets.Vertices.size();
  cartan::ContentKey key = surface.Key;
  return key.AddBytes(pinned.data(), pinned.size())
    .AddBytes(targets.Vertices.data(), count * sizeof(int))
    .AddBytes(targets.Displacements.data(), 3 * count * sizeof(double))
    .AddBytes(targets.Accuracies.data(), count * sizeof(double));
}

std::string Text(double value)
{
  std::ostringstream text;
  text << value;
  return text.str();
}

/// Throws for landmarks from one place: they are doubled, or contradict each other.
void RequireDistinctPlaces(const cartan::LandmarkSet& from, const cartan::LandmarkSet& to)
{
  std::map<std::array<double, 3>, Eigen::Index> places;
  for (Eigen::Index k = 0; k < from.Size(); ++k)
  {
    const auto place = from.Positions.row(k);
    const auto [other, isNew] = places.emplace(std::array{ place[0], place[1], place[2] }, k);
    if (!isNew)
    {
      const bool isSame = to.Positions.row(k) == to.Positions.row(other->second);
      throw Error(ErrorCode::BadInput,
        "Landmarks " + from.Describe(other->second) + " and " + from.Describe(k) +
          " come from one place and go to " + (isSame ? "one" : "different ones") +
          ": remove one of them.");
    }
  }
}

void RequireDistinctPoints(const cartan::LandmarkSet& from, const std::vector<int>& vertices)
{
  std::map<int, Eigen::Index> landmarks;
  for (std::size_t k = 0; k < vertices.size(); ++k)
  {
    const auto [other, isNew] = landmarks.emplace(vertices[k], static_cast<Eigen::Index>(k));
    if (!isNew)
    {
      throw Error(ErrorCode::BadInput,
        "Landmarks " + from.Describe(other->second) + " and " +
          from.Describe(static_cast<Eigen::Index>(k)) + " have the same nearest point " +
          std::to_string(vertices[k]) +
          ": remove one of the two, or subdivide the surface so that it has more points.");
    }
  }
}

/// The values of the array that the input has, else of `fill`.
vtkSmartPointer<vtkDoubleArray> ContinuedArray(vtkPolyData* input, const char* name, int components,
  const std::function<void(vtkIdType, double*)>& fill)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(input->GetNumberOfPoints());
  vtkDataArray* before = input->GetPointData()->HasArray(name)
    ? cartan::RequirePointArray(input, name, components)
    : nullptr;
  for (vtkIdType v = 0; v < input->GetNumberOfPoints(); ++v)
  {
    double* tuple = array->GetPointer(v * components);
    if (before)
    {
      before->GetTuple(v, tuple);
    }
    else
    {
      fill(v, tuple);
    }
  }
  return array;
}

template <typename Array, typename Values>
void AddTableColumn(vtkTable* table, const char* name, const Values& values)
{
  vtkNew<Array> column;
  column->SetName(name);
  for (const auto& value : values)
  {
    column->InsertNextValue(value);
  }
  table->AddColumn(column);
}
}

vtkLandmarkHandles::vtkLandmarkHandles()
{
  this->SetNumberOfInputPorts(3);
  this->SetNumberOfOutputPorts(2);
}

vtkTable* vtkLandmarkHandles::GetLandmarkTable()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(1));
}

int vtkLandmarkHandles::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port == 0)
  {
    return this->Superclass::FillInputPortInformation(port, info);
  }
  // Optional for the pipeline: the message is this filter's.
  SetPortType(info, "vtkPointSet", true);
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkTable");
  return 1;
}

int vtkLandmarkHandles::FillOutputPortInformation(int port, vtkInformation* info)
{
  return port == 1 ? SetOutputType(info, "vtkTable")
                   : this->Superclass::FillOutputPortInformation(port, info);
}

void vtkLandmarkHandles::ForgetResults()
{
  this->NumberOfLandmarks = 0;
  this->LargestDistance = 0.0;
}

void vtkLandmarkHandles::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Matching: " << this->Matching << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "Accuracy: " << this->Accuracy << "\n";
  os << indent << "AccuracyArrayName: " << this->AccuracyArrayName << "\n";
  os << indent << "HandleArrayName: " << this->HandleArrayName << "\n";
  os << indent << "NumberOfLandmarks: " << this->NumberOfLandmarks << "\n";
  os << indent << "LargestDistance: " << this->LargestDistance << "\n";
}

vtkLandmarkHandles::Placed vtkLandmarkHandles::ReadAndPlace(cartan::FilterRun& run) const
{
  Placed placed;
  placed.From = cartan::ReadLandmarks(run.InputObject(1), "from", this->AccuracyArrayName);
  placed.To = cartan::ReadLandmarks(run.InputObject(2), "to");
  if (placed.From.Size() != placed.To.Size())
  {
    throw Error(ErrorCode::BadInput,
      "There are " + std::to_string(placed.From.Size()) + " landmarks from and " +
        std::to_string(placed.To.Size()) + " to: give as many in both.");
  }
  if (this->Matching == NAME)
  {
    placed.To = cartan::InOrderOf(placed.From, placed.To);
  }
  else if (placed.From.Names != placed.To.Names &&
    std::multiset<std::string>(placed.From.Names.begin(), placed.From.Names.end()) ==
      std::multiset<std::string>(placed.To.Names.begin(), placed.To.Names.end()))
  {
    run.Warn("The landmarks from and to have the same names in another order: choose Matching by "
             "name if they belong together.");
  }
  placed.Surface = run.ReadSurface();
  const cartan::TriangleMesh& mesh = *placed.Surface->Mesh;
  const std::size_t count = cartan::UsedVertices(mesh).size();
  if (static_cast<std::size_t>(placed.From.Size()) > count)
  {
    throw Error(ErrorCode::BadInput,
      "There are " + std::to_string(placed.From.Size()) + " landmarks, but only " +
        std::to_string(count) +
        " points in triangles: remove landmarks, or subdivide the surface.");
  }
  RequireDistinctPlaces(placed.From, placed.To);
  const cartan::NearestVertices nearest =
    cartan::FindNearestVertices(mesh, *placed.Surface->Positions,
      placed.From.Positions.rowwise() - placed.Surface->Origin.transpose());
  placed.Targets.Vertices = nearest.Vertices;
  placed.Targets.Displacements = placed.To.Positions - placed.From.Positions;
  placed.Targets.Accuracies = placed.From.Accuracies.size()
    ? placed.From.Accuracies
    : Eigen::VectorXd::Constant(placed.From.Size(), this->Accuracy);
  placed.Distances = nearest.Distances;
  return placed;
}

void vtkLandmarkHandles::RequireNear(const Placed& placed, cartan::FilterRun& run) const
{
  const double size =
    cartan::BoundingDiagonal(*placed.Surface->Positions, placed.Surface->Mesh->GetTriangles());
  const double limit = this->Tolerance > 0.0 ? this->Tolerance : FarPart * size;
  std::vector<Eigen::Index> far;
  for (Eigen::Index k = 0; k < placed.Distances.size(); ++k)
  {
    if (placed.Distances[k] > limit)
    {
      far.push_back(k);
    }
  }
  if (far.empty())
  {
    return;
  }
  const std::string text = placed.From.Describe(far) + ", up to " +
    Text(placed.Distances.maxCoeff()) + " away from the nearest point";
  if (this->Tolerance > 0.0)
  {
    throw Error(ErrorCode::BadInput,
      "Farther from the surface than Tolerance " + Text(this->Tolerance) + ": " + text +
        ". Move the landmarks to the surface, or raise Tolerance.");
  }
  run.Warn("Farther from the surface than a tenth of its size: " + text +
    ". They may be in another coordinate system: set Tolerance to the distance that is right.");
}

void vtkLandmarkHandles::WriteArrays(const Placed& placed, cartan::FilterRun& run) const
{
  vtkPolyData* input = run.Input();
  vtkPolyData* output = run.Output();
  output->ShallowCopy(input);
  vtkNew<vtkIntArray> handles;
  handles->SetName(this->HandleArrayName.c_str());
  handles->SetNumberOfValues(input->GetNumberOfPoints());
  std::copy(placed.Handles.begin(), placed.Handles.end(), handles->GetPointer(0));
  output->GetPointData()->AddArray(handles);
  const auto targets = ContinuedArray(
    input, TargetArray, 3, [input](vtkIdType v, double* to) { input->GetPoint(v, to); });
  const auto weights = ContinuedArray(input, WeightArray, 1,
    [](vtkIdType, double* weight) { *weight = std::numeric_limits<double>::infinity(); });
  for (std::size_t k = 0; k < placed.Ids.size(); ++k)
  {
    const int v = placed.Targets.Vertices[k];
    const auto row = static_cast<Eigen::Index>(k);
    for (int i = 0; i < 3; ++i)
    {
      targets->SetComponent(v, i, input->GetPoint(v)[i] + placed.Targets.Displacements(row, i));
    }
    weights->SetValue(v, placed.Weights[row]);
  }
  output->GetPointData()->AddArray(targets);
  if (placed.Targets.Accuracies.maxCoeff() > 0.0 || input->GetPointData()->HasArray(WeightArray))
  {
    output->GetPointData()->AddArray(weights);
  }

  vtkTable* table = run.OutputTable(1);
  std::vector<std::string> names = placed.From.Names;
  for (std::size_t k = names.size(); k < placed.Ids.size(); ++k)
  {
    names.push_back(std::to_string(k));
  }
  AddTableColumn<vtkStringArray>(table, "Landmark", names);
  AddTableColumn<vtkIntArray>(table, "HandleId", placed.Ids);
  AddTableColumn<vtkIntArray>(table, "PointId", placed.Targets.Vertices);
  cartan::AddColumn(table, "Distance", placed.Distances);
  cartan::AddArray(table->GetRowData(), "Displacement", placed.Targets.Displacements);
  cartan::AddColumn(table, "Accuracy", placed.Targets.Accuracies);
  cartan::AddColumn(table, "Weight", placed.Weights);
}

void vtkLandmarkHandles::Execute(cartan::FilterRun& run)
{
  Placed placed = this->ReadAndPlace(run);
  this->RequireNear(placed, run);
  RequireDistinctPoints(placed.From, placed.Targets.Vertices);
  run.Context().Report(0.3);
  vtkPolyData* input = run.Input();
  placed.Handles.assign(input->GetNumberOfPoints(), 0);
  if (input->GetPointData()->HasArray(this->HandleArrayName.c_str()))
  {
    placed.Handles =
      cartan::ReadHandleIds(cartan::RequirePointArray(input, this->HandleArrayName, 1),
        this->HandleArrayName, input->GetNumberOfPoints());
  }
  int id = *std::max_element(placed.Handles.begin(), placed.Handles.end());
  // What moves in the harmonic model are landmarks alone: other handles stay.
  std::vector<char> pinned(placed.Handles.begin(), placed.Handles.end());
  std::transform(placed.Handles.begin(), placed.Handles.end(), pinned.begin(),
    [](int handle) { return static_cast<char>(handle > 0); });
  for (const int v : placed.Targets.Vertices)
  {
    placed.Handles[v] = ++id;
    placed.Ids.push_back(id);
    pinned[v] = 0;
  }
  const auto kept = run.Keep<KeptWeights>(KeyOfWeights(*placed.Surface, pinned, placed.Targets),
    [&]
    {
      return std::make_unique<KeptWeights>(
        KeptWeights{ cartan::LandmarkWeights(*placed.Surface->Mesh, *placed.Surface->Positions,
          pinned, placed.Targets, run.Context().Part(0.3, 0.9)) });
    });
  placed.Weights = kept->Weights;
  this->WriteArrays(placed, run);
  this->NumberOfLandmarks = static_cast<int>(placed.Ids.size());
  this->LargestDistance = placed.Distances.maxCoeff();
  run.Context().Report(1.0);
}
