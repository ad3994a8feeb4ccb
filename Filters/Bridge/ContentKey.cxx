// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/ContentKey.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkType.h"

#include <algorithm>
#include <cstring>
#include <list>
#include <map>
#include <mutex>
#include <vector>

namespace cartan
{
namespace
{
// Two odd numbers without pattern: multiplication by them is invertible.
constexpr std::uint64_t FactorA = 0x9E3779B97F4A7C15ULL;
constexpr std::uint64_t FactorB = 0xD6E8FEB86659FD93ULL;

std::uint64_t Rotate(std::uint64_t word, int bits)
{
  return (word << bits) | (word >> (64 - bits));
}

/// One step of a hash: invertible in the state and in the word, so that a single
/// change is never lost.
std::uint64_t Step(std::uint64_t state, std::uint64_t word)
{
  return Rotate(state ^ (word * FactorA), 29) * FactorB;
}

/// Spreads each bit over all.
std::uint64_t Spread(std::uint64_t word)
{
  word ^= word >> 32;
  word *= FactorA;
  word ^= word >> 29;
  word *= FactorB;
  return word ^ (word >> 32);
}

/// The states of data sets whose parts are known, most recently used first. A
/// state is an object and its time: VTK gives no time twice.
class KnownStates
{
public:
  /// The key of a part of the surface, computed by `compute` if it is new.
  template <typename Compute>
  ContentKey Get(vtkPolyData* surface, const std::string& part, const Compute& compute)
  {
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      const std::map<std::string, ContentKey>& keys = this->Find(surface);
      const auto found = keys.find(part);
      if (found != keys.end())
      {
        return found->second;
      }
    }
    const ContentKey key = compute();
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Find(surface).emplace(part, key);
    return key;
  }

  void Share(vtkPolyData* from, vtkPolyData* to)
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    const std::map<std::string, ContentKey> known = this->Find(from);
    std::map<std::string, ContentKey>& keys = this->Find(to);
    for (const auto& [part, key] : known)
    {
      if (IsShared(part, from, to))
      {
        keys.emplace(part, key);
      }
    }
  }

private:
  /// More states than pipelines have surfaces in use at a time.
  static constexpr std::size_t MaximumNumberOfStates = 256;

  struct State
  {
    const vtkPolyData* Surface;
    vtkMTimeType Time;
    std::map<std::string, ContentKey> Keys;
  };

  std::map<std::string, ContentKey>& Find(vtkPolyData* surface)
  {
    const vtkMTimeType time = surface->GetMTime();
    for (auto state = this->States.begin(); state != this->States.end(); ++state)
    {
      if (state->Surface == surface && state->Time == time)
      {
        this->States.splice(this->States.begin(), this->States, state);
        return this->States.front().Keys;
      }
    }
    this->States.push_front({ surface, time, {} });
    if (this->States.size() > MaximumNumberOfStates)
    {
      this->States.pop_back();
    }
    return this->States.front().Keys;
  }

  static bool IsShared(const std::string& part, vtkPolyData* from, vtkPolyData* to)
  {
    if (part == "points")
    {
      return from->GetPoints() == to->GetPoints();
    }
    if (part == "cells")
    {
      return from->GetPolys() == to->GetPolys() && from->GetStrips() == to->GetStrips() &&
        from->GetNumberOfVerts() == to->GetNumberOfVerts() &&
        from->GetNumberOfLines() == to->GetNumberOfLines();
    }
    const std::string name = part.substr(part.find(':') + 1);
    return from->GetPointData()->GetArray(name.c_str()) ==
      to->GetPointData()->GetArray(name.c_str());
  }

  std::mutex Mutex;
  std::list<State> States;
};

KnownStates& States()
{
  static KnownStates states;
  return states;
}

void AddCells(vtkCellArray* cells, ContentKey& key)
{
  key.Add(KeyOfArray(cells->GetOffsetsArray()).GetValue());
  key.Add(KeyOfArray(cells->GetConnectivityArray()).GetValue());
}
}

ContentKey& ContentKey::Add(std::uint64_t word)
{
  this->Value = Spread(Step(this->Value, word));
  return *this;
}

ContentKey& ContentKey::AddBytes(const void* data, std::size_t size)
{
  // Four independent states keep the processor busy.
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::uint64_t states[4] = { this->Value, this->Value ^ FactorA, this->Value ^ FactorB,
    this->Value + FactorA };
  std::size_t at = 0;
  for (; at + 32 <= size; at += 32)
  {
    std::uint64_t words[4];
    std::memcpy(words, bytes + at, 32);
    for (int lane = 0; lane < 4; ++lane)
    {
      states[lane] = Step(states[lane], words[lane]);
    }
  }
  for (; at < size; at += 8)
  {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + at, std::min<std::size_t>(8, size - at));
    states[0] = Step(states[0], word);
  }
  for (const std::uint64_t state : states)
  {
    this->Add(state);
  }
  return this->Add(static_cast<std::uint64_t>(size));
}

ContentKey KeyOfArray(vtkDataArray* array)
{
  ContentKey key;
  if (!array)
  {
    return key;
  }
  key.Add(static_cast<std::uint64_t>(array->GetDataType()));
  key.Add(static_cast<std::uint64_t>(array->GetNumberOfComponents()));
  key.Add(static_cast<std::uint64_t>(array->GetNumberOfTuples()));
  if (array->GetNumberOfValues() > 0 && array->HasStandardMemoryLayout())
  {
    return key.AddBytes(array->GetVoidPointer(0),
      static_cast<std::size_t>(array->GetNumberOfValues()) * array->GetDataTypeSize());
  }
  std::vector<double> tuple(array->GetNumberOfComponents());
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    array->GetTuple(i, tuple.data());
    key.AddBytes(tuple.data(), tuple.size() * sizeof(double));
  }
  return key;
}

ContentKey KeyOfTable(vtkTable* table)
{
  ContentKey key;
  for (vtkIdType column = 0; table && column < table->GetNumberOfColumns(); ++column)
  {
    vtkAbstractArray* array = table->GetColumn(column);
    key.Add(std::string(array->GetName() ? array->GetName() : ""));
    key.Add(KeyOfArray(vtkDataArray::SafeDownCast(array)).GetValue());
  }
  return key;
}

ContentKey KeyOfPoints(vtkPolyData* surface)
{
  return States().Get(surface, "points",
    [surface]()
    { return KeyOfArray(surface->GetPoints() ? surface->GetPoints()->GetData() : nullptr); });
}

ContentKey KeyOfCells(vtkPolyData* surface)
{
  return States().Get(surface, "cells",
    [surface]()
    {
      ContentKey key;
      key.Add(static_cast<std::uint64_t>(surface->GetNumberOfVerts()));
      key.Add(static_cast<std::uint64_t>(surface->GetNumberOfLines()));
      AddCells(surface->GetPolys(), key);
      AddCells(surface->GetStrips(), key);
      return key;
    });
}

ContentKey KeyOfSurface(vtkPolyData* surface)
{
  ContentKey key = KeyOfCells(surface);
  return key.Add(KeyOfPoints(surface).GetValue());
}

ContentKey KeyOfPointArray(vtkPolyData* surface, const std::string& name)
{
  return States().Get(surface, "array:" + name,
    [surface, &name]() { return KeyOfArray(surface->GetPointData()->GetArray(name.c_str())); });
}

void ShareKeys(vtkPolyData* from, vtkPolyData* to)
{
  if (from && to && from != to)
  {
    States().Share(from, to);
  }
}
}
