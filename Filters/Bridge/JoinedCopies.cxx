// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/JoinedCopies.h"

#include "Bridge/PreparedSurface.h"
#include "Kernel/Deformation/JoinedVertices.h"
#include "Kernel/Mesh/GeodesicDistance.h"
#include "Kernel/Mesh/Geometry.h"
#include "Kernel/Mesh/GrowByRings.h"

#include <algorithm>

namespace cartan
{
namespace
{
/// How far copies may be apart, in parts of the size.
constexpr double LargestGap = 1e-6;

HandleProblem HoldCopies(vtkPolyData* input, const Surface& surface)
{
  HandleProblem problem;
  problem.Mesh = surface.Mesh;
  problem.Rest = surface.Positions;
  problem.Handle.assign(surface.Mesh->NumberOfVertices(), 0);
  HoldTogether(ReadJoinedPoints(input), problem);
  return problem;
}
}

void GrowOverCopies(vtkPolyData* input, const Surface& surface, int rings, double distance,
  PointMask& mask, const ExecutionContext& context)
{
  const HandleProblem joined = WithJoinedVertices(HoldCopies(input, surface));
  for (std::size_t v = 0; v < joined.JoinedWith.size(); ++v)
  {
    mask[joined.JoinedWith[v]] |= mask[v];
  }
  std::vector<int> seeds;
  for (std::size_t v = 0; v < mask.size(); ++v)
  {
    if (mask[v])
    {
      seeds.push_back(static_cast<int>(v));
    }
  }
  for (const int v : GrowByRings(*joined.Mesh, seeds, rings))
  {
    mask[v] = 1;
  }
  if (distance > 0.0)
  {
    const Eigen::VectorXd distances =
      GeodesicDistance(*joined.Mesh, *joined.Rest, seeds, distance, context);
    for (Eigen::Index v = 0; v < distances.size(); ++v)
    {
      mask[v] |= distances[v] <= distance;
    }
  }
  for (std::size_t v = 0; v < joined.JoinedWith.size(); ++v)
  {
    mask[v] |= mask[joined.JoinedWith[v]];
  }
}

std::string DescribePartedCopies(
  vtkPolyData* input, const Surface& surface, const Points& positions, const std::string& advice)
{
  const std::vector<int> joinedWith = HoldCopies(input, surface).JoinedWith;
  if (joinedWith.empty())
  {
    return {};
  }
  const double size = BoundingDiagonal(positions, surface.Mesh->GetTriangles());
  IdSample parted;
  for (std::size_t v = 0; v < joinedWith.size(); ++v)
  {
    const auto copy = static_cast<Eigen::Index>(v);
    if (!((positions.row(copy) - positions.row(joinedWith[v])).norm() <= LargestGap * size))
    {
      parted.Add(copy);
    }
  }
  return parted.IsEmpty() ? ""
                          : "The parts of the surface move one by one here, away from the copies "
                            "that JoinedPoints holds together with " +
      parted.Describe("point", "points") + ": " + advice;
}
}
