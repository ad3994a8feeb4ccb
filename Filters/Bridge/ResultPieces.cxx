// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/ResultPieces.h"

#include "Bridge/ContentKey.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <string>

namespace cartan
{
namespace
{
/// The tuples `ids` of an array; zero or empty where the id is negative.
vtkSmartPointer<vtkAbstractArray> TuplesOf(
  vtkAbstractArray* array, const std::vector<vtkIdType>& ids)
{
  auto tuples = vtk::TakeSmartPointer(array->NewInstance());
  tuples->SetName(array->GetName());
  tuples->SetNumberOfComponents(array->GetNumberOfComponents());
  tuples->CopyComponentNames(array);
  tuples->SetNumberOfTuples(static_cast<vtkIdType>(ids.size()));
  if (auto* numbers = vtkDataArray::SafeDownCast(tuples))
  {
    numbers->Fill(0.0);
  }
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    if (ids[i] >= 0)
    {
      tuples->SetTuple(static_cast<vtkIdType>(i), ids[i], array);
    }
  }
  return tuples;
}

/// Arrays that are new or gone, and what is active.
void WriteAttributes(vtkDataSetAttributes* result, vtkDataSetAttributes* whole,
  const std::vector<vtkIdType>& ids, ByteWriter& bytes)
{
  std::vector<std::string> gone;
  for (int index = 0; index < whole->GetNumberOfArrays(); ++index)
  {
    const std::string key = KeyOfAttribute(whole, whole->GetAbstractArray(index));
    if (!FindAttribute(result, key))
    {
      gone.push_back(key);
    }
  }
  bytes.Add(gone.size());
  for (const std::string& key : gone)
  {
    bytes.AddText(key);
  }
  std::vector<vtkAbstractArray*> fresh;
  for (int index = 0; index < result->GetNumberOfArrays(); ++index)
  {
    vtkAbstractArray* array = result->GetAbstractArray(index);
    if (CanSend(array) && FindAttribute(whole, KeyOfAttribute(result, array)) != array)
    {
      fresh.push_back(array);
    }
  }
  bytes.Add(fresh.size());
  for (vtkAbstractArray* array : fresh)
  {
    bytes.AddText(KeyOfAttribute(result, array));
    bytes.AddArray(TuplesOf(array, ids));
  }
  for (int attribute = 0; attribute < vtkDataSetAttributes::NUM_ATTRIBUTES; ++attribute)
  {
    vtkAbstractArray* active = result->GetAbstractAttribute(attribute);
    bytes.AddText(active ? KeyOfAttribute(result, active) : "");
  }
}

int IndexOf(vtkDataSetAttributes* data, vtkAbstractArray* array)
{
  for (int index = 0; index < data->GetNumberOfArrays(); ++index)
  {
    if (data->GetAbstractArray(index) == array)
    {
      return index;
    }
  }
  return -1;
}

void RemoveAttribute(vtkDataSetAttributes* data, const std::string& key)
{
  if (vtkAbstractArray* array = FindAttribute(data, key))
  {
    data->RemoveArray(IndexOf(data, array));
  }
}

void ApplyAttributes(ByteReader& bytes, vtkDataSetAttributes* output)
{
  for (auto gone = bytes.Read<std::size_t>(); gone > 0; --gone)
  {
    RemoveAttribute(output, bytes.ReadText());
  }
  for (auto fresh = bytes.Read<std::size_t>(); fresh > 0; --fresh)
  {
    RemoveAttribute(output, bytes.ReadText());
    output->AddArray(bytes.ReadArray());
  }
  for (int attribute = 0; attribute < vtkDataSetAttributes::NUM_ATTRIBUTES; ++attribute)
  {
    const std::string key = bytes.ReadText();
    vtkAbstractArray* active = key.empty() ? nullptr : FindAttribute(output, key);
    if (active)
    {
      output->SetActiveAttribute(IndexOf(output, active), attribute);
    }
  }
}
}

bool IsOfPieces(vtkPolyData* result, vtkPolyData* whole)
{
  return result->GetNumberOfPoints() == whole->GetNumberOfPoints() &&
    result->GetNumberOfCells() == whole->GetNumberOfCells() &&
    KeyOfCells(result) == KeyOfCells(whole);
}

void WriteDifference(
  vtkPolyData* result, const JoinedPieces& joined, std::size_t rank, ByteWriter& bytes)
{
  vtkPolyData* whole = joined.Whole;
  const bool hasMoved = result->GetPoints() != whole->GetPoints();
  bytes.Add(hasMoved);
  if (hasMoved)
  {
    bytes.AddArray(TuplesOf(result->GetPoints()->GetData(), joined.Points.OfPieces[rank]));
  }
  WriteAttributes(
    result->GetPointData(), whole->GetPointData(), joined.Points.OfPieces[rank], bytes);
  WriteAttributes(result->GetCellData(), whole->GetCellData(), joined.Cells[rank], bytes);
  vtkNew<vtkFieldData> fields;
  for (int index = 0; index < result->GetFieldData()->GetNumberOfArrays(); ++index)
  {
    vtkAbstractArray* array = result->GetFieldData()->GetAbstractArray(index);
    if (array->GetName() && whole->GetFieldData()->GetAbstractArray(array->GetName()) != array)
    {
      fields->AddArray(array);
    }
  }
  bytes.AddFields(fields);
}

void ApplyDifference(vtkPolyData* piece, ByteReader& bytes, vtkPolyData* output)
{
  output->ShallowCopy(piece);
  if (bytes.Read<bool>())
  {
    const auto coordinates = bytes.ReadArray();
    vtkNew<vtkPoints> points;
    points->SetDataType(coordinates->GetDataType());
    points->SetData(vtkDataArray::SafeDownCast(coordinates));
    output->SetPoints(points);
  }
  ApplyAttributes(bytes, output->GetPointData());
  ApplyAttributes(bytes, output->GetCellData());
  bytes.ReadFields(output->GetFieldData());
}
}
