// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "TestShapes.h"

#include "Kernel/Measure/VolumeModel.h"

namespace shapes
{
/// The first of all triangles that a ray meets (Moeller and Trumbore), which is
/// what a tree must find too.
inline cartan::RayCaster CastThroughAll(const Shape& shape)
{
  return [shape](const Eigen::Vector3d& from, const Eigen::Vector3d& direction)
  {
    cartan::RayHit first;
    for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
    {
      const Eigen::Vector3d a = shape.Positions.row(shape.Faces(t, 0));
      const Eigen::Vector3d u = shape.Positions.row(shape.Faces(t, 1)).transpose() - a;
      const Eigen::Vector3d v = shape.Positions.row(shape.Faces(t, 2)).transpose() - a;
      const Eigen::Vector3d p = direction.cross(v);
      const double determinant = u.dot(p);
      if (determinant == 0.0)
      {
        continue;
      }
      const Eigen::Vector3d w = from - a;
      const Eigen::Vector3d q = w.cross(u);
      const double s = w.dot(p) / determinant;
      const double r = direction.dot(q) / determinant;
      const double distance = v.dot(q) / determinant;
      // Rays through an edge must not slip between its triangles.
      if (s >= -1e-9 && r >= -1e-9 && s + r <= 1.0 + 1e-9 && distance >= 0.0 &&
        (first.Distance < 0.0 || distance < first.Distance))
      {
        first = { distance, static_cast<int>(t) };
      }
    }
    return first;
  };
}
}
