// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/GraphPatches.h"

#include "Mesh/UsedVertices.h"

#ifdef CARTAN_HAVE_METIS
#include <metis.h>
#endif

#include <string>

namespace cartan
{
#ifdef CARTAN_HAVE_METIS
namespace
{
/// The patch of each of the used vertices.
std::vector<idx_t> Partition(
  const TriangleMesh& mesh, const std::vector<int>& used, int numberOfPatches)
{
  std::vector<idx_t> indices(mesh.NumberOfVertices(), -1);
  for (std::size_t i = 0; i < used.size(); ++i)
  {
    indices[used[i]] = static_cast<idx_t>(i);
  }
  std::vector<idx_t> offsets = { 0 };
  std::vector<idx_t> neighbors;
  neighbors.reserve(mesh.NumberOfDirectedEdges());
  for (const int v : used)
  {
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      neighbors.push_back(indices[mesh.Neighbor(d)]);
    }
    offsets.push_back(static_cast<idx_t>(neighbors.size()));
  }
  auto vertices = static_cast<idx_t>(used.size());
  idx_t constraints = 1;
  idx_t patches = numberOfPatches;
  idx_t cut = 0;
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  std::vector<idx_t> part(used.size(), 0);
  if (METIS_PartGraphKway(&vertices, &constraints, offsets.data(), neighbors.data(), nullptr,
        nullptr, nullptr, &patches, nullptr, nullptr, options, &cut, part.data()) != METIS_OK)
  {
    throw Error(
      ErrorCode::SolverFailed, "The surface could not be split into patches: METIS failed.");
  }
  return part;
}
}
#endif

bool HasMetis()
{
#ifdef CARTAN_HAVE_METIS
  return true;
#else
  return false;
#endif
}

std::vector<int> GraphPatches(const TriangleMesh& mesh, int numberOfPatches)
{
  const std::vector<int> used = UsedVertices(mesh);
  std::vector<int> patches(mesh.NumberOfVertices(), -1);
  for (const int v : used)
  {
    patches[v] = 0;
  }
  if (numberOfPatches <= 1)
  {
    return patches;
  }
#ifdef CARTAN_HAVE_METIS
  const std::vector<idx_t> part = Partition(mesh, used, numberOfPatches);
  for (std::size_t i = 0; i < used.size(); ++i)
  {
    patches[used[i]] = static_cast<int>(part[i]);
  }
  return patches;
#else
  throw Error(ErrorCode::BadInput,
    "Cartan was built without METIS, which splits surfaces into " +
      std::to_string(numberOfPatches) + " patches: use the whole surface as one patch.");
#endif
}
}
