// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Base/ExecutionContext.h"
#include "Kernel/Base/Types.h"

#include <string>
#include <vector>

class vtkDataArray;
class vtkDataObject;
class vtkDataSetAttributes;
class vtkPolyData;
class vtkTable;

namespace cartan
{
/// The coordinates of all points: #V x 3.
Points ReadPoints(vtkPolyData* input, const ExecutionContext& context = {});

/// A numeric point array of `components` numbers per point. Throws
/// Error(BadInput) when it is missing or of another size.
vtkDataArray* RequirePointArray(vtkPolyData* input, const std::string& name, int components);

/// Its values at `points`, a row each. Throws Error(BadInput) for those that are
/// not finite; `what` names these points in the message ("handle point").
Field ReadPointArray(vtkPolyData* input, const std::string& name, int components,
  const std::vector<int>& points, const std::string& what);

/// Adds an array of doubles, a tuple per row of `values`, to point or cell data.
void AddArray(vtkDataSetAttributes* attributes, const std::string& name, const Field& values);

/// The same for the point data of `output`, scalars or vectors; of a piece, those of its points.
void AddPointArray(vtkPolyData* output, const std::string& name, const Eigen::VectorXd& values);
void AddPointArray(vtkPolyData* output, const std::string& name, const Points& values);

/// Adds one number as field data, and returns it.
double AddFieldValue(vtkDataObject* output, const std::string& name, double value);

/// Adds a column of doubles.
void AddColumn(vtkTable* table, const std::string& name, const Eigen::VectorXd& values);

/// Frames as the point arrays FrameTangent1, FrameTangent2 and FrameNormal of
/// three doubles each.
void AddFrameArrays(vtkPolyData* output, const Matrices& frames);
Matrices ReadFrameArrays(vtkPolyData* input);
}
