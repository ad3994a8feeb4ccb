// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Kernel/Mesh/TriangleMesh.h"

#include <map>
#include <string>
#include <vector>

class vtkPolyData;

namespace cartan
{
/// The keys in the point array `name`: equal numbers from 1 on two surfaces belong together,
/// 0 is no key. #V; zeros where there is no such array, and at points in no triangle. Throws
/// Error(BadInput) for an array of another size or with other values.
std::vector<int> ReadKeys(vtkPolyData* input, const TriangleMesh& mesh, const std::string& name);

/// The first point of each key there. Throws Error(BadInput) also where there is no such array.
std::map<int, int> ReadKeyPoints(
  vtkPolyData* input, const TriangleMesh& mesh, const std::string& name);
}
