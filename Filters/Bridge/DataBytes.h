// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

class vtkAbstractArray;
class vtkCellArray;
class vtkDataSetAttributes;
class vtkFieldData;
class vtkPolyData;

/// Data as bytes, for other ranks of the same machine type. All numbers keep their bits
/// (VTK's own writers shorten ids). Private to the filters, not installed.
namespace cartan
{
class ByteWriter
{
public:
  template <typename Value>
  void Add(const Value& value)
  {
    this->AddBytes(&value, sizeof value);
  }
  void AddBytes(const void* data, std::size_t size);
  void AddText(const std::string& text);
  void AddIds(const std::vector<vtkIdType>& ids);
  void AddArray(vtkAbstractArray* array);
  /// The arrays that CanSend() allows, and which of them are attributes.
  void AddAttributes(vtkDataSetAttributes* data);
  void AddFields(vtkFieldData* data);
  void AddCells(vtkCellArray* cells);
  /// Points, cells and arrays.
  void AddSurface(vtkPolyData* surface);

  std::vector<char> Take() { return std::move(this->Bytes); }

private:
  std::vector<char> Bytes;
};

/// Reads in the order of writing.
class ByteReader
{
public:
  explicit ByteReader(const std::vector<char>& bytes)
    : At(bytes.data())
  {
  }
  template <typename Value>
  Value Read()
  {
    Value value;
    std::memcpy(&value, this->At, sizeof value);
    this->At += sizeof value;
    return value;
  }
  std::string ReadText();
  std::vector<vtkIdType> ReadIds();
  vtkSmartPointer<vtkAbstractArray> ReadArray();
  void ReadAttributes(vtkDataSetAttributes* data);
  void ReadFields(vtkFieldData* data);
  vtkSmartPointer<vtkCellArray> ReadCells();
  vtkSmartPointer<vtkPolyData> ReadSurface();

private:
  void ReadBytes(void* data, std::size_t size);

  const char* At;
};

/// Whether an array has numbers or texts: others stay where they are.
bool CanSend(vtkAbstractArray* array);

/// How an array is found among those of other pieces: by its name, without one by what
/// attribute it is.
std::string KeyOfAttribute(vtkDataSetAttributes* data, vtkAbstractArray* array);
vtkAbstractArray* FindAttribute(vtkDataSetAttributes* data, const std::string& key);
}
