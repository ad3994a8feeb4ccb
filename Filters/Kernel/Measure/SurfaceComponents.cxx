// SPDX-License-Identifier: BSD-3-Clause
#include "Measure/SurfaceComponents.h"

#include "Differential/PieceSystem.h"

#include <algorithm>

namespace cartan
{
SurfaceComponents::SurfaceComponents(const TriangleMesh& mesh, const DistributedRows* pieces)
  : Mesh(mesh)
  , Pieces(pieces)
  , Count(mesh.NumberOfComponents())
{
  if (!pieces)
  {
    return;
  }
  const int numberOfVertices = mesh.NumberOfVertices();
  std::vector<char> isUsed(static_cast<std::size_t>(numberOfVertices));
  for (int v = 0; v < numberOfVertices; ++v)
  {
    isUsed[v] = mesh.IsUsed(v);
  }
  const std::vector<long long> names = PartNames(mesh, *pieces, isUsed);
  std::vector<std::int64_t> first; // each is owned by one rank
  for (int v = 0; v < numberOfVertices; ++v)
  {
    if (this->CountsVertex(v) && pieces->GetName(v) == names[v])
    {
      first.push_back(names[v]);
    }
  }
  first = pieces->Gather(first);
  std::sort(first.begin(), first.end());
  this->Count = static_cast<int>(first.size());
  this->Numbers.assign(static_cast<std::size_t>(numberOfVertices), -1);
  for (int v = 0; v < numberOfVertices; ++v)
  {
    if (isUsed[v])
    {
      this->Numbers[v] =
        static_cast<int>(std::lower_bound(first.begin(), first.end(), names[v]) - first.begin());
    }
  }
}

bool SurfaceComponents::CountsTriangle(int t) const
{
  if (!this->Pieces)
  {
    return true;
  }
  const auto corners = this->Mesh.GetTriangles().row(t);
  int lowest = corners[0];
  for (int c = 1; c < 3; ++c)
  {
    lowest =
      this->Pieces->GetName(corners[c]) < this->Pieces->GetName(lowest) ? corners[c] : lowest;
  }
  return this->Pieces->IsOwned(lowest);
}

void SurfaceComponents::Sum(Eigen::Ref<Eigen::VectorXd> values) const
{
  if (this->Pieces)
  {
    this->Pieces->Sum(values);
  }
}

void SurfaceComponents::Max(Eigen::Ref<Eigen::VectorXd> values) const
{
  if (this->Pieces)
  {
    this->Pieces->Max(values);
  }
}
}
