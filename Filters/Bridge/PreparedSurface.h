// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/SurfaceReader.h"
#include "Kernel/Mesh/SurfaceRepair.h"

#include "vtkType.h"

#include <string>
#include <vector>

class vtkPolyData;

/// How a prepared surface is written, and how it remembers what it was.
/// Private to the filters, not installed.
namespace cartan
{
/// Point array (vtkIdType): the point of the original surface that each point
/// comes from, of merged ones the first.
extern const char* const OriginalPointIds;
/// Cell array (vtkIdType): the original cell; -1 in a filled hole.
extern const char* const OriginalCellIds;
/// Point array (vtkIdType): the first of the copies that a cut made of one
/// point, the point itself where there is none.
extern const char* const CopyOf;
/// Point array (vtkIdType): points of equal value in the same place are held together
/// when the surface is deformed; -1 for points alone.
extern const char* const JoinedPoints;
/// Field array (vtkIdType), a value per point of the original surface: the point
/// it has become, -1 where it has gone.
extern const char* const PreparedPointIds;

/// Writes the repaired surface to `output`, in the precision of `input`, with
/// its points' and cells' arrays. Polygons of which nothing changed but their
/// points' numbers or their direction stay polygons, others become triangles;
/// vertices and lines pass through. With `averages`, merged points get the mean
/// of their arrays of real numbers, else the first one's values. With `joins`, copies are
/// in JoinedPoints, with what the input has there; else there is no such array.
void WritePreparedSurface(vtkPolyData* input, const TriangleSoup& read,
  const RepairedSurface& repaired, bool averages, bool joins, vtkPolyData* output);

/// The values of JoinedPoints, #V; empty without a number per point there.
Eigen::VectorXd ReadJoinedPoints(vtkPolyData* input);
}
