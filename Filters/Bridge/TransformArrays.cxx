// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/TransformArrays.h"

#include "Bridge/PointArrays.h"
#include "Kernel/Algebra/ClosestRotation.h"
#include "Kernel/Algebra/Rotation.h"

#include "vtkPolyData.h"

#include <algorithm>

namespace cartan
{
std::string AddTransformArrays(
  const DeformedSurface& result, bool frameChange, bool rotationVector, vtkPolyData* output)
{
  // A piece has vertices of other ranks, too.
  const Eigen::Index size =
    std::min<Eigen::Index>(result.Transforms.rows(), output->GetNumberOfPoints());
  if (frameChange)
  {
    Eigen::VectorXd change(size);
    for (Eigen::Index v = 0; v < size; ++v)
    {
      change[v] = (MatrixAt(result.Transforms, v) - Eigen::Matrix3d::Identity()).norm();
    }
    AddPointArray(output, "FrameChange", change);
  }
  if (rotationVector)
  {
    Points vectors(size, 3);
    IdSample undetermined;
    for (Eigen::Index v = 0; v < size; ++v)
    {
      const Eigen::Matrix3d transform = MatrixAt(result.Transforms, v);
      vectors.row(v) = VectorFromRotation(ProjectOnRotations(transform)).transpose();
      if (!HasClosestRotation(transform))
      {
        undetermined.Add(v);
      }
    }
    AddPointArray(output, "RotationVector", vectors);
    if (!undetermined.IsEmpty())
    {
      return "RotationVector means nothing at " + undetermined.Describe("point", "points") +
        ": what is turned inside out or crushed is equally near to several rotations. Scale "
        "handles by positive numbers, or switch GenerateRotationVector off and "
        "GenerateFrameChange on.";
    }
  }
  return {};
}
}
