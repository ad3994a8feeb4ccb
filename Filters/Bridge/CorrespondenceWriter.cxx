// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/CorrespondenceWriter.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>

namespace cartan
{
namespace
{
/// A line of points with its pair and kind.
class LineWriter
{
public:
  explicit LineWriter(vtkPolyData* output)
    : Output(output)
  {
    this->Pairs->SetName("Pair");
    this->Kinds->SetName("Kind");
  }

  void Add(const Points& points, bool isClosed, int pair, int kind)
  {
    this->Lines->InsertNextCell(static_cast<int>(points.rows()) + isClosed);
    vtkIdType first = -1;
    for (Eigen::Index i = 0; i < points.rows(); ++i)
    {
      const vtkIdType id = this->Coordinates->InsertNextPoint(points.row(i).data());
      first = i == 0 ? id : first;
      this->Lines->InsertCellPoint(id);
    }
    if (isClosed)
    {
      this->Lines->InsertCellPoint(first);
    }
    this->Pairs->InsertNextValue(pair);
    this->Kinds->InsertNextValue(kind);
  }

  void Finish()
  {
    this->Output->SetPoints(this->Coordinates);
    this->Output->SetLines(this->Lines);
    this->Output->GetCellData()->AddArray(this->Pairs);
    this->Output->GetCellData()->AddArray(this->Kinds);
  }

private:
  vtkPolyData* Output;
  vtkNew<vtkPoints> Coordinates;
  vtkNew<vtkCellArray> Lines;
  vtkNew<vtkIntArray> Pairs;
  vtkNew<vtkIntArray> Kinds;
};
}

void WriteCorrespondences(const PairedLoops& paired, const FittedSource& fitted,
  const Points& targetPoints, const Points& sourcePoints, vtkPolyData* output)
{
  LineWriter lines(output);
  for (std::size_t p = 0; p < fitted.Loops.size(); ++p)
  {
    const SeamLoop& loop = fitted.Loops[p];
    const int pair = static_cast<int>(p) + 1;
    const Points target = targetPoints(loop.Target, Eigen::all);
    const Points source = sourcePoints(loop.Source, Eigen::all);
    lines.Add(target, true, pair, 0);
    lines.Add(source, true, pair, 1);
    for (Eigen::Index i = 0; i < source.rows(); ++i)
    {
      const bool isKey = paired.GivenKeys[p] > 0 &&
        std::any_of(paired.Keys[p].begin(), paired.Keys[p].end(),
          [i](const LoopKey& key) { return key.Source == i; });
      Points ends(2, 3);
      ends << source.row(i), PointAt(target, loop.Places[i]);
      lines.Add(ends, false, pair, isKey ? 3 : 2);
    }
  }
  lines.Finish();
}
}
