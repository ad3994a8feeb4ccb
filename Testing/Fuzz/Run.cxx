// SPDX-License-Identifier: BSD-3-Clause
#include "Run.h"

#include "Fields.h"
#include "Messages.h"
#include "Settings.h"

#include "vtkCoatingTransfer.h"
#include "vtkDataArray.h"
#include "vtkDifferentialCoordinates.h"
#include "vtkDiscreteForms.h"
#include "vtkHandleMotion.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPrepareSurface.h"
#include "vtkStringArray.h"
#include "vtkSurfaceDeformation.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

namespace fuzz
{
namespace
{
vtkSmartPointer<vtkHandleMotion> ToMotion(const HandleMotion& from)
{
  auto motion = vtkSmartPointer<vtkHandleMotion>::New();
  if (from.IsMatrix)
  {
    vtkNew<vtkMatrix4x4> matrix;
    for (int i = 0; i < 4; ++i)
    {
      for (int j = 0; j < 4; ++j)
      {
        matrix->SetElement(i, j, from.Matrix(i, j));
      }
    }
    motion->SetMatrix(matrix);
    return motion;
  }
  motion->SetAxis(from.Axis.x(), from.Axis.y(), from.Axis.z());
  motion->SetAngle(from.Angle);
  motion->SetScale(from.Scale, from.Scale, from.Scale);
  motion->SetCenter(from.Center.x(), from.Center.y(), from.Center.z());
  motion->SetTranslation(from.Translation.x(), from.Translation.y(), from.Translation.z());
  return motion;
}

void SetDeformation(vtkSurfaceDeformation* filter, const Case& of)
{
  filter->RemoveAllHandleMotions();
  for (const HandleMotion& motion : of.Motions)
  {
    filter->SetHandleMotion(motion.Id, ToMotion(motion));
  }
  const auto nameOf = [&](const char* name) { return of.Surface.Find(name) ? name : ""; };
  filter->SetTargetPositionArrayName(nameOf("TargetPosition"));
  filter->SetRotationVectorArrayName(nameOf("RotationVector"));
  filter->SetTransformArrayName(nameOf("Transform"));
  filter->SetConstraintWeightArrayName(nameOf("ConstraintWeight"));
}

vtkSmartPointer<vtkDataObject> FormsOf(vtkPolyData* surface)
{
  vtkNew<vtkDiscreteForms> forms;
  const auto log = Observe(forms);
  forms->SetInputData(surface);
  forms->Update();
  return forms->GetFormsTable();
}

/// The surface with the differential coordinates of Others[0], or else its own.
vtkSmartPointer<vtkDataObject> WithCoordinates(
  const Case& of, const std::vector<vtkSmartPointer<vtkPolyData>>& inputs)
{
  vtkNew<vtkDifferentialCoordinates> coordinates;
  const auto log = Observe(coordinates);
  coordinates->SetInputData(inputs.back());
  coordinates->SetLaplacianWeights(static_cast<int>(of.Get("LaplacianWeights", 1.0)));
  coordinates->SetNormalization(static_cast<int>(of.Get("Normalization", 2.0)));
  coordinates->Update();
  if (!log->Errors.empty())
  {
    return inputs[0];
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->ShallowCopy(coordinates->GetOutput());
  surface->SetPoints(inputs[0]->GetPoints());
  return surface;
}

/// The prepared surface, moved as Others[0] says.
vtkSmartPointer<vtkPolyData> PreparedAndMoved(vtkPolyData* surface, const Case& of)
{
  vtkNew<vtkPrepareSurface> prepare;
  const auto log = Observe(prepare);
  prepare->SetInputData(surface);
  prepare->Update();
  auto moved = vtkSmartPointer<vtkPolyData>::New();
  moved->DeepCopy(prepare->GetOutput());
  vtkDataArray* ids = moved->GetPointData()->GetArray("OriginalPointIds");
  for (vtkIdType i = 0; ids && !of.Others.empty() && i < moved->GetNumberOfPoints(); ++i)
  {
    const auto original = static_cast<std::size_t>(ids->GetComponent(i, 0));
    moved->GetPoints()->SetPoint(i, of.Others[0][original].data());
  }
  return moved;
}

std::vector<vtkSmartPointer<vtkPolyData>> InputsOf(const Case& of)
{
  std::vector<vtkSmartPointer<vtkPolyData>> inputs = { ToPolyData(of.Surface) };
  for (const std::vector<Eigen::Vector3d>& points : of.Others)
  {
    Mesh other = of.Surface;
    other.Points = points;
    inputs.push_back(ToPolyData(other));
  }
  return inputs;
}

/// A cloud with a line through all of its points.
vtkSmartPointer<vtkPolyData> ToLine(const Case& of, std::size_t cloud)
{
  Mesh line;
  line.Points = of.Clouds[cloud];
  line.IsFloat = of.Surface.IsFloat;
  if (cloud < of.CloudKeys.size())
  {
    const Ids& ids = of.CloudKeys[cloud];
    Array keys;
    keys.Name = "SourcePoint";
    keys.IsInteger = true;
    keys.Values = Eigen::VectorXd(static_cast<Eigen::Index>(ids.size()));
    std::copy(ids.begin(), ids.end(), keys.Values.data());
    line.Arrays.push_back(keys);
  }
  line.Lines.emplace_back();
  for (vtkIdType i = 0; i < line.NumberOfPoints(); ++i)
  {
    line.Lines[0].push_back(i);
  }
  const vtkSmartPointer<vtkPolyData> data = ToPolyData(line);
  if (cloud < of.CloudNames.size())
  {
    vtkNew<vtkStringArray> names;
    names->SetName("label");
    for (const vtkIdType name : of.CloudNames[cloud])
    {
      names->InsertNextValue("L" + std::to_string(name));
    }
    data->GetPointData()->AddArray(names);
  }
  return data;
}

/// The tetrahedra, with the points and arrays of the surface.
vtkSmartPointer<vtkUnstructuredGrid> ToGrid(const Case& of, vtkPolyData* surface)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(surface->GetPoints());
  grid->GetPointData()->ShallowCopy(surface->GetPointData());
  for (const Ids& ids : of.Tetrahedra)
  {
    grid->InsertNextCell(VTK_TETRA, 4, ids.data());
  }
  return grid;
}

/// The carried points of a grid as points of the surface.
vtkSmartPointer<vtkPolyData> ToSurface(vtkDataObject* output, vtkPolyData* input)
{
  auto* grid = vtkUnstructuredGrid::SafeDownCast(output);
  if (!grid)
  {
    return vtkPolyData::SafeDownCast(output);
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  if (grid->GetNumberOfCells() > 0)
  {
    surface->ShallowCopy(input);
    surface->SetPoints(grid->GetPoints());
    surface->GetPointData()->ShallowCopy(grid->GetPointData());
    surface->GetFieldData()->ShallowCopy(grid->GetFieldData());
  }
  return surface;
}

void Connect(
  vtkAlgorithm* filter, const Case& of, const std::vector<vtkSmartPointer<vtkPolyData>>& inputs)
{
  for (int port = 0; port < filter->GetNumberOfInputPorts(); ++port)
  {
    filter->SetInputConnection(port, nullptr);
  }
  filter->SetInputDataObject(0, inputs[0]);
  if (of.Filter == "SurfaceMorph")
  {
    for (std::size_t i = 1; i < inputs.size(); ++i)
    {
      filter->AddInputDataObject(0, inputs[i]);
    }
  }
  else if (of.Filter == "FrameReconstruction")
  {
    filter->SetInputDataObject(1, FormsOf(inputs[0]));
  }
  else if (of.Filter == "DifferentialReconstruction")
  {
    filter->SetInputDataObject(0, WithCoordinates(of, inputs));
  }
  else if (of.Filter == "RestoreSurface")
  {
    filter->SetInputDataObject(0, PreparedAndMoved(inputs[0], of));
    filter->SetInputDataObject(1, inputs[0]);
  }
  else if (of.Filter == "ExampleBasedDeformation")
  {
    for (std::size_t i = 1; i < inputs.size(); ++i)
    {
      filter->AddInputDataObject(1, inputs[i]);
    }
  }
  else if (!of.Clouds.empty())
  {
    for (std::size_t i = 0; i < of.Clouds.size(); ++i)
    {
      filter->SetInputDataObject(static_cast<int>(i) + 1, ToLine(of, i));
    }
  }
  else
  {
    for (int port = 1; port < filter->GetNumberOfInputPorts(); ++port)
    {
      const auto i = static_cast<std::size_t>(port);
      filter->SetInputDataObject(port, i < inputs.size() ? inputs[i].Get() : nullptr);
    }
  }
  if (!of.Tetrahedra.empty())
  {
    filter->SetInputDataObject(of.Filter == "CarryAlong" ? 0 : 1, ToGrid(of, inputs[0]));
  }
  if (auto* deformation = vtkSurfaceDeformation::SafeDownCast(filter))
  {
    SetDeformation(deformation, of);
  }
  if (auto* coating = vtkCoatingTransfer::SafeDownCast(filter))
  {
    coating->SetRegionArrayName(of.Surface.Find("Region") ? "Region" : "");
  }
}
}

const Field* Outcome::Find(const std::string& name, Field::Place where) const
{
  const auto found = std::find_if(this->Fields.begin(), this->Fields.end(),
    [&](const Field& field) { return field.Name == name && field.Where == where; });
  return found == this->Fields.end() ? nullptr : &*found;
}

Outcome Run(const Case& of, const Case* before)
{
  vtkSmartPointer<vtkAlgorithm> filter = NewFilter(of);
  const auto log = Observe(filter);
  if (before)
  {
    Connect(filter, *before, InputsOf(*before));
    filter->Update();
    log->Errors.clear();
    log->Warnings.clear();
  }
  const auto inputs = InputsOf(of);
  const auto untouched = InputsOf(of);
  Connect(filter, of, inputs);
  filter->Update();

  Outcome outcome;
  outcome.Errors = log->Errors;
  outcome.Warnings = log->Warnings;
  for (std::size_t i = 0; i < inputs.size(); ++i)
  {
    outcome.IsInputChanged |= !DescribeDifference(inputs[i], untouched[i]).empty();
  }
  outcome.Surface = ToSurface(filter->GetOutputDataObject(0), inputs[0]);
  outcome.Table = filter->GetNumberOfOutputPorts() > 1
    ? vtkTable::SafeDownCast(filter->GetOutputDataObject(1))
    : nullptr;
  outcome.Fields = FieldsOf(of, outcome, inputs[0]);
  return outcome;
}
}
