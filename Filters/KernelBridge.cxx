// SPDX-License-Identifier: BSD-3-Clause
#include "KernelBridge.h"

#include "Kernel/Mesh/Geometry.h"

#include "vtkAlgorithm.h"
#include "vtkAlgorithmOutput.h"
#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCellData.h"
#include "vtkCommunicator.h"
#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"
#include "vtkTriangleFilter.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace cartan
{
namespace
{
/// The triangles of a polydata and the cell each comes from.
struct CellTriangles
{
  std::vector<int> Corners; // 3 #T
  std::vector<long long> CellIds;
  IdSample Repeated; // cells whose triangle names a point twice
};

void AppendTriangles(vtkCellArray* polygons, const std::function<long long(vtkIdType)>& cellId,
  CellTriangles& triangles)
{
  auto iterator = vtk::TakeSmartPointer(polygons->NewIterator());
  for (iterator->GoToFirstCell(); !iterator->IsDoneWithTraversal(); iterator->GoToNextCell())
  {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    iterator->GetCurrentCell(size, ids);
    if (size != 3)
    {
      continue;
    }
    const long long cell = cellId(iterator->GetCurrentCellId());
    if (ids[0] == ids[1] || ids[1] == ids[2] || ids[2] == ids[0])
    {
      triangles.Repeated.Add(cell);
      continue;
    }
    for (int corner = 0; corner < 3; ++corner)
    {
      triangles.Corners.push_back(static_cast<int>(ids[corner]));
    }
    triangles.CellIds.push_back(cell);
  }
}

/// A polygon with such a point may fall apart when it is triangulated, and then
/// nobody would miss it.
void RequireFinitePoints(vtkPolyData* input, const std::string& role)
{
  std::vector<char> isSeen(input->GetNumberOfPoints(), 0);
  IdSample notFinite;
  for (vtkCellArray* cells : { input->GetPolys(), input->GetStrips() })
  {
    auto iterator = vtk::TakeSmartPointer(cells->NewIterator());
    for (iterator->GoToFirstCell(); !iterator->IsDoneWithTraversal(); iterator->GoToNextCell())
    {
      vtkIdType size = 0;
      const vtkIdType* ids = nullptr;
      iterator->GetCurrentCell(size, ids);
      for (vtkIdType i = 0; i < size; ++i)
      {
        isSeen[ids[i]] = 1;
      }
    }
  }
  for (std::size_t v = 0; v < isSeen.size(); ++v)
  {
    double point[3];
    input->GetPoint(static_cast<vtkIdType>(v), point);
    if (isSeen[v] && !Eigen::Map<const Eigen::Vector3d>(point).allFinite())
    {
      notFinite.Add(static_cast<long long>(v));
    }
  }
  if (!notFinite.IsEmpty())
  {
    MeshReport report;
    report.NonFinite = notFinite;
    throw Error(ErrorCode::BadInput, "The " + role + " has " + report.DescribeErrors());
  }
}

/// Polygons of which vtkTriangleFilter made fewer triangles than they have: those
/// without area, in whole or in part, vanish in it, and the surface would fall
/// apart there. As fans they are degenerate triangles like any others.
std::vector<char> BrokenPolygons(
  vtkCellArray* polygons, vtkPolyData* triangulated, vtkIdTypeArray* cellIds, vtkIdType firstCell)
{
  std::vector<vtkIdType> missing(polygons->GetNumberOfCells());
  for (std::size_t polygon = 0; polygon < missing.size(); ++polygon)
  {
    missing[polygon] = polygons->GetCellSize(static_cast<vtkIdType>(polygon)) - 2;
  }
  for (vtkIdType triangle = 0; triangle < triangulated->GetNumberOfPolys(); ++triangle)
  {
    const auto polygon = static_cast<std::size_t>(cellIds->GetValue(triangle) - firstCell);
    if (polygon < missing.size())
    {
      --missing[polygon];
    }
  }
  std::vector<char> isBroken(missing.size());
  std::transform(missing.begin(), missing.end(), isBroken.begin(),
    [](vtkIdType count) -> char { return count > 0; });
  return isBroken;
}

CellTriangles Triangulate(vtkPolyData* input, const std::string& role)
{
  CellTriangles triangles;
  const vtkIdType firstPolygon = input->GetNumberOfVerts() + input->GetNumberOfLines();
  if (input->GetNumberOfStrips() == 0 && input->GetPolys()->IsHomogeneous() == 3)
  {
    triangles.Corners.reserve(3 * input->GetNumberOfPolys());
    triangles.CellIds.reserve(input->GetNumberOfPolys());
    AppendTriangles(
      input->GetPolys(), [firstPolygon](vtkIdType id) { return firstPolygon + id; }, triangles);
    return triangles;
  }
  RequireFinitePoints(input, role);
  vtkNew<vtkPolyData> polygons;
  polygons->SetPoints(input->GetPoints());
  polygons->SetPolys(input->GetPolys());
  polygons->SetStrips(input->GetStrips());
  vtkNew<vtkIdTypeArray> cellIds;
  cellIds->SetName("CellIds");
  cellIds->SetNumberOfValues(polygons->GetNumberOfCells());
  for (vtkIdType i = 0; i < polygons->GetNumberOfCells(); ++i)
  {
    cellIds->SetValue(i, firstPolygon + i);
  }
  polygons->GetCellData()->AddArray(cellIds);
  vtkNew<vtkTriangleFilter> triangulate;
  triangulate->SetInputData(polygons);
  triangulate->PassVertsOff();
  triangulate->PassLinesOff();
  triangulate->Update();
  vtkPolyData* result = triangulate->GetOutput();
  auto* from = vtkIdTypeArray::SafeDownCast(result->GetCellData()->GetArray("CellIds"));
  const std::vector<char> isBroken = BrokenPolygons(input->GetPolys(), result, from, firstPolygon);
  const auto isWhole = [&isBroken, firstPolygon](vtkIdType cell)
  {
    const auto polygon = static_cast<std::size_t>(cell - firstPolygon);
    return polygon >= isBroken.size() || !isBroken[polygon];
  };
  vtkNew<vtkCellArray> whole;
  std::vector<vtkIdType> cellOfWhole;
  vtkNew<vtkIdList> ids;
  for (vtkIdType triangle = 0; triangle < result->GetNumberOfPolys(); ++triangle)
  {
    if (isWhole(from->GetValue(triangle)))
    {
      result->GetPolys()->GetCellAtId(triangle, ids);
      whole->InsertNextCell(ids);
      cellOfWhole.push_back(from->GetValue(triangle));
    }
  }
  for (std::size_t polygon = 0; polygon < isBroken.size(); ++polygon)
  {
    if (isBroken[polygon])
    {
      input->GetPolys()->GetCellAtId(static_cast<vtkIdType>(polygon), ids);
      for (vtkIdType corner = 2; corner < ids->GetNumberOfIds(); ++corner)
      {
        whole->InsertNextCell({ ids->GetId(0), ids->GetId(corner - 1), ids->GetId(corner) });
        cellOfWhole.push_back(firstPolygon + static_cast<vtkIdType>(polygon));
      }
    }
  }
  AppendTriangles(
    whole, [&cellOfWhole](vtkIdType id) { return cellOfWhole[id]; }, triangles);
  return triangles;
}

/// The cell arrays must be consistent before anything walks through them.
void RequireValidIds(vtkPolyData* input, const std::string& role)
{
  IdSample bad;
  vtkIdType cell = input->GetNumberOfVerts() + input->GetNumberOfLines();
  for (vtkCellArray* cells : { input->GetPolys(), input->GetStrips() })
  {
    auto iterator = vtk::TakeSmartPointer(cells->NewIterator());
    for (iterator->GoToFirstCell(); !iterator->IsDoneWithTraversal(); iterator->GoToNextCell())
    {
      vtkIdType size = 0;
      const vtkIdType* ids = nullptr;
      iterator->GetCurrentCell(size, ids);
      bool isValid = true;
      for (vtkIdType i = 0; i < size; ++i)
      {
        isValid = isValid && ids[i] >= 0 && ids[i] < input->GetNumberOfPoints();
      }
      if (!isValid)
      {
        bad.Add(cell);
      }
      ++cell;
    }
  }
  if (!bad.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The " + role + " has " + bad.Describe("cell", "cells") +
        " using a point that does not exist: repair the cells.");
  }
}

bool SameValues(vtkDataArray* a, vtkDataArray* b)
{
  if (a == b)
  {
    return true;
  }
  if (!a || !b || a->GetDataType() != b->GetDataType() ||
    a->GetNumberOfValues() != b->GetNumberOfValues() ||
    a->GetNumberOfComponents() != b->GetNumberOfComponents() || !a->HasStandardMemoryLayout() ||
    !b->HasStandardMemoryLayout())
  {
    return false;
  }
  return std::memcmp(a->GetVoidPointer(0), b->GetVoidPointer(0),
           static_cast<std::size_t>(a->GetNumberOfValues()) * a->GetDataTypeSize()) == 0;
}

/// Equal objects may have been changed in place, different ones be equal.
template <typename Object, typename Compare>
bool IsUnchanged(Object* before, vtkMTimeType timeBefore, Object* now, const Compare& sameValues)
{
  if (before == now)
  {
    return !now || now->GetMTime() == timeBefore;
  }
  return before && now && before->GetMTime() == timeBefore && sameValues(before, now);
}

bool SameCells(vtkCellArray* a, vtkCellArray* b)
{
  return SameValues(a->GetOffsetsArray(), b->GetOffsetsArray()) &&
    SameValues(a->GetConnectivityArray(), b->GetConnectivityArray());
}

template <typename Array>
vtkSmartPointer<vtkDataArray> NewNormals(vtkDataArray* like, vtkIdType numberOfTuples)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(like->GetName());
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(numberOfTuples);
  return array;
}

/// Replaces normals by new ones. `rest` and `current` are the computed normals
/// before and after, a row per tuple, zero where there is none.
void ReplaceNormals(vtkDataSetAttributes* attributes, const Points& rest, const Points& current)
{
  vtkDataArray* old = attributes->GetNormals();
  // Files store inward normals too: what was opposite stays opposite.
  double agreement = 0.0;
  for (vtkIdType i = 0; i < old->GetNumberOfTuples(); ++i)
  {
    double normal[3];
    old->GetTuple(i, normal);
    agreement += rest.row(i).dot(Eigen::RowVector3d(normal[0], normal[1], normal[2]));
  }
  const double sign = agreement < 0.0 ? -1.0 : 1.0;
  auto normals = old->GetDataType() == VTK_DOUBLE
    ? NewNormals<vtkDoubleArray>(old, old->GetNumberOfTuples())
    : NewNormals<vtkFloatArray>(old, old->GetNumberOfTuples());
  for (vtkIdType i = 0; i < old->GetNumberOfTuples(); ++i)
  {
    double normal[3];
    old->GetTuple(i, normal);
    if (!current.row(i).isZero(0.0))
    {
      Eigen::Map<Eigen::RowVector3d>(normal, 3) = sign * current.row(i);
    }
    normals->SetTuple(i, normal);
  }
  attributes->SetNormals(normals);
}

/// The unit normals of cells; zero for cells without triangles.
Points CellNormals(const Surface& surface, const Points& positions, vtkIdType numberOfCells)
{
  const Points areaVectors = TriangleAreaVectors(positions, surface.Mesh.GetTriangles());
  Points normals = Points::Zero(numberOfCells, 3);
  for (Eigen::Index t = 0; t < areaVectors.rows(); ++t)
  {
    normals.row(surface.CellIds[t]) += areaVectors.row(t);
  }
  for (vtkIdType cell = 0; cell < numberOfCells; ++cell)
  {
    const double size = normals.row(cell).norm();
    if (size > 0.0)
    {
      normals.row(cell) /= size;
    }
  }
  return normals;
}

template <typename Real>
void WriteCoordinates(const Surface& surface, const Points& positions, Real* coordinates,
  const ExecutionContext& context)
{
  context.For(static_cast<int>(positions.rows()),
    [&](int begin, int end)
    {
      for (int v = begin; v < end; ++v)
      {
        // To Origin and back would cost a point that did not move its last bit.
        if (surface.Mesh.IsUsed(v) && positions.row(v) != surface.Positions.row(v))
        {
          for (int c = 0; c < 3; ++c)
          {
            coordinates[3 * static_cast<std::size_t>(v) + c] =
              static_cast<Real>(positions(v, c) + surface.Origin[c]);
          }
        }
      }
    });
}

/// Throws when more than one rank has a part of the surface.
void RefuseDistributed(vtkAlgorithm* algorithm)
{
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  if (!controller || controller->GetNumberOfProcesses() < 2 ||
    algorithm->GetNumberOfInputConnections(0) == 0)
  {
    return;
  }
  // While the executive feeds a composite data set block by block, ranks may
  // have different numbers of blocks and must not wait for each other.
  vtkAlgorithm* producer = algorithm->GetInputAlgorithm(0, 0);
  const int producerPort = algorithm->GetInputConnection(0, 0)->GetIndex();
  if (!vtkPolyData::SafeDownCast(producer->GetOutputDataObject(producerPort)))
  {
    throw Error(ErrorCode::BadInput,
      "Composite surfaces cannot be processed on several ranks: extract a block and gather it on "
      "one rank (Aggregate Dataset) first.");
  }
  auto* input = vtkPolyData::SafeDownCast(algorithm->GetInputDataObject(0, 0));
  const int hasCells = input && input->GetNumberOfCells() > 0;
  int ranksWithCells = 0;
  controller->AllReduce(&hasCells, &ranksWithCells, 1, vtkCommunicator::SUM_OP);
  if (ranksWithCells > 1)
  {
    throw Error(ErrorCode::BadInput,
      "The surface is distributed over " + std::to_string(ranksWithCells) +
        " ranks, and the pieces do not know their neighbors: gather it on one rank (Aggregate "
        "Dataset, then Clean) first.");
  }
}

/// What the polygons of an input must be before anything walks through them.
void RequirePolygons(vtkPolyData* input, const std::string& role)
{
  if (!input || input->GetNumberOfPolys() + input->GetNumberOfStrips() == 0)
  {
    throw Error(ErrorCode::BadInput,
      "The " + role +
        " has no triangles: 0 polygons and strips. Give a surface (Extract Surface makes one of a "
        "volume mesh).");
  }
  if (input->GetNumberOfPoints() > std::numeric_limits<int>::max())
  {
    throw Error(ErrorCode::BadInput,
      "The " + role + " has " + std::to_string(input->GetNumberOfPoints()) +
        " points; at most 2147483647 are supported: decimate or split it.");
  }
  RequireValidIds(input, role);
}

void EmptyOutputs(vtkAlgorithm* algorithm)
{
  for (int port = 0; port < algorithm->GetNumberOfOutputPorts(); ++port)
  {
    if (vtkDataObject* output = algorithm->GetOutputDataObject(port))
    {
      output->Initialize();
    }
  }
}
}

Surface ReadSurface(vtkPolyData* input, const std::string& role)
{
  RequirePolygons(input, role);
  const int numberOfPoints = static_cast<int>(input->GetNumberOfPoints());
  CellTriangles cells = Triangulate(input, role);
  if (cells.CellIds.empty())
  {
    throw Error(
      ErrorCode::BadInput, "The " + role + " has no triangles with three different points.");
  }

  Surface surface;
  surface.CellIds = std::move(cells.CellIds);
  Triangles triangles = Eigen::Map<const Triangles>(
    cells.Corners.data(), static_cast<Eigen::Index>(surface.CellIds.size()), 3);
  surface.Positions.resize(numberOfPoints, 3);
  for (int v = 0; v < numberOfPoints; ++v)
  {
    input->GetPoint(v, surface.Positions.row(v).data());
  }
  // What unused points hold does not matter, not even NaN.
  std::vector<char> isUsed(numberOfPoints, 0);
  for (const int v : cells.Corners)
  {
    isUsed[v] = 1;
  }
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  for (int v = 0; v < numberOfPoints; ++v)
  {
    if (isUsed[v])
    {
      low = low.cwiseMin(surface.Positions.row(v).transpose());
      high = high.cwiseMax(surface.Positions.row(v).transpose());
    }
    else
    {
      surface.Positions.row(v).setZero();
    }
  }

  MeshReport report;
  CheckPositions(surface.Positions, triangles, report);
  surface.Mesh = TriangleMesh::Build(numberOfPoints, std::move(triangles), report);
  if (!report.IsUsable())
  {
    throw Error(
      ErrorCode::BadInput, "The " + role + " has " + report.DescribeErrors(surface.CellIds));
  }
  if (!cells.Repeated.IsEmpty())
  {
    surface.Warning = "The " + role + " has " + cells.Repeated.Describe("cell", "cells") +
      " using a point twice; ignored.";
  }
  if (!report.ZeroArea.IsEmpty())
  {
    surface.Warning += (surface.Warning.empty() ? "The " : " The ") + role + " has " +
      report.ZeroArea.Renamed(surface.CellIds).Describe("cell", "cells") + " without area.";
  }

  surface.Origin = 0.5 * (low + high);
  for (int v = 0; v < numberOfPoints; ++v)
  {
    if (isUsed[v])
    {
      surface.Positions.row(v) -= surface.Origin.transpose();
    }
  }
  surface.ReadFrom = { input->GetPoints(), input->GetPolys(), input->GetStrips(),
    input->GetPoints()->GetMTime(), input->GetPolys()->GetMTime(), input->GetStrips()->GetMTime() };
  return surface;
}

TriangleSoup ReadTriangles(vtkPolyData* input, const std::string& role)
{
  RequirePolygons(input, role);
  CellTriangles cells = Triangulate(input, role);
  if (cells.CellIds.empty())
  {
    throw Error(
      ErrorCode::BadInput, "The " + role + " has no triangles with three different points.");
  }
  TriangleSoup soup;
  soup.CellIds = std::move(cells.CellIds);
  soup.Repeated = cells.Repeated;
  soup.Faces = Eigen::Map<const Triangles>(
    cells.Corners.data(), static_cast<Eigen::Index>(soup.CellIds.size()), 3);
  soup.Positions.resize(input->GetNumberOfPoints(), 3);
  for (vtkIdType v = 0; v < input->GetNumberOfPoints(); ++v)
  {
    input->GetPoint(v, soup.Positions.row(v).data());
  }
  return soup;
}

Surface ReadConnectivity(vtkPolyData* input, const std::string& role)
{
  RequirePolygons(input, role);
  IdSample others;
  CellTriangles cells;
  const vtkIdType firstPolygon = input->GetNumberOfVerts() + input->GetNumberOfLines();
  auto iterator = vtk::TakeSmartPointer(input->GetPolys()->NewIterator());
  for (iterator->GoToFirstCell(); !iterator->IsDoneWithTraversal(); iterator->GoToNextCell())
  {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    iterator->GetCurrentCell(size, ids);
    if (size != 3)
    {
      others.Add(firstPolygon + iterator->GetCurrentCellId());
    }
  }
  for (vtkIdType strip = 0; strip < input->GetNumberOfStrips(); ++strip)
  {
    others.Add(firstPolygon + input->GetNumberOfPolys() + strip);
  }
  if (!others.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The " + role + " has " + others.Describe("cell", "cells") +
        " that are no triangles: triangulate the surface (Triangulate) before its forms are "
        "computed.");
  }
  AppendTriangles(
    input->GetPolys(), [firstPolygon](vtkIdType id) { return firstPolygon + id; }, cells);
  if (cells.CellIds.empty())
  {
    throw Error(
      ErrorCode::BadInput, "The " + role + " has no triangles with three different points.");
  }

  Surface surface;
  surface.CellIds = std::move(cells.CellIds);
  const int numberOfPoints = static_cast<int>(input->GetNumberOfPoints());
  surface.Positions = Points::Zero(numberOfPoints, 3);
  Triangles triangles = Eigen::Map<const Triangles>(
    cells.Corners.data(), static_cast<Eigen::Index>(surface.CellIds.size()), 3);
  MeshReport report;
  surface.Mesh = TriangleMesh::Build(numberOfPoints, std::move(triangles), report);
  if (!report.IsUsable())
  {
    throw Error(
      ErrorCode::BadInput, "The " + role + " has " + report.DescribeErrors(surface.CellIds));
  }
  return surface;
}

bool IsSameSurface(const Surface::Source& before, vtkPolyData* input)
{
  return IsUnchanged(before.Points.Get(), before.PointsTime, input->GetPoints(),
           [](vtkPoints* a, vtkPoints* b) { return SameValues(a->GetData(), b->GetData()); }) &&
    IsUnchanged(before.Polygons.Get(), before.PolygonsTime, input->GetPolys(), SameCells) &&
    IsUnchanged(before.Strips.Get(), before.StripsTime, input->GetStrips(), SameCells);
}

void WriteSurface(const Surface& surface, const Points& positions, vtkPolyData* input,
  vtkPolyData* output, const ExecutionContext& context)
{
  output->ShallowCopy(input);
  vtkNew<vtkPoints> points;
  const bool isFloat = input->GetPoints()->GetDataType() == VTK_FLOAT;
  points->SetDataType(isFloat ? VTK_FLOAT : VTK_DOUBLE);
  points->DeepCopy(input->GetPoints());
  if (isFloat)
  {
    WriteCoordinates(
      surface, positions, vtkFloatArray::FastDownCast(points->GetData())->GetPointer(0), context);
  }
  else
  {
    WriteCoordinates(
      surface, positions, vtkDoubleArray::FastDownCast(points->GetData())->GetPointer(0), context);
  }
  output->SetPoints(points);

  if (input->GetPointData()->GetNormals())
  {
    ReplaceNormals(output->GetPointData(), VertexNormals(surface.Mesh, surface.Positions, context),
      VertexNormals(surface.Mesh, positions, context));
  }
  if (input->GetCellData()->GetNormals())
  {
    ReplaceNormals(output->GetCellData(),
      CellNormals(surface, surface.Positions, input->GetNumberOfCells()),
      CellNormals(surface, positions, input->GetNumberOfCells()));
  }
}

void AddPointArray(vtkPolyData* output, const std::string& name, const double* values,
  vtkIdType numberOfTuples, int components)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name.c_str());
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(numberOfTuples);
  std::copy(values, values + numberOfTuples * components, array->GetPointer(0));
  output->GetPointData()->AddArray(array);
}

vtkDataArray* RequirePointArray(vtkPolyData* input, const std::string& name, int components)
{
  vtkDataArray* array = input->GetPointData()->GetArray(name.c_str());
  if (!array)
  {
    throw Error(ErrorCode::BadInput, "The input has no numeric point array \"" + name + "\".");
  }
  if (array->GetNumberOfComponents() != components ||
    array->GetNumberOfTuples() != input->GetNumberOfPoints())
  {
    throw Error(ErrorCode::BadInput,
      "The point array \"" + name + "\" has " + std::to_string(array->GetNumberOfTuples()) +
        " tuples of " + std::to_string(array->GetNumberOfComponents()) + " components; expected " +
        std::to_string(input->GetNumberOfPoints()) + " of " + std::to_string(components) + ".");
  }
  return array;
}

namespace
{
const char* const FrameArrayNames[3] = { "FrameTangent1", "FrameTangent2", "FrameNormal" };
}

void AddFrameArrays(vtkPolyData* output, const Matrices& frames)
{
  for (int k = 0; k < 3; ++k)
  {
    const Points vectors = frames.middleCols<3>(3 * k);
    AddPointArray(output, FrameArrayNames[k], vectors.data(), vectors.rows(), 3);
  }
}

Matrices ReadFrameArrays(vtkPolyData* input)
{
  Matrices frames(input->GetNumberOfPoints(), 9);
  for (int k = 0; k < 3; ++k)
  {
    vtkDataArray* array = RequirePointArray(input, FrameArrayNames[k], 3);
    for (vtkIdType v = 0; v < input->GetNumberOfPoints(); ++v)
    {
      array->GetTuple(v, frames.row(v).data() + 3 * k);
    }
  }
  return frames;
}

ExecutionContext MakeContext(vtkAlgorithm* algorithm)
{
  return ExecutionContext(
    [](int n, const ExecutionContext::Range& body)
    {
      vtkSMPTools::For(0, n,
        [&body](vtkIdType begin, vtkIdType end)
        { body(static_cast<int>(begin), static_cast<int>(end)); });
    },
    [algorithm](double fraction)
    {
      algorithm->UpdateProgress(fraction);
      return algorithm->GetAbortExecute() == 0;
    });
}

int RunGuarded(vtkAlgorithm* algorithm, const std::function<void()>& body)
{
  std::string problem;
  try
  {
    RefuseDistributed(algorithm);
    auto* input = vtkPolyData::SafeDownCast(
      algorithm->GetNumberOfInputConnections(0) ? algorithm->GetInputDataObject(0, 0) : nullptr);
    if (input && input->GetNumberOfPoints() == 0 && input->GetNumberOfCells() == 0)
    {
      EmptyOutputs(algorithm);
      return 1;
    }
    body();
    return 1;
  }
  catch (const Error& error)
  {
    if (error.GetCode() == ErrorCode::Aborted)
    {
      EmptyOutputs(algorithm);
      return 1;
    }
    problem = error.what();
  }
  catch (const std::bad_alloc&)
  {
    problem = "Out of memory: decimate the surface or free memory.";
  }
  catch (const std::exception& error)
  {
    problem = error.what();
  }
  EmptyOutputs(algorithm);
  vtkErrorWithObjectMacro(algorithm, << problem);
  return 0;
}

void Warn(vtkAlgorithm* algorithm, const std::string& text)
{
  if (!text.empty())
  {
    vtkWarningWithObjectMacro(algorithm, << text);
  }
}
}
