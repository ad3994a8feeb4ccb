// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/EdgeTable.h"

#include "Base/CountingSort.h"
#include "Base/Error.h"

#include <algorithm>
#include <limits>
#include <string>

namespace cartan
{
EdgeTable::EdgeTable(int numberOfVertices, const Triangles& triangles)
  : Offsets(1, 0)
{
  if (triangles.rows() > std::numeric_limits<int>::max() / 6)
  {
    throw Error(ErrorCode::BadInput,
      "The surface has " + std::to_string(triangles.rows()) + " triangles; at most " +
        std::to_string(std::numeric_limits<int>::max() / 6) +
        " are supported: decimate or split it.");
  }
  const auto count = static_cast<int>(triangles.size());
  const auto smaller = [&triangles](int side)
  { return std::min(SideFrom(triangles, side), SideTo(triangles, side)); };
  const auto larger = [&triangles](int side)
  { return std::max(SideFrom(triangles, side), SideTo(triangles, side)); };

  // By the smaller end, then those of each end by the larger one.
  std::vector<int> first;
  CountingSort(
    numberOfVertices,
    [&](const auto& visit)
    {
      for (int side = 0; side < count; ++side)
      {
        visit(smaller(side), side);
      }
    },
    first, this->Sides);
  for (int v = 0; v < numberOfVertices; ++v)
  {
    std::stable_sort(this->Sides.begin() + first[v], this->Sides.begin() + first[v + 1],
      [&larger](int a, int b) { return larger(a) < larger(b); });
    for (int i = first[v]; i < first[v + 1]; ++i)
    {
      if (i + 1 == first[v + 1] || larger(this->Sides[i]) != larger(this->Sides[i + 1]))
      {
        this->Offsets.push_back(i + 1);
      }
    }
  }
}
}
