// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Mesh/TriangleMesh.h"

#include "vtkBoundingBox.h"
#include "vtkType.h"

#include <map>
#include <string>
#include <vector>

class vtkDataArray;
class vtkDataObject;
class vtkDoubleArray;
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
  /// Makes Points and Offsets, and adds ids to Ids, from OfVertex.
  void GroupPoints();
  std::size_t GetBytes() const;
};

/// The handles in the point array `name`. Throws Error(BadInput) when there is no
/// such array, or none of whole numbers >= 0.
Handles ReadHandles(vtkPolyData* input, const TriangleMesh& mesh, const std::string& name);

/// The box of each handle that has points, by its id.
using HandleBoxes = std::map<int, vtkBoundingBox>;

/// The boxes with which widgets move the handles of a surface, or of all blocks of a
/// composite data set: a little larger than the handles, and no side shorter than a
/// tenth of the longest. An array that an update refuses has no handles.
HandleBoxes WidgetBoxes(vtkDataObject* input, const std::string& name);

/// Makes `table` hold a row for each of the first `maximum` boxes: id, xmin, xmax, ymin,
/// ymax, zmin, zmax.
void WriteBoxes(const HandleBoxes& boxes, vtkIdType maximum, vtkDoubleArray* table);
}
