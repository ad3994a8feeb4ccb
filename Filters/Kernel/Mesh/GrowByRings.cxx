// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/GrowByRings.h"

namespace cartan
{
std::vector<int> GrowByRings(const TriangleMesh& mesh, const std::vector<int>& seeds, int rings)
{
  std::vector<char> isReached(mesh.NumberOfVertices(), 0);
  std::vector<int> reached;
  const auto reach = [&isReached, &reached](int v)
  {
    if (!isReached[v])
    {
      isReached[v] = 1;
      reached.push_back(v);
    }
  };
  for (const int seed : seeds)
  {
    reach(seed);
  }
  // A ring begins where the one before it ended.
  std::size_t next = 0;
  for (int ring = 0; ring < rings && next < reached.size(); ++ring)
  {
    for (const std::size_t end = reached.size(); next < end; ++next)
    {
      const int v = reached[next];
      for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
      {
        reach(mesh.Neighbor(d));
      }
    }
  }
  return reached;
}
}
