// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "TestShapes.h"

namespace shapes
{
/// The same surface with vertices, triangles and corners in another order: vertex v is the
/// v-th from the end.
inline Shape Backwards(const Shape& shape)
{
  const int last = shape.NumberOfVertices() - 1;
  Shape backwards;
  backwards.Positions = shape.Positions.colwise().reverse();
  backwards.Faces.resize(shape.Faces.rows(), 3);
  for (Eigen::Index t = 0; t < shape.Faces.rows(); ++t)
  {
    const Eigen::Index from = shape.Faces.rows() - 1 - t;
    backwards.Faces.row(t) << last - shape.Faces(from, 2), last - shape.Faces(from, 0),
      last - shape.Faces(from, 1);
  }
  return backwards;
}
}
