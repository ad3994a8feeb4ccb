// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

class vtkPolyData;

/// Private to the filters, not installed.
namespace cartan
{
/// Writes the original surface in the shape of the prepared one, see
/// vtkRestoreSurface. Returns a warning, empty if there is nothing to say. Throws
/// Error(BadInput) when the prepared surface's arrays are missing or do not fit.
std::string WriteRestoredSurface(vtkPolyData* prepared, vtkPolyData* original, vtkPolyData* output);
}
