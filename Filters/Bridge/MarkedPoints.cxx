// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/MarkedPoints.h"

#include "Bridge/HandleArrays.h"
#include "Kernel/Base/Error.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkIntArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <iterator>

namespace cartan
{
void RequirePointIds(const std::vector<vtkIdType>& ids, vtkIdType numberOfPoints)
{
  std::vector<vtkIdType> wrong;
  std::copy_if(ids.begin(), ids.end(), std::back_inserter(wrong),
    [numberOfPoints](vtkIdType id) { return id < 0 || id >= numberOfPoints; });
  if (!wrong.empty())
  {
    throw Error(ErrorCode::BadInput,
      std::to_string(wrong.size()) + " of the PointIds (first: " + std::to_string(wrong.front()) +
        ") name no point of the input, whose ids are 0 to " + std::to_string(numberOfPoints - 1) +
        ": they were made for another surface. Copy the selection again, or remove them.");
  }
}

void AddPointIds(const std::vector<vtkIdType>& ids, vtkIdType firstPoint, PointMask& mask)
{
  const auto size = static_cast<vtkIdType>(mask.size());
  for (const vtkIdType id : ids)
  {
    if (id >= firstPoint && id < firstPoint + size)
    {
      mask[id - firstPoint] = 1;
    }
  }
}

vtkSmartPointer<vtkIntArray> CopyHandles(vtkPolyData* input, const std::string& name)
{
  const vtkIdType count = input->GetNumberOfPoints();
  auto handles = vtkSmartPointer<vtkIntArray>::New();
  handles->SetName(name.c_str());
  handles->SetNumberOfTuples(count);
  handles->FillValue(0);
  if (vtkAbstractArray* existing = input->GetPointData()->GetAbstractArray(name.c_str()))
  {
    auto* array = vtkDataArray::SafeDownCast(existing);
    const std::string advice = "it is not a list of handle ids; remove it or choose another "
                               "HandleArrayName.";
    if (!array)
    {
      throw Error(ErrorCode::BadInput,
        "The point array \"" + name + "\" of the input has no numbers: " + advice);
    }
    const std::vector<int> ids = ReadHandleIds(array, name, count, advice);
    std::copy(ids.begin(), ids.end(), handles->GetPointer(0));
  }
  return handles;
}

vtkIdType Mark(vtkIntArray* handles, const PointMask& mask, int id, bool overwrite)
{
  vtkIdType count = 0;
  for (vtkIdType i = 0; i < handles->GetNumberOfTuples(); ++i)
  {
    if (mask[i])
    {
      const int current = handles->GetValue(i);
      if (overwrite || current == 0)
      {
        handles->SetValue(i, id);
      }
      count += handles->GetValue(i) == id;
    }
  }
  return count;
}

std::vector<vtkIdType> FindMarked(vtkDataObject* surfaces, const std::string& name, int id)
{
  std::vector<vtkIdType> found;
  vtkIdType first = 0;
  const auto add = [&](vtkPolyData* surface)
  {
    vtkDataArray* array = surface ? surface->GetPointData()->GetArray(name.c_str()) : nullptr;
    auto* handles = vtkIntArray::SafeDownCast(array);
    for (vtkIdType v = 0; handles && id > 0 && v < handles->GetNumberOfTuples(); ++v)
    {
      if (handles->GetValue(v) == id)
      {
        found.push_back(first + v);
      }
    }
    first += surface ? surface->GetNumberOfPoints() : 0;
  };
  add(vtkPolyData::SafeDownCast(surfaces));
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(surfaces))
  {
    auto blocks = vtk::TakeSmartPointer(composite->NewIterator());
    for (blocks->InitTraversal(); !blocks->IsDoneWithTraversal(); blocks->GoToNextItem())
    {
      add(vtkPolyData::SafeDownCast(blocks->GetCurrentDataObject()));
    }
  }
  return found;
}
}
