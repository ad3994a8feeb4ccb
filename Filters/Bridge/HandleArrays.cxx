// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/HandleArrays.h"

#include "Bridge/PointArrays.h"
#include "Kernel/Base/CountingSort.h"

#include "vtkBoundingBox.h"
#include "vtkDataArray.h"
#include "vtkIntArray.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>

namespace cartan
{
namespace
{
/// Sorts the points by handle.
void GroupPoints(Handles& handles)
{
  for (const int handle : handles.OfVertex)
  {
    // Points come in runs of one handle: most of them need no search.
    if (handle > 0 && (handles.Ids.empty() || handles.Ids.back() != handle) &&
      !std::binary_search(handles.Ids.begin(), handles.Ids.end(), handle))
    {
      handles.Ids.insert(std::upper_bound(handles.Ids.begin(), handles.Ids.end(), handle), handle);
    }
  }
  const auto place = [&handles](int handle) {
    return std::lower_bound(handles.Ids.begin(), handles.Ids.end(), handle) - handles.Ids.begin();
  };
  CountingSort(
    handles.Ids.size(),
    [&](const auto& visit)
    {
      for (std::size_t v = 0; v < handles.OfVertex.size(); ++v)
      {
        if (handles.OfVertex[v] > 0)
        {
          visit(place(handles.OfVertex[v]), static_cast<int>(v));
        }
      }
    },
    handles.Offsets, handles.Points);
}
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
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (!mesh.IsUsed(v))
    {
      handles.OfVertex[v] = 0;
    }
  }
  GroupPoints(handles);
  return handles;
}

vtkBoundingBox BoundsOfHandle(vtkPolyData* surface, const std::string& name, int id)
{
  vtkBoundingBox bounds;
  vtkDataArray* array = surface->GetPointData()->GetArray(name.c_str());
  if (!array || surface->GetNumberOfPoints() == 0)
  {
    return bounds;
  }
  try
  {
    const std::vector<int> handles = ReadHandleIds(array, name, surface->GetNumberOfPoints());
    vtkPoints* points = surface->GetPoints();
    for (std::size_t v = 0; v < handles.size(); ++v)
    {
      if (handles[v] == id)
      {
        double point[3];
        points->GetPoint(static_cast<vtkIdType>(v), point);
        bounds.AddPoint(point);
      }
    }
  }
  catch (const Error&)
  {
    // An array that the update refuses has no handles.
  }
  return bounds;
}

vtkBoundingBox WidgetBox(const vtkBoundingBox& handle, const vtkBoundingBox& all)
{
  if (!all.IsValid())
  {
    return { 0.0, 1.0, 0.0, 1.0, 0.0, 1.0 };
  }
  vtkBoundingBox box = handle.IsValid() ? handle : all;
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
