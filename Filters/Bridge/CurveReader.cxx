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

/// From one end to the other; nothing where there are not two ends, or a branch. A ring, where
/// one is welcome, from `first` to `second` and on.
std::vector<vtkIdType> Walk(
  const Neighbors& neighbors, bool isClosed, vtkIdType first, vtkIdType second)
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
  if (branches)
  {
    return curve;
  }
  if (isClosed && ends.empty() && neighbors.size() > 2)
  {
    curve = { first };
    for (vtkIdType before = first, id = second; id != first;)
    {
      curve.push_back(id);
      const std::set<vtkIdType>& others = neighbors.at(id);
      const vtkIdType next = *others.begin() != before ? *others.begin() : *others.rbegin();
      before = id;
      id = next;
    }
    return curve;
  }
  vtkIdType before = -1;
  for (vtkIdType id = ends.size() != 2 ? -1 : ends[0]; id >= 0;)
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

/// Which points lines join, and the first two that one joins.
Neighbors ReadNeighbors(vtkPolyData* input, vtkIdType& first, vtkIdType& second)
{
  Neighbors neighbors;
  vtkNew<vtkIdList> ids;
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
  return neighbors;
}

/// Points that repeat the one before make no segment.
void DropRepeated(vtkPolyData* input, bool isClosed, std::vector<vtkIdType>& curve)
{
  const auto isSame = [input](vtkIdType a, vtkIdType b)
  {
    double x[3];
    double y[3];
    input->GetPoint(a, x);
    input->GetPoint(b, y);
    return std::equal(x, x + 3, y);
  };
  curve.erase(std::unique(curve.begin(), curve.end(), isSame), curve.end());
  while (isClosed && curve.size() > 1 && isSame(curve.front(), curve.back()))
  {
    curve.pop_back();
  }
  if (isClosed && curve.size() < 3)
  {
    throw Error(ErrorCode::BadInput,
      "The target ring has only " + std::to_string(curve.size()) +
        " different points: give it three or more, or turn ClosedCurve off.");
  }
}
}

std::vector<vtkIdType> ReadCurve(vtkPolyData* input, bool isClosed)
{
  vtkIdType first = -1;
  vtkIdType second = -1;
  const Neighbors neighbors = ReadNeighbors(input, first, second);
  if (neighbors.empty())
  {
    throw Error(ErrorCode::BadInput,
      "The target curve has no lines: connect a polyline, such as a Poly Line Source or a Spline "
      "Source.");
  }
  std::vector<vtkIdType> curve = Walk(neighbors, isClosed, first, second);
  if (curve.size() != neighbors.size())
  {
    throw Error(ErrorCode::BadInput,
      (isClosed ? "The target curve is not one line: its "
                : "The target curve is not one open line: its ") +
        std::to_string(input->GetNumberOfLines()) +
        (isClosed ? " lines make several, or branch. Connect one line or ring, such as a part of "
                    "it from Extract Cells."
                  : " lines make several, branch or close. Connect one open line, such as a part "
                    "of it from Extract Cells, or turn ClosedCurve on for a ring."));
  }
  const auto at = std::find(curve.begin(), curve.end(), first);
  const auto after = at + 1 == curve.end() ? curve.begin() : at + 1;
  if (*after != second || (!isClosed && after == curve.begin()))
  {
    std::reverse(curve.begin(), curve.end());
  }
  RequireFinite(input, curve);
  DropRepeated(input, isClosed, curve);
  return curve;
}
}
