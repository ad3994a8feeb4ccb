// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

class vtkDataArray;
class vtkPolyData;
class vtkTable;

namespace cartan
{
/// A fingerprint of contents, 64 bits: two different contents have the same one
/// with a probability of 2^-64. What is kept between updates is found by it, so
/// that neither objects nor their times decide what "the same input" means.
class ContentKey
{
public:
  ContentKey& AddBytes(const void* data, std::size_t size);
  ContentKey& Add(std::uint64_t word);
  ContentKey& Add(double value) { return this->AddBytes(&value, sizeof value); }
  ContentKey& Add(const std::string& text)
  {
    return this->Add(static_cast<std::uint64_t>(text.size())).AddBytes(text.data(), text.size());
  }

  std::uint64_t GetValue() const { return this->Value; }
  bool operator==(const ContentKey& other) const { return this->Value == other.Value; }
  bool operator!=(const ContentKey& other) const { return this->Value != other.Value; }
  bool operator<(const ContentKey& other) const { return this->Value < other.Value; }

private:
  std::uint64_t Value = 0x2545F4914F6CDD1DULL;
};

/// The values of an array, with their type and shape; that of nothing for null.
ContentKey KeyOfArray(vtkDataArray* array);

/// The columns of a table, with their names.
ContentKey KeyOfTable(vtkTable* table);

/// The parts of a surface. They are computed once per state of the data set: an
/// edit that is announced by Modified() on the data set, on its points, cells or
/// attributes, or on their arrays makes a new state.
ContentKey KeyOfPoints(vtkPolyData* surface);
/// Polygons and strips, and how many vertices and lines come before them.
ContentKey KeyOfCells(vtkPolyData* surface);
/// Points and cells.
ContentKey KeyOfSurface(vtkPolyData* surface);
/// The numeric point array `name`; that of nothing where there is none.
ContentKey KeyOfPointArray(vtkPolyData* surface, const std::string& name);

/// Tells that `to` has just been made from `from`: the parts that they share need
/// not be looked at again.
void ShareKeys(vtkPolyData* from, vtkPolyData* to);
}
