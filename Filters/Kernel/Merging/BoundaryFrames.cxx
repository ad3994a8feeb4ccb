// SPDX-License-Identifier: BSD-3-Clause
#include "Merging/BoundaryFrames.h"

#include "Base/Error.h"

#include <Eigen/Geometry>

#include <cmath>

namespace cartan
{
namespace
{
/// Columns: tangent, normal made orthogonal to it, their cross product. False where
/// they do not make a frame.
bool MakeFrame(
  const Eigen::Vector3d& tangent, const Eigen::Vector3d& normal, Eigen::Matrix3d& frame)
{
  const double length = tangent.norm();
  if (!(length > 0.0))
  {
    return false;
  }
  frame.col(0) = tangent / length;
  const Eigen::Vector3d orthogonal = normal - normal.dot(frame.col(0)) * frame.col(0);
  const double size = orthogonal.norm();
  // Below, the direction is rounding.
  if (!(size > 1e-8))
  {
    return false;
  }
  frame.col(1) = orthogonal / size;
  frame.col(2) = frame.col(0).cross(frame.col(1));
  return true;
}
}

Points AngleWeightedNormals(
  const TriangleMesh& mesh, const Points& points, const std::vector<int>& vertices)
{
  Points normals(static_cast<Eigen::Index>(vertices.size()), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    const int v = vertices[i];
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int d = mesh.RingBegin(v); d < mesh.RingEnd(v); ++d)
    {
      if (mesh.LeftTriangle(d) >= 0)
      {
        const Eigen::Vector3d a = (points.row(mesh.Neighbor(d)) - points.row(v)).transpose();
        const Eigen::Vector3d b = (points.row(mesh.Opposite(d)) - points.row(v)).transpose();
        const Eigen::Vector3d areaVector = a.cross(b);
        const double sine = areaVector.norm();
        if (sine > 0.0)
        {
          sum += std::atan2(sine, a.dot(b)) / sine * areaVector;
        }
      }
    }
    const double size = sum.norm();
    normals.row(static_cast<Eigen::Index>(i)) =
      size > 0.0 ? Eigen::RowVector3d(sum.transpose() / size) : Eigen::RowVector3d::Zero();
  }
  return normals;
}

Matrices LoopSimilarities(const BoundaryCurve& source, const BoundaryCurve& target,
  const std::vector<CurvePlace>& places, const std::vector<int>& sourceIds)
{
  const auto size = static_cast<int>(places.size());
  Matrices similarities(size, 9);
  IdSample withoutFrame;
  for (int i = 0; i < size; ++i)
  {
    const int before = (i + size - 1) % size;
    const int after = (i + 1) % size;
    const Eigen::Vector3d sourceTangent =
      (source.Positions.row(after) - source.Positions.row(before)).transpose();
    const Eigen::Vector3d targetTangent =
      (PointAt(target.Positions, places[after]) - PointAt(target.Positions, places[before]))
        .transpose();
    Eigen::Matrix3d sourceFrame;
    Eigen::Matrix3d targetFrame;
    if (!MakeFrame(sourceTangent, source.Normals.row(i).transpose(), sourceFrame) ||
      !MakeFrame(targetTangent, PointAt(target.Normals, places[i]).transpose(), targetFrame))
    {
      withoutFrame.Add(sourceIds[i]);
      continue;
    }
    MatrixAt(similarities, i) =
      targetTangent.norm() / sourceTangent.norm() * targetFrame * sourceFrame.transpose();
  }
  if (!withoutFrame.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "The boundary has no direction at " + withoutFrame.Describe("point", "points") +
        " of the source, or where they go on the target: the neighbors there are in one place, or "
        "the triangles have no area. Move these points apart, or set other keys.");
  }
  return similarities;
}
}
