// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Base/Constants.h"

#include "vtkAppendPolyData.h"
#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkCleanPolyData.h"
#include "vtkCubeSource.h"
#include "vtkExecutive.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataAlgorithm.h"
#include "vtkSmartPointer.h"
#include "vtkSphereSource.h"
#include "vtkTestErrorObserver.h"
#include "vtkTransform.h"

#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

/// Surfaces as VTK filters take them, good and bad ones, for the filter tests.
namespace surfaces
{
/// Counts errors instead of printing them, which would fail the test.
class Observer : public vtkTest::ErrorObserver
{
public:
  static Observer* New() { return new Observer; }
  vtkTypeMacro(Observer, vtkTest::ErrorObserver);

  void Execute(vtkObject* caller, unsigned long event, void* data) override
  {
    this->Errors += event == vtkCommand::ErrorEvent ? 1 : 0;
    this->Superclass::Execute(caller, event, data);
  }
  int GetNumberOfErrors() const { return this->Errors; }
  void Clear()
  {
    this->Errors = 0;
    this->Superclass::Clear();
  }

private:
  int Errors = 0;
};

inline void Observe(vtkAlgorithm* filter, Observer* observer)
{
  filter->AddObserver(vtkCommand::ErrorEvent, observer);
  filter->AddObserver(vtkCommand::WarningEvent, observer);
  // After a failed RequestData the executive has an error of its own to tell.
  vtkNew<vtkTest::ErrorObserver> silence;
  filter->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, silence);
}

inline void AbortAtFirstProgress(vtkAlgorithm* filter)
{
  vtkNew<vtkCallbackCommand> abort;
  abort->SetCallback([](vtkObject* caller, unsigned long, void*, void*)
    { vtkAlgorithm::SafeDownCast(caller)->SetAbortExecute(1); });
  filter->AddObserver(vtkCommand::ProgressEvent, abort);
}

using Point = std::array<double, 3>;
using Surface = vtkSmartPointer<vtkPolyData>;

inline Surface FromTriangles(
  const std::vector<Point>& positions, const std::vector<std::array<vtkIdType, 3>>& triangles)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Point& position : positions)
  {
    points->InsertNextPoint(position.data());
  }
  vtkNew<vtkCellArray> cells;
  for (const auto& triangle : triangles)
  {
    cells->InsertNextCell(3, triangle.data());
  }
  auto surface = Surface::New();
  surface->SetPoints(points);
  surface->SetPolys(cells);
  return surface;
}

/// countU x countV quads, each split in two, closed around in u and, on
/// request, in v; oriented by d/du x d/dv. Parameters are in [0, 1].
inline Surface Tube(
  int countU, int countV, bool isClosedInV, const std::function<Point(double, double)>& map)
{
  const int rows = countV + (isClosedInV ? 0 : 1);
  std::vector<Point> positions;
  std::vector<std::array<vtkIdType, 3>> triangles;
  for (int j = 0; j < rows; ++j)
  {
    for (int i = 0; i < countU; ++i)
    {
      positions.push_back(map(static_cast<double>(i) / countU, static_cast<double>(j) / countV));
    }
  }
  for (int j = 0; j < countV; ++j)
  {
    for (int i = 0; i < countU; ++i)
    {
      const vtkIdType a = j * countU + i;
      const vtkIdType b = j * countU + (i + 1) % countU;
      const vtkIdType c = (j + 1) % rows * countU + (i + 1) % countU;
      const vtkIdType d = (j + 1) % rows * countU + i;
      triangles.push_back({ a, b, c });
      triangles.push_back({ a, c, d });
    }
  }
  return FromTriangles(positions, triangles);
}

using cartan::FullTurn;

/// Radii 2 and 0.7.
inline Surface Torus(int around, int aroundTube)
{
  return Tube(around, aroundTube, true,
    [](double u, double v)
    {
      const double distance = 2.0 + 0.7 * std::cos(FullTurn * v);
      return Point{ distance * std::cos(FullTurn * u), distance * std::sin(FullTurn * u),
        0.7 * std::sin(FullTurn * v) };
    });
}

/// Radius 1, length 2, axis z, open at both ends.
inline Surface OpenCylinder(int around, int along)
{
  return Tube(around, along, false,
    [](double u, double v) {
      return Point{ std::cos(FullTurn * u), std::sin(FullTurn * u), 2.0 * v };
    });
}

/// Radius 1, with poles; resolution * (resolution - 2) + 2 points.
inline Surface Sphere(int resolution)
{
  vtkNew<vtkSphereSource> source;
  source->SetRadius(1.0);
  source->SetThetaResolution(resolution);
  source->SetPhiResolution(resolution);
  source->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  source->GenerateNormalsOff();
  source->Update();
  return source->GetOutput();
}

/// Six quads that share their eight corners, oriented outward.
inline Surface Box(double x, double y, double z)
{
  vtkNew<vtkCubeSource> source;
  source->SetXLength(x);
  source->SetYLength(y);
  source->SetZLength(z);
  source->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  source->Update();
  vtkNew<vtkPolyData> bare;
  bare->SetPoints(source->GetOutput()->GetPoints());
  bare->SetPolys(source->GetOutput()->GetPolys());
  vtkNew<vtkCleanPolyData> clean;
  clean->SetInputData(bare);
  clean->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  clean->Update();
  return clean->GetOutput();
}

/// Both as components of one surface, the first's points first.
inline Surface Union(vtkPolyData* first, vtkPolyData* second)
{
  vtkNew<vtkAppendPolyData> append;
  append->AddInputData(first);
  append->AddInputData(second);
  append->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  append->Update();
  return append->GetOutput();
}

/// A copy with the points `firstPoint`... moved.
inline Surface Moved(
  vtkPolyData* surface, const std::function<Point(const Point&)>& move, vtkIdType firstPoint = 0)
{
  auto moved = Surface::New();
  moved->DeepCopy(surface);
  for (vtkIdType i = firstPoint; i < moved->GetNumberOfPoints(); ++i)
  {
    Point point;
    moved->GetPoint(i, point.data());
    moved->GetPoints()->SetPoint(i, move(point).data());
  }
  return moved;
}

inline Surface Scaled(vtkPolyData* surface, double x, double y, double z)
{
  return Moved(surface, [=](const Point& p) { return Point{ x * p[0], y * p[1], z * p[2] }; });
}

/// Rotated and translated.
inline Surface RigidlyMoved(vtkPolyData* surface)
{
  vtkNew<vtkTransform> motion;
  motion->Translate(3.0, -7.0, 5.0);
  motion->RotateWXYZ(123.0, 1.0, -2.0, 0.5);
  return Moved(surface,
    [&](const Point& p)
    {
      Point result;
      motion->TransformPoint(p.data(), result.data());
      return result;
    });
}

/// The same surface with the inside out.
inline Surface Inverted(vtkPolyData* surface)
{
  auto inverted = Surface::New();
  inverted->DeepCopy(surface);
  for (vtkIdType i = 0; i < inverted->GetNumberOfCells(); ++i)
  {
    inverted->ReverseCell(i);
  }
  return inverted;
}

/// The point array "Ids", to see whether arrays are passed through.
inline void AddPointIds(vtkPolyData* surface)
{
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("Ids");
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    ids->InsertNextValue(i);
  }
  surface->GetPointData()->AddArray(ids);
}

inline Surface WithPoint(vtkPolyData* surface, vtkIdType id, double x)
{
  Surface copy = Scaled(surface, 1.0, 1.0, 1.0);
  copy->GetPoints()->SetPoint(id, x, 0.0, 0.0);
  return copy;
}

/// The same triangles, but some start at their second point.
inline Surface WithCellsRotated(vtkPolyData* surface, std::initializer_list<vtkIdType> cells)
{
  Surface copy = Scaled(surface, 1.0, 1.0, 1.0);
  for (const vtkIdType cell : cells)
  {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    copy->GetPolys()->GetCellAtId(cell, size, ids);
    const vtkIdType rotated[3] = { ids[1], ids[2], ids[0] };
    copy->GetPolys()->ReplaceCellAtId(cell, 3, rotated);
  }
  return copy;
}

/// A square in the plane z = 0 of count x count quads, sheared in x.
inline Surface QuadGrid(int count, double shear)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> quads;
  for (vtkIdType j = 0; j <= count; ++j)
  {
    for (vtkIdType i = 0; i <= count; ++i)
    {
      points->InsertNextPoint(i + shear * j, j, 0.0);
      if (i < count && j < count)
      {
        const vtkIdType a = j * (count + 1) + i;
        quads->InsertNextCell({ a, a + 1, a + count + 2, a + count + 1 });
      }
    }
  }
  auto surface = Surface::New();
  surface->SetPoints(points);
  surface->SetPolys(quads);
  return surface;
}

/// Points 0, 1, 2 and, in no cell, 3.
inline Surface SingleTriangleWithUnusedPoint()
{
  return FromTriangles({ Point{ 0, 0, 0 }, Point{ 1, 0, 0 }, Point{ 0, 1, 0 }, Point{ 5, 5, 5 } },
    { std::array<vtkIdType, 3>{ 0, 1, 2 } });
}

inline Surface ThreeTrianglesAtAnEdge()
{
  return FromTriangles(
    { Point{ 0, 0, 0 }, Point{ 1, 0, 0 }, Point{ 0, 1, 0 }, Point{ 0, -1, 0 }, Point{ 0, 0, 1 } },
    { std::array<vtkIdType, 3>{ 0, 1, 2 }, std::array<vtkIdType, 3>{ 1, 0, 3 },
      std::array<vtkIdType, 3>{ 0, 1, 4 } });
}
}
