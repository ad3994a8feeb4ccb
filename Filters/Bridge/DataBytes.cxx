// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/DataBytes.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"

namespace cartan
{
namespace
{
constexpr int NumberOfAttributes = vtkDataSetAttributes::NUM_ATTRIBUTES;

/// A bit for each attribute that an array is.
unsigned AttributesOf(vtkDataSetAttributes* data, vtkAbstractArray* array)
{
  unsigned bits = 0;
  for (int attribute = 0; attribute < NumberOfAttributes; ++attribute)
  {
    bits |= data->GetAbstractAttribute(attribute) == array ? 1U << attribute : 0U;
  }
  return bits;
}

std::size_t SizeOf(vtkAbstractArray* array)
{
  return static_cast<std::size_t>(array->GetNumberOfValues()) *
    static_cast<std::size_t>(array->GetDataTypeSize());
}

std::vector<vtkAbstractArray*> SendableArrays(vtkFieldData* data)
{
  std::vector<vtkAbstractArray*> arrays;
  for (int index = 0; index < data->GetNumberOfArrays(); ++index)
  {
    if (CanSend(data->GetAbstractArray(index)))
    {
      arrays.push_back(data->GetAbstractArray(index));
    }
  }
  return arrays;
}
}

bool CanSend(vtkAbstractArray* array)
{
  return vtkStringArray::SafeDownCast(array) ||
    (vtkDataArray::SafeDownCast(array) && array->GetDataType() != VTK_BIT);
}

std::string KeyOfAttribute(vtkDataSetAttributes* data, vtkAbstractArray* array)
{
  return array->GetName() ? array->GetName()
                          : "attribute " + std::to_string(AttributesOf(data, array));
}

vtkAbstractArray* FindAttribute(vtkDataSetAttributes* data, const std::string& key)
{
  for (int index = 0; index < data->GetNumberOfArrays(); ++index)
  {
    if (KeyOfAttribute(data, data->GetAbstractArray(index)) == key)
    {
      return data->GetAbstractArray(index);
    }
  }
  return nullptr;
}

void ByteWriter::AddBytes(const void* data, std::size_t size)
{
  const char* bytes = static_cast<const char*>(data);
  this->Bytes.insert(this->Bytes.end(), bytes, bytes + size);
}

void ByteWriter::AddText(const std::string& text)
{
  this->Add(text.size());
  this->AddBytes(text.data(), text.size());
}

void ByteWriter::AddIds(const std::vector<vtkIdType>& ids)
{
  this->Add(ids.size());
  this->AddBytes(ids.data(), ids.size() * sizeof(vtkIdType));
}

void ByteWriter::AddArray(vtkAbstractArray* array)
{
  this->Add(array->GetDataType());
  this->Add(array->GetName() != nullptr);
  this->AddText(array->GetName() ? array->GetName() : "");
  this->Add(array->GetNumberOfComponents());
  this->Add(array->HasAComponentName());
  for (int c = 0; array->HasAComponentName() && c < array->GetNumberOfComponents(); ++c)
  {
    const char* name = array->GetComponentName(c);
    this->AddText(name ? name : "");
  }
  this->Add(array->GetNumberOfTuples());
  if (auto* texts = vtkStringArray::SafeDownCast(array))
  {
    for (vtkIdType i = 0; i < texts->GetNumberOfValues(); ++i)
    {
      this->AddText(texts->GetValue(i));
    }
    return;
  }
  this->AddBytes(array->GetVoidPointer(0), SizeOf(array));
}

void ByteWriter::AddAttributes(vtkDataSetAttributes* data)
{
  const std::vector<vtkAbstractArray*> arrays = SendableArrays(data);
  this->Add(arrays.size());
  for (vtkAbstractArray* array : arrays)
  {
    this->Add(AttributesOf(data, array));
    this->AddArray(array);
  }
}

void ByteWriter::AddFields(vtkFieldData* data)
{
  const std::vector<vtkAbstractArray*> arrays = SendableArrays(data);
  this->Add(arrays.size());
  for (vtkAbstractArray* array : arrays)
  {
    this->AddArray(array);
  }
}

void ByteWriter::AddCells(vtkCellArray* cells)
{
  vtkNew<vtkIdTypeArray> old; // counts and ids, whatever the storage is
  cells->ExportLegacyFormat(old);
  this->AddArray(old);
}

void ByteWriter::AddSurface(vtkPolyData* surface)
{
  vtkPoints* points = surface->GetPoints();
  this->Add(points != nullptr);
  if (points)
  {
    this->AddArray(points->GetData());
  }
  for (vtkCellArray* cells :
    { surface->GetVerts(), surface->GetLines(), surface->GetPolys(), surface->GetStrips() })
  {
    this->AddCells(cells);
  }
  this->AddAttributes(surface->GetPointData());
  this->AddAttributes(surface->GetCellData());
  this->AddFields(surface->GetFieldData());
}

void ByteReader::ReadBytes(void* data, std::size_t size)
{
  if (size > 0)
  {
    std::memcpy(data, this->At, size);
    this->At += size;
  }
}

std::string ByteReader::ReadText()
{
  std::string text(this->Read<std::size_t>(), ' ');
  this->ReadBytes(text.data(), text.size());
  return text;
}

std::vector<vtkIdType> ByteReader::ReadIds()
{
  std::vector<vtkIdType> ids(this->Read<std::size_t>());
  this->ReadBytes(ids.data(), ids.size() * sizeof(vtkIdType));
  return ids;
}

vtkSmartPointer<vtkAbstractArray> ByteReader::ReadArray()
{
  auto array = vtk::TakeSmartPointer(vtkAbstractArray::CreateArray(this->Read<int>()));
  const bool hasName = this->Read<bool>();
  const std::string name = this->ReadText();
  array->SetName(hasName ? name.c_str() : nullptr);
  array->SetNumberOfComponents(this->Read<int>());
  const bool hasComponentNames = this->Read<bool>();
  for (int c = 0; hasComponentNames && c < array->GetNumberOfComponents(); ++c)
  {
    array->SetComponentName(c, this->ReadText().c_str());
  }
  array->SetNumberOfTuples(this->Read<vtkIdType>());
  if (auto* texts = vtkStringArray::SafeDownCast(array))
  {
    for (vtkIdType i = 0; i < texts->GetNumberOfValues(); ++i)
    {
      texts->SetValue(i, this->ReadText());
    }
    return array;
  }
  this->ReadBytes(array->GetVoidPointer(0), SizeOf(array));
  return array;
}

void ByteReader::ReadAttributes(vtkDataSetAttributes* data)
{
  const auto count = this->Read<std::size_t>();
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto attributes = this->Read<unsigned>();
    const int index = data->AddArray(this->ReadArray());
    for (int attribute = 0; attribute < NumberOfAttributes; ++attribute)
    {
      if (attributes & (1U << attribute))
      {
        data->SetActiveAttribute(index, attribute);
      }
    }
  }
}

void ByteReader::ReadFields(vtkFieldData* data)
{
  const auto count = this->Read<std::size_t>();
  for (std::size_t i = 0; i < count; ++i)
  {
    data->AddArray(this->ReadArray());
  }
}

vtkSmartPointer<vtkCellArray> ByteReader::ReadCells()
{
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->ImportLegacyFormat(vtkIdTypeArray::SafeDownCast(this->ReadArray()));
  return cells;
}

vtkSmartPointer<vtkPolyData> ByteReader::ReadSurface()
{
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  if (this->Read<bool>())
  {
    const auto coordinates = this->ReadArray();
    vtkNew<vtkPoints> points;
    points->SetDataType(coordinates->GetDataType());
    points->SetData(vtkDataArray::SafeDownCast(coordinates));
    surface->SetPoints(points);
  }
  surface->SetVerts(this->ReadCells());
  surface->SetLines(this->ReadCells());
  surface->SetPolys(this->ReadCells());
  surface->SetStrips(this->ReadCells());
  this->ReadAttributes(surface->GetPointData());
  this->ReadAttributes(surface->GetCellData());
  this->ReadFields(surface->GetFieldData());
  return surface;
}
}
