// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Mesh/TriangleMesh.h"

#include "vtkType.h"

#include <string>
#include <vector>

class vtkBoundingBox;
class vtkDataArray;
class vtkPolyData;

namespace cartan
{
/// The handle of each point, whole numbers >= 0: 0 is free, k >= 1 belongs to
/// handle k. Throws Error(BadInput) when the array is of another size or has
/// other values; `advice` ends the message.
std::vector<int> ReadHandleIds(vtkDataArray* array, const std::string& name,
  vtkIdType numberOfPoints, const std::string& advice = "0 is free, k >= 1 belongs to handle k.");

/// The handles of a surface, with their points.
struct Handles
{
  /// #V; 0 for points in no triangle, which never move.
  std::vector<int> OfVertex;
  std::vector<int> Ids;     ///< those that have points, in increasing order
  std::vector<int> Points;  ///< the points of handle Ids[0], then of Ids[1] ...
  std::vector<int> Offsets; ///< where each handle's points begin in Points, and the end

  bool Has(int id) const;
  std::size_t GetBytes() const;
};

/// The handles in the point array `name`. Throws Error(BadInput) when there is no
/// such array, or none of whole numbers >= 0.
Handles ReadHandles(vtkPolyData* input, const TriangleMesh& mesh, const std::string& name);

/// The box around the points of handle `id`; invalid if there are none.
vtkBoundingBox BoundsOfHandle(vtkPolyData* surface, const std::string& name, int id);

/// The box of a widget that moves a handle of these bounds: a little larger, and no
/// side shorter than a tenth of the longest. Around all points if the handle has
/// none; the unit cube without points.
vtkBoundingBox WidgetBox(const vtkBoundingBox& handle, const vtkBoundingBox& all);
}
