// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/TriangleMesh.h"

#include <vector>

namespace cartan
{
/// The vertices that are in a triangle, in increasing order.
inline std::vector<int> UsedVertices(const TriangleMesh& mesh)
{
  std::vector<int> used;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsUsed(v))
    {
      used.push_back(v);
    }
  }
  return used;
}
}
