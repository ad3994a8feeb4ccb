// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace cartan
{
/// Visits everything that `seeds` reach, once each, in no order to rely on.
///
/// `enter(i)` marks i as visited and returns whether it was not yet, and may be
/// entered; it is asked about the seeds too. `neighbors(i, reach)` calls reach(j)
/// for each neighbor j of i. O(visited + their neighbors).
template <typename Enter, typename Neighbors>
void FloodFill(const std::vector<int>& seeds, const Enter& enter, const Neighbors& neighbors)
{
  std::vector<int> stack;
  const auto reach = [&stack, &enter](int i)
  {
    if (enter(i))
    {
      stack.push_back(i);
    }
  };
  for (const int seed : seeds)
  {
    reach(seed);
  }
  while (!stack.empty())
  {
    const int i = stack.back();
    stack.pop_back();
    neighbors(i, reach);
  }
}
}
