// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "RealMeshes.h"

#include "vtkAbstractArray.h"
#include "vtkAlgorithm.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataAlgorithm.h"
#include "vtkSmartPointer.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <vector>

/// What the tests of the filters share.
namespace vtktest
{
/// Collects errors and warnings instead of printing them, which would fail the
/// test.
class Log : public vtkCommand
{
public:
  static Log* New() { return new Log; }
  vtkTypeMacro(Log, vtkCommand);

  void Execute(vtkObject*, unsigned long event, void* data) override
  {
    std::vector<std::string>& messages =
      event == vtkCommand::ErrorEvent ? this->Errors : this->Warnings;
    messages.emplace_back(static_cast<const char*>(data));
  }
  void Clear()
  {
    this->Errors.clear();
    this->Warnings.clear();
  }

  std::vector<std::string> Errors;
  std::vector<std::string> Warnings;
};

inline vtkSmartPointer<Log> Observe(vtkAlgorithm* filter)
{
  auto log = vtkSmartPointer<Log>::New();
  filter->AddObserver(vtkCommand::ErrorEvent, log);
  filter->AddObserver(vtkCommand::WarningEvent, log);
  // After a failed RequestData the executive repeats that it failed.
  vtkNew<Log> silence;
  filter->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, silence);
  return log;
}

/// Exactly one message, which contains all parts.
inline void ExpectMessage(
  const std::vector<std::string>& messages, const std::vector<std::string>& parts)
{
  ASSERT_EQ(messages.size(), 1u) << (messages.size() > 1 ? messages[0] + messages[1] : "");
  for (const std::string& part : parts)
  {
    EXPECT_NE(messages[0].find(part), std::string::npos)
      << "expected: " << part << "\nfound: " << messages[0];
  }
}

inline void ExpectQuiet(const Log& log)
{
  EXPECT_TRUE(log.Errors.empty()) << log.Errors[0];
  EXPECT_TRUE(log.Warnings.empty()) << log.Warnings[0];
}

inline vtkSmartPointer<vtkPolyData> MakePolyData(
  const shapes::Shape& shape, int precision = VTK_DOUBLE)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(precision);
  points->SetNumberOfPoints(shape.NumberOfVertices());
  for (int v = 0; v < shape.NumberOfVertices(); ++v)
  {
    points->SetPoint(v, shape.Positions.row(v).data());
  }
  vtkNew<vtkCellArray> cells;
  for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
  {
    cells->InsertNextCell({ shape.Faces(t, 0), shape.Faces(t, 1), shape.Faces(t, 2) });
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(points);
  surface->SetPolys(cells);
  return surface;
}

inline cartan::Points PointsOf(vtkPolyData* surface)
{
  cartan::Points points(surface->GetNumberOfPoints(), 3);
  for (vtkIdType v = 0; v < surface->GetNumberOfPoints(); ++v)
  {
    surface->GetPoint(v, points.row(v).data());
  }
  return points;
}

/// A point array of doubles, its value(s) a function of the point's id.
inline vtkSmartPointer<vtkDoubleArray> AddArray(vtkPolyData* surface, const char* name,
  int components, const std::function<void(vtkIdType, double*)>& value)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(surface->GetNumberOfPoints());
  for (vtkIdType v = 0; v < surface->GetNumberOfPoints(); ++v)
  {
    value(v, array->GetPointer(v * components));
  }
  surface->GetPointData()->AddArray(array);
  return array;
}

/// The array Handle, its values a function of the position.
inline void AddHandles(vtkPolyData* surface,
  const std::function<int(const Eigen::Vector3d&)>& handle, const char* name = "Handle")
{
  vtkNew<vtkIntArray> array;
  array->SetName(name);
  for (vtkIdType v = 0; v < surface->GetNumberOfPoints(); ++v)
  {
    array->InsertNextValue(handle(Eigen::Vector3d(surface->GetPoint(v))));
  }
  surface->GetPointData()->AddArray(array);
}

inline bool SameArray(vtkAbstractArray* a, vtkAbstractArray* b)
{
  auto* x = vtkDataArray::SafeDownCast(a);
  auto* y = vtkDataArray::SafeDownCast(b);
  if (!x || !y)
  {
    return a && b && a->GetNumberOfValues() == b->GetNumberOfValues();
  }
  return x->GetDataType() == y->GetDataType() &&
    x->GetNumberOfComponents() == y->GetNumberOfComponents() &&
    x->GetNumberOfTuples() == y->GetNumberOfTuples() &&
    (x->GetNumberOfValues() == 0 ||
      std::memcmp(x->GetVoidPointer(0), y->GetVoidPointer(0),
        static_cast<std::size_t>(x->GetNumberOfValues()) * x->GetDataTypeSize()) == 0);
}

/// All arrays of `expected` are in `actual` with the same bits.
inline void ExpectArrays(vtkFieldData* actual, vtkFieldData* expected, bool andNoOthers = true)
{
  if (andNoOthers)
  {
    EXPECT_EQ(actual->GetNumberOfArrays(), expected->GetNumberOfArrays());
  }
  for (int i = 0; i < expected->GetNumberOfArrays(); ++i)
  {
    const char* name = expected->GetArrayName(i);
    EXPECT_TRUE(SameArray(actual->GetAbstractArray(name), expected->GetAbstractArray(i)))
      << "array " << (name ? name : "(no name)");
  }
}

inline void ExpectSameCells(vtkPolyData* actual, vtkPolyData* expected)
{
  const auto expectSame = [](vtkCellArray* a, vtkCellArray* b)
  {
    ASSERT_EQ(a->GetNumberOfCells(), b->GetNumberOfCells());
    for (vtkIdType cell = 0; cell < a->GetNumberOfCells(); ++cell)
    {
      vtkNew<vtkIdList> idsOfA;
      vtkNew<vtkIdList> idsOfB;
      a->GetCellAtId(cell, idsOfA);
      b->GetCellAtId(cell, idsOfB);
      ASSERT_TRUE(std::equal(idsOfA->begin(), idsOfA->end(), idsOfB->begin(), idsOfB->end()));
    }
  };
  expectSame(actual->GetVerts(), expected->GetVerts());
  expectSame(actual->GetLines(), expected->GetLines());
  expectSame(actual->GetPolys(), expected->GetPolys());
  expectSame(actual->GetStrips(), expected->GetStrips());
}

/// The same to the last bit.
inline void ExpectSameSurface(vtkPolyData* actual, vtkPolyData* expected)
{
  ASSERT_EQ(actual->GetNumberOfPoints(), expected->GetNumberOfPoints());
  if (expected->GetNumberOfPoints() > 0)
  {
    EXPECT_TRUE(SameArray(actual->GetPoints()->GetData(), expected->GetPoints()->GetData()));
  }
  ExpectSameCells(actual, expected);
  ExpectArrays(actual->GetPointData(), expected->GetPointData());
  ExpectArrays(actual->GetCellData(), expected->GetCellData());
  ExpectArrays(actual->GetFieldData(), expected->GetFieldData());
}

inline vtkSmartPointer<vtkPolyData> CopyOf(vtkPolyData* surface)
{
  auto copy = vtkSmartPointer<vtkPolyData>::New();
  copy->DeepCopy(surface);
  return copy;
}

/// A source that makes a new copy of its surface with every execution.
class Producer : public vtkPolyDataAlgorithm
{
public:
  static Producer* New() { VTK_STANDARD_NEW_BODY(Producer); }
  vtkTypeMacro(Producer, vtkPolyDataAlgorithm);

  void SetSurface(vtkPolyData* surface)
  {
    this->Surface = surface;
    this->Modified();
  }

  int Executions = 0;

protected:
  Producer() { this->SetNumberOfInputPorts(0); }

  int RequestData(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override
  {
    vtkPolyData::GetData(outputVector)->DeepCopy(this->Surface);
    ++this->Executions;
    return 1;
  }

private:
  vtkSmartPointer<vtkPolyData> Surface;
};

/// All fractions that an algorithm reports.
class ProgressLog : public vtkCommand
{
public:
  static ProgressLog* New() { return new ProgressLog; }
  vtkTypeMacro(ProgressLog, vtkCommand);

  void Execute(vtkObject* caller, unsigned long, void* data) override
  {
    this->Fractions.push_back(*static_cast<double*>(data));
    if (static_cast<int>(this->Fractions.size()) == this->AbortAt)
    {
      vtkAlgorithm::SafeDownCast(caller)->SetAbortExecute(1);
    }
  }

  std::vector<double> Fractions;
  int AbortAt = 0; ///< the report at which to abort, from 1; 0 never
};

/// A bad input: one error with the given parts, an empty output, an unharmed
/// input, and a filter that works again with a good one.
inline void ExpectRefused(vtkAlgorithm* filter, Log* log, vtkPolyData* bad,
  const std::vector<std::string>& parts, vtkPolyData* good)
{
  const auto copy = CopyOf(bad);
  log->Clear();
  filter->SetInputDataObject(0, bad);
  filter->Update();
  ExpectMessage(log->Errors, parts);
  for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
  {
    vtkDataObject* output = filter->GetOutputDataObject(port);
    EXPECT_EQ(output->GetNumberOfElements(vtkDataObject::POINT), 0);
    EXPECT_EQ(output->GetNumberOfElements(vtkDataObject::CELL), 0);
    EXPECT_EQ(output->GetNumberOfElements(vtkDataObject::ROW), 0);
  }
  ExpectSameSurface(bad, copy);

  log->Clear();
  filter->SetInputDataObject(0, good);
  filter->Update();
  EXPECT_TRUE(log->Errors.empty()) << log->Errors[0];
  EXPECT_EQ(filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::POINT),
    good->GetNumberOfPoints());
}

/// Surfaces that no filter accepts, each with what its message must say.
struct BadSurface
{
  std::string Name;
  vtkSmartPointer<vtkPolyData> Surface;
  std::vector<std::string> Parts;
};

inline std::vector<BadSurface> BadSurfaces()
{
  std::vector<BadSurface> bad;
  const auto fromFaces = [](const shapes::Shape& shape, const std::vector<Eigen::Vector3i>& faces)
  {
    shapes::Shape result = shape;
    result.Faces = shapes::ToTriangles(faces);
    return MakePolyData(result);
  };
  const shapes::Shape plane = shapes::Plane(4);

  auto pointsOnly = MakePolyData(plane);
  pointsOnly->SetPolys(nullptr);
  bad.push_back({ "points only", pointsOnly, { "no triangles", "Extract Surface" } });

  auto linesOnly = CopyOf(pointsOnly);
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell({ 0, 1, 2 });
  linesOnly->SetLines(lines);
  bad.push_back({ "lines only", linesOnly, { "no triangles" } });

  shapes::Shape notFinite = plane;
  notFinite.Positions(7, 2) = std::numeric_limits<double>::quiet_NaN();
  notFinite.Positions(9, 0) = std::numeric_limits<double>::infinity();
  bad.push_back({ "NaN", MakePolyData(notFinite),
    { "2 points (ids 7, 9)", "NaN or infinite", "repair or remove" } });

  bad.push_back({ "non-manifold edge", fromFaces(plane, { { 0, 1, 5 }, { 1, 0, 6 }, { 0, 1, 7 } }),
    { "1 edge (id 0)", "more than two triangles", "Prepare Surface" } });
  bad.push_back({ "bow tie", fromFaces(plane, { { 0, 1, 5 }, { 5, 11, 10 } }),
    { "1 point (id 5)", "several fans", "Prepare Surface" } });
  bad.push_back({ "orientation", fromFaces(plane, { { 0, 1, 5 }, { 1, 5, 6 } }),
    { "1 edge (id 1)", "opposite orientation", "Prepare Surface" } });

  auto missing = MakePolyData(plane);
  missing->GetPolys()->InsertNextCell({ 0, 1, 1000 });
  missing->GetPolys()->InsertNextCell({ 0, -4, 2 });
  bad.push_back(
    { "missing point", missing, { "2 cells (ids 32, 33)", "does not exist", "repair" } });

  vtkNew<vtkPolyData> noPoints;
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell({ 0, 1, 2 });
  noPoints->SetPolys(cells);
  bad.push_back({ "no points", noPoints, { "1 cell (id 0)", "does not exist" } });

  bad.push_back({ "repeated points", fromFaces(plane, { { 0, 1, 1 }, { 2, 2, 2 } }),
    { "no triangles with three different points" } });
  return bad;
}
}
