// SPDX-License-Identifier: BSD-3-Clause
#include "Deformation/BodyRays.h"

#include "Measure/ComponentVolumes.h"
#include "Mesh/Geometry.h"

#include <cmath>

namespace cartan
{
namespace
{
/// Hits nearer than this part of the way count as the end of the way.
constexpr double EndPart = 1.0 - 1e-6;

/// Throws where the surface has no inside. Returns its signed volume.
double RequireInside(const TriangleMesh& mesh, const Points& points)
{
  IdSample open;
  for (int v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    if (mesh.IsBoundary(v))
    {
      open.Add(v);
    }
  }
  if (!open.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The surface is open: " + open.Describe("border point", "border points") +
        ". A volumetric graph needs an inside: close it (Prepare Surface with Maximum Hole Edges), "
        "give a "
        "volume mesh, or use Shape Preserving Deformation.");
  }
  double volume = 0.0;
  double area = 0.0;
  for (const ComponentVolume& component : MeasureComponents(mesh, points))
  {
    volume += component.Volume;
    area += component.Area;
  }
  if (!EnclosesVolume(std::abs(volume), area))
  {
    throw Error(ErrorCode::BadInput,
      "The surface encloses no volume, so there is no lattice inside: use Shape Preserving "
      "Deformation.");
  }
  return volume;
}
}

BodyRays::BodyRays(const TriangleMesh& mesh, const Points& points, const ExecutionContext& context)
  : Volume(RequireInside(mesh, points))
  , Sense(std::copysign(1.0, this->Volume))
  , Tree(mesh.GetTriangles(), points, context)
  , Normals(this->Sense * VertexNormals(mesh, points))
  , AreaVectors(this->Sense * TriangleAreaVectors(points, mesh.GetTriangles()))
{
  this->Volume *= this->Sense;
}

bool BodyRays::IsInside(const Eigen::Vector3d& place, double nearest) const
{
  int votes = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const double sign : { 1.0, -1.0 })
    {
      const Eigen::Vector3d direction = sign * Eigen::Vector3d::Unit(axis);
      const RayHit hit = this->Tree.FirstHit(place, direction);
      if (hit.Triangle >= 0 && hit.Distance < nearest)
      {
        return false;
      }
      votes += this->Leaves(hit, direction) ? 1 : 0;
    }
    if (axis == 0 && votes == 0)
    {
      return false;
    }
  }
  return votes > 3;
}

bool BodyRays::Sees(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const
{
  const double distance = (to - from).norm();
  const RayHit hit = this->Tree.FirstHit(from, (to - from) / distance);
  return hit.Triangle < 0 || hit.Distance > EndPart * distance;
}
}
