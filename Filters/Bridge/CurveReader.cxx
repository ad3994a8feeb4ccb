// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/CurveReader.h"

#include "Kernel/Base/Error.h"

#include "vtkCellArray.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace cartan
{
namespace
{
using Neighbors = std::map<vtkIdType, std::set<vtkIdType>>;

/// From one end to the other; nothing where there are not two ends, or a branch.
std::vector<vtkIdType> Walk(const Neighbors& neighbors)
{
  std::vector<vtkIdType> ends;
  bool branches = false;
  for (const auto& [id, others] : neighbors)
  {
    branches = branches || others.size() > 2;
    if (others.size() == 1)
    {
      ends.push_back(id);
    }
  }
  std::vector<vtkIdType> curve;
  vtkIdType before = -1;
  for (vtkIdType id = branches || ends.size() != 2 ? -1 : ends[0]; id >= 0;)
  {
    curve.push_back(id);
    vtkIdType next = -1;
    for (const vtkIdType other : neighbors.at(id))
    {
      next = other != before ? other : next;
    }
    before = id;
    id = next;
  }
  return curve;
}

void RequireFinite(vtkPolyData* input, const std::vector<vtkIdType>& curve)
{
  IdSample bad;
  for (const vtkIdType id : curve)
  {
    double x[3];
    input->GetPoint(id, x);
    if (!std::isfinite(x[0]) || !std::isfinite(x[1]) || !std::isfinite(x[2]))
    {
      bad.Add(id);
    }
  }
  if (!bad.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      bad.Describe("point", "points") +
        " of the target curve with coordinates that are not finite.");
  }
}
}

std::vector<vtkIdType> ReadCurve(vtkPolyData* input)
{
  Neighbors neighbors;
  vtkNew<vtkIdList> ids;
  vtkIdType first = -1;
  vtkIdType second = -1;
  for (vtkIdType cell = 0; cell < input->GetNumberOfLines(); ++cell)
  {
    input->GetLines()->GetCellAtId(cell, ids);
    for (vtkIdType i = 0; i + 1 < ids->GetNumberOfIds(); ++i)
    {
      const vtkIdType a = ids->GetId(i);
      const vtkIdType b = ids->GetId(i + 1);
      if (a != b)
      {
        first = first < 0 ? a : first;
        second = second < 0 ? b : second;
        neighbors[a].insert(b);
        neighbors[b].insert(a);
      }
    }
  }
  if (neighbors.empty())
  {
    throw Error(ErrorCode::BadInput,
      "The target curve has no lines: connect a polyline, such as a Poly Line Source or a Spline "
      "Source.");
  }
  std::vector<vtkIdType> curve = Walk(neighbors);
  if (curve.size() != neighbors.size())
  {
    throw Error(ErrorCode::BadInput,
      "The target curve is not one open line: its " + std::to_string(input->GetNumberOfLines()) +
        " lines make several, branch or close. Connect one open line, such as a part of it from "
        "Extract Cells.");
  }
  const auto at = std::find(curve.begin(), curve.end(), first);
  if (at + 1 == curve.end() || *(at + 1) != second)
  {
    std::reverse(curve.begin(), curve.end());
  }
  RequireFinite(input, curve);
  // Points that repeat the one before make no segment.
  const auto isSame = [input](vtkIdType a, vtkIdType b)
  {
    double x[3];
    double y[3];
    input->GetPoint(a, x);
    input->GetPoint(b, y);
    return std::equal(x, x + 3, y);
  };
  curve.erase(std::unique(curve.begin(), curve.end(), isSame), curve.end());
  return curve;
}
}
