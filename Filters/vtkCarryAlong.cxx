// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCarryAlong.h"

#include "Bridge/FilterRun.h"
#include "Bridge/MatchedSurfaces.h"
#include "Bridge/PointArrays.h"
#include "Kernel/Deformation/SurfaceBinding.h"
#include "Kernel/Deformation/TetrahedronGraph.h"
#include "Kernel/Mesh/Geometry.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkIdList.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <limits>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkCarryAlong);

using cartan::Error;
using cartan::ErrorCode;

namespace
{
/// The points relative to `origin`: #Q x 3.
cartan::Points ReadQueries(vtkPointSet* input, const Eigen::Vector3d& origin)
{
  cartan::Points queries(input->GetNumberOfPoints(), 3);
  cartan::IdSample bad;
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    input->GetPoint(i, queries.row(i).data());
    if (!queries.row(i).allFinite())
    {
      bad.Add(i);
    }
  }
  if (!bad.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "What follows has " + bad.Describe("point", "points") +
        " with NaN or infinite coordinates: repair or remove these points.");
  }
  return queries.rowwise() - origin.transpose();
}

/// What is kept of one rest surface and what follows it.
struct KeptBinding
{
  cartan::SurfaceBinding Binding;

  std::size_t GetBytes() const { return this->Binding.GetBytes(); }
};

/// A copy whose tuples are turned.
vtkSmartPointer<vtkDataArray> Turned(vtkDataArray* array, const cartan::Matrices& rotations)
{
  auto turned = vtk::TakeSmartPointer(array->NewInstance());
  turned->DeepCopy(array);
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    Eigen::Vector3d vector;
    array->GetTuple(i, vector.data());
    vector = cartan::MatrixAt(rotations, i) * vector;
    turned->SetTuple(i, vector.data());
  }
  return turned;
}

/// Turns the normals and, on request, all other vectors.
void TurnArrays(vtkPointData* arrays, const cartan::Matrices& rotations, bool all)
{
  vtkDataArray* normals = arrays->GetNormals();
  vtkDataArray* places = arrays->GetTCoords();
  vtkNew<vtkPointData> before;
  before->ShallowCopy(arrays);
  for (int i = 0; i < before->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = before->GetArray(i);
    const bool isVector = array && array->GetNumberOfComponents() == 3 && array != places &&
      (array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE);
    if (array && array == normals)
    {
      arrays->SetNormals(Turned(array, rotations));
    }
    else if (isVector && all && array->GetName())
    {
      arrays->AddArray(Turned(array, rotations));
    }
  }
}

/// How far rounding may carry points, in parts of the size of the surface.
constexpr double LargestRounding = 1e-4;

/// Which points follow parts of the surface that are so small that the digits of its
/// coordinates do not tell how they turn; empty where there are none.
std::string DescribeBlurredTurns(const cartan::SurfaceBinding& binding,
  const cartan::Points& current, const Eigen::Vector3d& origin, int type)
{
  const double largest = (current.rowwise() + origin.transpose()).cwiseAbs().maxCoeff();
  const double digits = type == VTK_FLOAT ? std::numeric_limits<float>::epsilon()
                                          : std::numeric_limits<double>::epsilon();
  const Eigen::VectorXd errors = binding.RoundingErrors(current, 0.5 * digits * largest);
  const double size = cartan::BoundingDiagonal(current);
  cartan::IdSample blurred;
  for (Eigen::Index i = 0; i < errors.size(); ++i)
  {
    if (errors[i] > LargestRounding * size)
    {
      blurred.Add(i);
    }
  }
  return blurred.IsEmpty()
    ? std::string()
    : "Rounding decides about " + blurred.Describe("carried point", "carried points") +
      ": the parts of the surface that are nearest are so small that the digits of its "
      "coordinates do not tell how they turn. Deform the surface in double precision, or without "
      "its small parts (Prepare Surface, "
      "Minimum Component Area).";
}

/// The tetrahedra among the cells that are turned inside out, relative to `origin` at rest
/// and in the places `current` (#points x 3).
cartan::IdSample InvertedCells(
  vtkPointSet* mesh, const Eigen::Vector3d& origin, const cartan::Points& current)
{
  std::vector<long long> cells;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    if (mesh->GetCellType(cell) == VTK_TETRA)
    {
      cells.push_back(cell);
    }
  }
  if (cells.empty())
  {
    return {};
  }
  cartan::Tetrahedra tetrahedra(static_cast<Eigen::Index>(cells.size()), 4);
  vtkNew<vtkIdList> ids;
  for (std::size_t t = 0; t < cells.size(); ++t)
  {
    mesh->GetCellPoints(cells[t], ids);
    for (int corner = 0; corner < 4; ++corner)
    {
      tetrahedra(static_cast<Eigen::Index>(t), corner) = static_cast<int>(ids->GetId(corner));
    }
  }
  return cartan::InvertedTetrahedra(ReadQueries(mesh, origin), current, tetrahedra).Renamed(cells);
}

std::string WarningOf(const cartan::IdSample& inverted)
{
  return inverted.IsEmpty() ? ""
                            : "The surface bends more sharply than its inside can follow: " +
      inverted.Describe("tetrahedron is inverted", "tetrahedra are inverted") + ".";
}
}

vtkCarryAlong::vtkCarryAlong()
{
  this->SetNumberOfInputPorts(3);
}

void vtkCarryAlong::SetRestData(vtkPolyData* rest)
{
  this->SetInputData(1, rest);
}

void vtkCarryAlong::SetDeformedData(vtkPolyData* deformed)
{
  this->SetInputData(2, deformed);
}

vtkPointSet* vtkCarryAlong::GetCarried()
{
  return vtkPointSet::SafeDownCast(this->GetOutputDataObject(0));
}

int vtkCarryAlong::FillInputPortInformation(int port, vtkInformation* info)
{
  // The surfaces are optional for the pipeline: the message is this filter's.
  return port == 0 ? SetPortType(info, "vtkPointSet") : SetPortType(info, "vtkPolyData", true);
}

int vtkCarryAlong::FillOutputPortInformation(int, vtkInformation* info)
{
  return SetOutputType(info, "vtkPointSet");
}

vtkTypeBool vtkCarryAlong::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (!request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT()))
  {
    return this->Superclass::ProcessRequest(request, inputVector, outputVector);
  }
  vtkDataObject* input = vtkDataObject::GetData(inputVector[0]);
  vtkDataObject* output = vtkDataObject::GetData(outputVector);
  if (!input)
  {
    return 0;
  }
  if (!output || output->GetDataObjectType() != input->GetDataObjectType())
  {
    auto fresh = vtk::TakeSmartPointer(input->NewInstance());
    outputVector->GetInformationObject(0)->Set(vtkDataObject::DATA_OBJECT(), fresh);
  }
  return 1;
}

int vtkCarryAlong::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  // Time is that of the deformed surface.
  if (inputVector[2]->GetNumberOfInformationObjects() > 0)
  {
    vtkInformation* from = inputVector[2]->GetInformationObject(0);
    vtkInformation* to = outputVector->GetInformationObject(0);
    to->CopyEntry(from, Pipeline::TIME_STEPS());
    to->CopyEntry(from, Pipeline::TIME_RANGE());
  }
  return 1;
}

void vtkCarryAlong::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "TurnVectors: " << this->TurnVectors << "\n";
  os << indent << "LargestDistance: " << this->LargestDistance << "\n";
  os << indent << "NumberOfInvertedCells: " << this->NumberOfInvertedCells << "\n";
}

void vtkCarryAlong::ForgetResults()
{
  this->LargestDistance = 0.0;
  this->NumberOfInvertedCells = 0;
}

void vtkCarryAlong::Execute(cartan::FilterRun& run)
{
  auto* input = vtkPointSet::SafeDownCast(run.InputObject(0));
  auto* output = vtkPointSet::SafeDownCast(run.OutputObject(0));
  if (!run.Input(1) || !run.Input(2))
  {
    throw Error(ErrorCode::BadInput,
      std::string("There is no surface ") + (run.Input(1) ? "as it is now" : "at rest") +
        " to follow: connect the surface before and after it was deformed.");
  }
  output->ShallowCopy(input);
  const cartan::MatchedSurfaces matched = cartan::ReadMatchedSurfaces(
    { run.Input(1), run.Input(2) }, { "surface at rest", "deformed surface" },
    "Give both the same points and cells in the same order, such as a surface before and after it "
    "was deformed.",
    run.Context().Part(0.0, 0.2));
  run.KeepSurface(matched.Surfaces[0]);
  run.Warn(matched.Warning);
  if (input->GetNumberOfPoints() == 0)
  {
    return;
  }
  cartan::ContentKey key = cartan::KeyOfSurface(run.Input(1));
  key.AddBytes(
    matched.Mesh->GetTriangles().data(), matched.Mesh->GetTriangles().size() * sizeof(int));
  key.Add(cartan::KeyOfArray(input->GetPoints()->GetData()).GetValue());
  const auto kept = run.Keep<KeptBinding>(key,
    [&]
    {
      return std::make_unique<KeptBinding>(KeptBinding{ { matched.Mesh, matched.Positions[0],
        ReadQueries(input, matched.Origins[0]), run.Context().Part(0.2, 0.7) } });
    });
  const cartan::SurfaceBinding& binding = kept->Binding;
  const cartan::SurfaceBinding::Carried carried =
    binding.Evaluate(*matched.Positions[1], run.Context().Part(0.7, 0.95));
  run.Warn(DescribeBlurredTurns(
    binding, *matched.Positions[1], matched.Origins[1], run.Input(2)->GetPoints()->GetDataType()));
  vtkNew<vtkPoints> points;
  points->SetDataType(input->GetPoints()->GetDataType());
  points->SetNumberOfPoints(input->GetNumberOfPoints());
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    Eigen::Vector3d place = carried.Positions.row(i).transpose() + matched.Origins[1];
    if (const int v = binding.VertexOf(i); v >= 0)
    {
      run.Input(2)->GetPoint(v, place.data()); // without the rounding of the origins
    }
    points->SetPoint(i, place.data());
  }
  output->SetPoints(points);
  TurnArrays(output->GetPointData(), carried.Rotations, this->TurnVectors);
  output->GetCellData()->SetNormals(nullptr);
  cartan::AddArray(output->GetPointData(), "SurfaceDistance", binding.GetDistances());
  this->LargestDistance = binding.GetDistances().maxCoeff();
  const auto inverted = InvertedCells(input, matched.Origins[0], carried.Positions);
  this->NumberOfInvertedCells = static_cast<vtkIdType>(inverted.GetCount());
  run.Warn(WarningOf(inverted));
  run.Context().Report(1.0);
}
