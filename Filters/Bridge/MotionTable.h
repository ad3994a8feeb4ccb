// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/HandleMotions.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <map>
#include <vector>

namespace cartan
{
/// All motions that a deformation has been given: by handle id, the active one, and
/// the rows of a table.
struct MotionTable
{
  struct Row
  {
    double Id = 0.0;
    vtkSmartPointer<vtkHandleMotion> Motion;

    /// Scale, angle, axis, center and translation of the motion.
    void SetMotion(double angle, const Eigen::Vector3d& scale, const Eigen::Vector3d& axis,
      const Eigen::Vector3d& center, const Eigen::Vector3d& translation) const;
  };

  std::map<int, vtkSmartPointer<vtkHandleMotion>> ById;
  vtkSmartPointer<vtkHandleMotion> Active; ///< in a slot of its own
  std::vector<Row> Rows;

  /// More rows than anybody types into a table.
  static constexpr int MaximumNumberOfRows = 100000;

  void ResizeRows(int count);

  /// The motion of each handle; the active one takes the place of one by id. Throws
  /// Error(BadInput) for rows whose id is not one, or has a motion already.
  MotionsById Collect(int activeHandle) const;

  /// The last time that one of them changed.
  vtkMTimeType GetMTime() const;
};
}
