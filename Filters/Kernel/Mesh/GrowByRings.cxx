// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/GrowByRings.h"

namespace cartan
{
void RingGrowth::Reach(int v)
{
  if (this->LastGrowth[v] != this->Growth)
  {
    this->LastGrowth[v] = this->Growth;
    this->Reached.push_back(v);
  }
}

const std::vector<int>& RingGrowth::Grow(const std::vector<int>& seeds, int rings)
{
  ++this->Growth;
  this->Reached.clear();
  for (const int seed : seeds)
  {
    this->Reach(seed);
  }
  // A ring begins where the one before it ended.
  std::size_t next = 0;
  for (int ring = 0; ring < rings && next < this->Reached.size(); ++ring)
  {
    for (const std::size_t end = this->Reached.size(); next < end; ++next)
    {
      const int v = this->Reached[next];
      for (int d = this->Mesh.RingBegin(v); d < this->Mesh.RingEnd(v); ++d)
      {
        this->Reach(this->Mesh.Neighbor(d));
      }
    }
  }
  return this->Reached;
}

std::vector<int> GrowByRings(const TriangleMesh& mesh, const std::vector<int>& seeds, int rings)
{
  return RingGrowth(mesh).Grow(seeds, rings);
}
}
