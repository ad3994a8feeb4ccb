// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace cartan
{
/// Visits everything that `seeds` reach, once each, and returns it: breadth first,
/// that is in the order of the steps from the nearest seed, the seeds before all.
///
/// `enter(i)` marks i as visited and returns whether it was not yet, and may be
/// entered; it is asked about the seeds too. `neighbors(i, reach)` calls reach(j)
/// for each neighbor j of i. O(visited + their neighbors).
template <typename Enter, typename Neighbors>
std::vector<int> FloodFill(
  const std::vector<int>& seeds, const Enter& enter, const Neighbors& neighbors)
{
  std::vector<int> visited;
  const auto reach = [&visited, &enter](int i)
  {
    if (enter(i))
    {
      visited.push_back(i);
    }
  };
  for (const int seed : seeds)
  {
    reach(seed);
  }
  std::size_t next = 0;
  while (next < visited.size())
  {
    const int i = visited[next++]; // a copy, for reach() makes the list grow
    neighbors(i, reach);
  }
  return visited;
}
}
