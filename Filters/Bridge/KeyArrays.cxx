// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/KeyArrays.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <set>

namespace cartan
{
namespace
{
using Attributes = std::vector<vtkDataSetAttributes*>;

/// The curves of an array's numbers through all key frames.
struct ArrayCurves
{
  KeyInterpolation Values;

  std::size_t GetBytes() const { return this->Values.GetBytes(); }
};

bool IsFloatingPoint(vtkAbstractArray* array)
{
  return array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE;
}

/// Whether all key frames have the array in the same size.
bool HaveAll(const Attributes& keys, vtkAbstractArray* array)
{
  for (vtkDataSetAttributes* key : keys)
  {
    vtkAbstractArray* other = key->GetAbstractArray(array->GetName());
    if (!other || other->GetNumberOfComponents() != array->GetNumberOfComponents() ||
      other->GetNumberOfTuples() != array->GetNumberOfTuples() ||
      IsFloatingPoint(other) != IsFloatingPoint(array))
    {
      return false;
    }
  }
  return true;
}

ArrayCurves CurvesOf(
  const Attributes& keys, vtkDataArray* array, const std::vector<double>& parameters)
{
  const vtkIdType values = array->GetNumberOfValues();
  const int components = array->GetNumberOfComponents();
  Field columns(values, static_cast<Eigen::Index>(keys.size()));
  for (std::size_t k = 0; k < keys.size(); ++k)
  {
    vtkDataArray* other = keys[k]->GetArray(array->GetName());
    for (vtkIdType i = 0; i < values; ++i)
    {
      columns(i, static_cast<Eigen::Index>(k)) =
        other->GetComponent(i / components, static_cast<int>(i % components));
    }
  }
  return { KeyInterpolation(parameters, std::move(columns)) };
}

/// An array as `like` is, with other values.
vtkSmartPointer<vtkDataArray> NewArray(vtkDataArray* like, const Eigen::VectorXd& values)
{
  auto array = vtk::TakeSmartPointer(like->NewInstance());
  const int components = like->GetNumberOfComponents();
  array->SetName(like->GetName());
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(like->GetNumberOfTuples());
  for (int c = 0; c < components; ++c)
  {
    if (like->GetComponentName(c))
    {
      array->SetComponentName(c, like->GetComponentName(c));
    }
  }
  for (Eigen::Index i = 0; i < values.size(); ++i)
  {
    array->SetComponent(i / components, static_cast<int>(i % components), values[i]);
  }
  return array;
}

std::shared_ptr<ArrayCurves> KeepCurves(const Attributes& keys, vtkDataArray* array,
  const std::vector<double>& parameters, FilterRun& run)
{
  ContentKey key;
  key.AddBytes(parameters.data(), parameters.size() * sizeof(double));
  for (vtkDataSetAttributes* other : keys)
  {
    key.Add(KeyOfArray(other->GetArray(array->GetName())).GetValue());
  }
  return run.Keep<ArrayCurves>(
    key, [&] { return std::make_unique<ArrayCurves>(CurvesOf(keys, array, parameters)); });
}

/// Adds the names of arrays that are dropped to `dropped`.
void Interpolate(const Attributes& keys, const std::vector<double>& parameters, double t,
  vtkDataSetAttributes* output, FilterRun& run, std::set<std::string>& dropped)
{
  std::set<std::string> names;
  for (vtkDataSetAttributes* key : keys)
  {
    for (int i = 0; i < key->GetNumberOfArrays(); ++i)
    {
      vtkAbstractArray* array = key->GetAbstractArray(i);
      if (array->GetName() && array != key->GetNormals())
      {
        names.insert(array->GetName());
      }
    }
  }
  for (const std::string& name : names)
  {
    vtkAbstractArray* array = output->GetAbstractArray(name.c_str());
    if (!array || !HaveAll(keys, array))
    {
      dropped.insert(name);
      output->RemoveArray(name.c_str());
    }
    else if (IsFloatingPoint(array))
    {
      auto* numbers = vtkDataArray::SafeDownCast(array);
      const auto curves = KeepCurves(keys, numbers, parameters, run);
      // Takes the place of the one with the same name, as active scalars too.
      output->AddArray(NewArray(numbers, curves->Values.Evaluate(t, run.Context())));
    }
  }
}
}

std::string InterpolateArrays(const std::vector<vtkPolyData*>& keys,
  const std::vector<double>& parameters, double t, const std::vector<std::string>& expected,
  FilterRun& run)
{
  Attributes points;
  Attributes cells;
  for (vtkPolyData* key : keys)
  {
    points.push_back(key->GetPointData());
    cells.push_back(key->GetCellData());
  }
  std::set<std::string> dropped;
  Interpolate(points, parameters, t, run.Output()->GetPointData(), run, dropped);
  Interpolate(cells, parameters, t, run.Output()->GetCellData(), run, dropped);
  for (const std::string& name : expected)
  {
    dropped.erase(name);
  }
  std::string list;
  for (const std::string& name : dropped)
  {
    list += (list.empty() ? "\"" : ", \"") + name + "\"";
  }
  return list.empty() ? ""
                      : "The arrays " + list +
      " are left out: not all key frames around here have them, in the same size and kind. Give "
      "them to every key frame.";
}
}
