// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Bridge/SurfacePair.h"
#include "Kernel/Measure/Stretches.h"

#include "vtkType.h"

class vtkPolyData;

namespace cartan
{
/// Stretches of the points and cells of a surface.
struct SurfaceStretches
{
  Stretches OfPoints; ///< #V
  Stretches OfCells;  ///< a row per cell, 1 for lines and vertices
};

/// To the current one of two surfaces of one connectivity, from the reference that `ofPoints`
/// holds too (#V x 3 each). A cell of several triangles has the stretches of that which is
/// largest in the reference.
SurfaceStretches MeasureStretches(const RingStretches& ofPoints, const TriangleMesh& mesh,
  const Connectivity& cells, vtkIdType numberOfCells, const Points& reference,
  const Points& current, const ExecutionContext& context);

/// Adds Stretch1, Stretch2, StretchDirection1 and StretchDirection2 to points and cells.
void AddStretchArrays(const SurfaceStretches& stretches, vtkPolyData* output);

/// Adds StretchRate1 and StretchRate2 to points and cells: the principal Hencky strains over the
/// time in which they come about.
void AddRateArrays(const SurfaceStretches& stretches, double interval, vtkPolyData* output);

/// Adds two arrays of the measure's name to points and cells, such as HenckyStrain1 and
/// HenckyStrain2.
void AddStrainArrays(const SurfaceStretches& stretches, StrainMeasure measure, vtkPolyData* output);
}
