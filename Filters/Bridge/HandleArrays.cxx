// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/HandleArrays.h"

#include "Bridge/PointArrays.h"
#include "Kernel/Base/CountingSort.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
void Handles::GroupPoints()
{
  for (const int handle : this->OfVertex)
  {
    // Points come in runs of one handle: most of them need no search.
    if (handle > 0 && (this->Ids.empty() || this->Ids.back() != handle) &&
      !std::binary_search(this->Ids.begin(), this->Ids.end(), handle))
    {
      this->Ids.insert(std::upper_bound(this->Ids.begin(), this->Ids.end(), handle), handle);
    }
  }
  const auto place = [this](int handle)
  { return std::lower_bound(this->Ids.begin(), this->Ids.end(), handle) - this->Ids.begin(); };
  CountingSort(
    this->Ids.size(),
    [&](const auto& visit)
    {
      for (std::size_t v = 0; v < this->OfVertex.size(); ++v)
      {
        if (this->OfVertex[v] > 0)
        {
          visit(place(this->OfVertex[v]), static_cast<int>(v));
        }
      }
    },
    this->Offsets, this->Points);
}

std::vector<int> ReadHandleIds(
  vtkDataArray* array, const std::string& name, vtkIdType numberOfPoints, const std::string& advice)
{
  if (array->GetNumberOfComponents() != 1 || array->GetNumberOfTuples() != numberOfPoints)
  {
    throw Error(ErrorCode::BadInput,
      "The point array \"" + name + "\" has " + std::to_string(array->GetNumberOfTuples()) +
        " tuples of " + std::to_string(array->GetNumberOfComponents()) + " components; expected " +
        std::to_string(numberOfPoints) + " of 1: " + advice);
  }
  std::vector<int> handles(numberOfPoints, 0);
  IdSample bad;
  auto* integers = vtkIntArray::FastDownCast(array);
  for (vtkIdType v = 0; v < numberOfPoints; ++v)
  {
    const double value = integers ? integers->GetValue(v) : array->GetTuple1(v);
    if (value >= 0.0 && value <= VTK_INT_MAX && value == std::floor(value))
    {
      handles[v] = static_cast<int>(value);
    }
    else
    {
      bad.Add(v);
    }
  }
  if (!bad.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The point array \"" + name + "\" has " + bad.Describe("value", "values") +
        " that are not whole numbers >= 0: " + advice);
  }
  return handles;
}

bool Handles::Has(int id) const
{
  return std::binary_search(this->Ids.begin(), this->Ids.end(), id);
}

std::size_t Handles::GetBytes() const
{
  return sizeof(int) *
    (this->OfVertex.capacity() + this->Ids.capacity() + this->Points.capacity() +
      this->Offsets.capacity());
}

Handles ReadHandles(vtkPolyData* input, const TriangleMesh& mesh, const std::string& name)
{
  if (!input->GetPointData()->HasArray(name.c_str()))
  {
    throw Error(ErrorCode::BadInput,
      "The input has no point array \"" + name +
        "\" that says which points are handles: mark some with vtkMarkHandle (Mark Handle), or "
        "set HandleArrayName.");
  }
  Handles handles;
  handles.OfVertex =
    ReadHandleIds(RequirePointArray(input, name, 1), name, input->GetNumberOfPoints());
  for (std::size_t v = 0; v < handles.OfVertex.size(); ++v)
  {
    if (!mesh.IsUsed(static_cast<int>(v)))
    {
      handles.OfVertex[v] = 0;
    }
  }
  handles.GroupPoints();
  return handles;
}

namespace
{
/// Adds the points of the handles of `surface` to `boxes`.
void AddHandleBoxes(vtkPolyData* surface, const std::string& name, HandleBoxes& boxes)
{
  vtkDataArray* array = surface->GetPointData()->GetArray(name.c_str());
  if (!array || surface->GetNumberOfPoints() == 0)
  {
    return;
  }
  try
  {
    const std::vector<int> handles = ReadHandleIds(array, name, surface->GetNumberOfPoints());
    vtkPoints* points = surface->GetPoints();
    for (std::size_t v = 0; v < handles.size(); ++v)
    {
      if (handles[v] > 0)
      {
        double point[3];
        points->GetPoint(static_cast<vtkIdType>(v), point);
        boxes[handles[v]].AddPoint(point);
      }
    }
  }
  catch (const Error&)
  {
    // The update says what is wrong with the array.
  }
}

/// The box of a widget for a handle of these bounds. A handle of one point gets its
/// size from the box around all points.
vtkBoundingBox WidgetBox(const vtkBoundingBox& handle, const vtkBoundingBox& all)
{
  vtkBoundingBox box = handle;
  const double longest = box.GetMaxLength() > 0.0 ? box.GetMaxLength() : all.GetMaxLength();
  double margins[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    margins[axis] = std::max(0.02 * longest, 0.5 * (0.1 * longest - box.GetLength(axis)));
  }
  box.Inflate(margins[0], margins[1], margins[2]);
  return box;
}
}

HandleBoxes WidgetBoxes(vtkDataObject* input, const std::string& name)
{
  HandleBoxes boxes;
  vtkBoundingBox all;
  const auto add = [&](vtkPolyData* surface)
  {
    if (surface && surface->GetNumberOfPoints() > 0)
    {
      AddHandleBoxes(surface, name, boxes);
      all.AddBounds(surface->GetBounds());
    }
  };
  add(vtkPolyData::SafeDownCast(input));
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(input))
  {
    auto blocks = vtk::TakeSmartPointer(composite->NewIterator());
    for (blocks->InitTraversal(); !blocks->IsDoneWithTraversal(); blocks->GoToNextItem())
    {
      add(vtkPolyData::SafeDownCast(blocks->GetCurrentDataObject()));
    }
  }
  for (auto& entry : boxes)
  {
    entry.second = WidgetBox(entry.second, all);
  }
  return boxes;
}

void WriteBoxes(const HandleBoxes& boxes, vtkIdType maximum, vtkDoubleArray* table)
{
  table->SetNumberOfComponents(7);
  table->SetNumberOfTuples(0);
  for (auto entry = boxes.begin(); entry != boxes.end() && table->GetNumberOfTuples() < maximum;
       ++entry)
  {
    double row[7] = { static_cast<double>(entry->first) };
    entry->second.GetBounds(row + 1);
    table->InsertNextTuple(row);
  }
}
}
