// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/PointArrays.h"

#include "vtkArrayDispatch.h"
#include "vtkDataArrayRange.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>

namespace cartan
{
namespace
{
const char* const FrameArrayNames[3] = { "FrameTangent1", "FrameTangent2", "FrameNormal" };

/// Copies the tuples of an array of any type into a matrix row by row.
struct CopyTuples
{
  template <typename Array>
  void operator()(Array* array, double* to, const ExecutionContext& context) const
  {
    const int components = array->GetNumberOfComponents();
    const auto tuples = vtk::DataArrayTupleRange(array);
    context.For(static_cast<int>(tuples.size()),
      [&](int begin, int end)
      {
        for (int i = begin; i < end; ++i)
        {
          const auto tuple = tuples[i];
          double* row = to + static_cast<std::size_t>(i) * components;
          for (int c = 0; c < components; ++c)
          {
            row[c] = static_cast<double>(tuple[c]);
          }
        }
      });
  }
};

void AddValues(vtkDataSetAttributes* attributes, const std::string& name, const double* values,
  Eigen::Index numberOfTuples, Eigen::Index components)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name.c_str());
  array->SetNumberOfComponents(static_cast<int>(components));
  array->SetNumberOfTuples(numberOfTuples);
  std::copy(values, values + numberOfTuples * components, array->GetPointer(0));
  attributes->AddArray(array);
}

/// The vertices of a piece go on with those of other ranks.
template <typename Values>
Eigen::Index CountOf(const Values& values, vtkPolyData* output)
{
  return std::min<Eigen::Index>(values.rows(), output->GetNumberOfPoints());
}
}

Points ReadPoints(vtkPolyData* input, const ExecutionContext& context)
{
  vtkDataArray* coordinates = input->GetPoints()->GetData();
  Points points(coordinates->GetNumberOfTuples(), 3);
  const CopyTuples copy;
  if (!vtkArrayDispatch::DispatchByValueType<vtkArrayDispatch::Reals>::Execute(
        coordinates, copy, points.data(), context))
  {
    copy(coordinates, points.data(), context);
  }
  return points;
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

Field ReadPointArray(vtkPolyData* input, const std::string& name, int components,
  const std::vector<int>& points, const std::string& what)
{
  vtkDataArray* array = RequirePointArray(input, name, components);
  Field values(static_cast<Eigen::Index>(points.size()), components);
  IdSample bad;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const auto row = static_cast<Eigen::Index>(i);
    array->GetTuple(points[i], values.row(row).data());
    if (!values.row(row).allFinite())
    {
      bad.Add(points[i]);
    }
  }
  if (!bad.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The point array \"" + name + "\" has " + bad.Describe(what, what + "s") +
        " with a NaN or infinite value.");
  }
  return values;
}

void AddArray(vtkDataSetAttributes* attributes, const std::string& name, const Field& values)
{
  AddValues(attributes, name, values.data(), values.rows(), values.cols());
}

void AddPointArray(vtkPolyData* output, const std::string& name, const Eigen::VectorXd& values)
{
  AddValues(output->GetPointData(), name, values.data(), CountOf(values, output), 1);
}

void AddPointArray(vtkPolyData* output, const std::string& name, const Points& values)
{
  AddValues(output->GetPointData(), name, values.data(), CountOf(values, output), 3);
}

double AddFieldValue(vtkDataObject* output, const std::string& name, double value)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name.c_str());
  array->InsertNextValue(value);
  output->GetFieldData()->AddArray(array);
  return value;
}

void AddColumn(vtkTable* table, const std::string& name, const Eigen::VectorXd& values)
{
  AddValues(table->GetRowData(), name, values.data(), values.size(), 1);
}

void AddFrameArrays(vtkPolyData* output, const Matrices& frames)
{
  for (int k = 0; k < 3; ++k)
  {
    AddPointArray(output, FrameArrayNames[k], Points(frames.middleCols<3>(3 * k)));
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
}
