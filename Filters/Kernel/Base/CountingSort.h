// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace cartan
{
/// Sorts items by group: those of group g become items[offsets[g]] to
/// items[offsets[g + 1]] - 1, in the order in which they come. `forEach(visit)` calls
/// visit(group, item) for each of them, with 0 <= group < numberOfGroups; it is
/// called twice. O(groups + items).
template <typename Offset, typename Item, typename ForEach>
void CountingSort(std::size_t numberOfGroups, const ForEach& forEach, std::vector<Offset>& offsets,
  std::vector<Item>& items)
{
  offsets.assign(numberOfGroups + 1, 0);
  forEach([&offsets](auto group, const Item&) { ++offsets[group + 1]; });
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  items.resize(offsets.back());
  std::vector<Offset> next(offsets.begin(), offsets.end() - 1);
  forEach([&items, &next](auto group, const Item& item) { items[next[group]++] = item; });
}
}
