// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/PointKeys.h"

#include "Bridge/HandleArrays.h"
#include "Bridge/PointArrays.h"
#include "Kernel/Mesh/UsedVertices.h"

#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

namespace cartan
{
std::vector<int> ReadKeys(vtkPolyData* input, const TriangleMesh& mesh, const std::string& name)
{
  std::vector<int> keys(mesh.NumberOfVertices(), 0);
  if (vtkDataArray* array = input->GetPointData()->GetArray(name.c_str()))
  {
    const std::vector<int> all = ReadHandleIds(array, name, input->GetNumberOfPoints(),
      "0 is no key, equal numbers from 1 belong together.");
    for (const int v : UsedVertices(mesh))
    {
      keys[v] = all[v];
    }
  }
  return keys;
}

std::map<int, int> ReadKeyPoints(
  vtkPolyData* input, const TriangleMesh& mesh, const std::string& name)
{
  RequirePointArray(input, name, 1);
  std::map<int, int> points;
  const std::vector<int> keys = ReadKeys(input, mesh, name);
  for (std::size_t v = 0; v < keys.size(); ++v)
  {
    if (keys[v] > 0)
    {
      points.emplace(keys[v], static_cast<int>(v));
    }
  }
  return points;
}
}
