// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cartan
{
/// A small set of ids >= 0 that is cleared and filled again and again, such as the points
/// around one vertex after another: a table of open addressing, which is kept at most half
/// full and allocates only where a set is larger than all before.
class IdSet
{
public:
  IdSet()
    : Slots(SmallestTable, Empty)
  {
  }

  void Clear()
  {
    this->Slots.assign(SmallestTable, Empty);
    this->Count = 0;
  }

  bool Contains(int id) const { return this->Slots[this->SlotOf(id)] == id; }

  /// An id that is there already changes nothing.
  void Insert(int id)
  {
    int& slot = this->Slots[this->SlotOf(id)];
    if (slot == Empty)
    {
      slot = id;
      if (2 * ++this->Count > this->Slots.size())
      {
        this->Grow();
      }
    }
  }

private:
  static constexpr std::size_t SmallestTable = 256; // a power of two, as all sizes
  static constexpr int Empty = -1;

  /// Where the id is, or the empty slot where it would be.
  std::size_t SlotOf(int id) const
  {
    const std::size_t last = this->Slots.size() - 1;
    // Multiples of 2^64 over the golden ratio spread consecutive ids.
    std::size_t slot = (static_cast<std::uint64_t>(id) * 11400714819323198485ULL >> 32) & last;
    while (this->Slots[slot] != Empty && this->Slots[slot] != id)
    {
      slot = (slot + 1) & last;
    }
    return slot;
  }

  void Grow()
  {
    std::vector<int> old(2 * this->Slots.size(), Empty);
    old.swap(this->Slots);
    for (const int id : old)
    {
      if (id != Empty)
      {
        this->Slots[this->SlotOf(id)] = id;
      }
    }
  }

  std::vector<int> Slots;
  std::size_t Count = 0;
};
}
