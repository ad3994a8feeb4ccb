// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/PreparedSurface.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace cartan
{
const char* const OriginalPointIds = "OriginalPointIds";
const char* const OriginalCellIds = "OriginalCellIds";
const char* const CopyOf = "CopyOf";
const char* const JoinedPoints = "JoinedPoints";
const char* const PreparedPointIds = "PreparedPointIds";

namespace
{
template <typename Ids>
vtkSmartPointer<vtkIdTypeArray> IdArray(const char* name, const Ids& ids)
{
  auto array = vtkSmartPointer<vtkIdTypeArray>::New();
  array->SetName(name);
  array->SetNumberOfValues(static_cast<vtkIdType>(ids.size()));
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    array->SetValue(static_cast<vtkIdType>(i), ids[i]);
  }
  return array;
}

/// Copies the tuples `from` of one set of attributes to the first ones of
/// another; zero where `from` is negative.
void CopyTuples(
  vtkDataSetAttributes* source, const std::vector<vtkIdType>& from, vtkDataSetAttributes* target)
{
  target->CopyAllocate(source, static_cast<vtkIdType>(from.size()));
  target->SetNumberOfTuples(static_cast<vtkIdType>(from.size()));
  for (std::size_t i = 0; i < from.size(); ++i)
  {
    if (from[i] >= 0)
    {
      target->CopyData(source, from[i], static_cast<vtkIdType>(i));
    }
    else
    {
      target->NullData(static_cast<vtkIdType>(i));
    }
  }
}

/// Gives points that several have become the mean of their real numbers, and the
/// normals among them length one again.
void AverageMerged(vtkPointData* source, const RepairedSurface& repaired, vtkPointData* target)
{
  std::vector<int> count(repaired.OriginalPoints.size(), 0);
  for (const int v : repaired.PreparedPoints)
  {
    if (v >= 0)
    {
      ++count[v];
    }
  }
  for (int index = 0; index < target->GetNumberOfArrays(); ++index)
  {
    vtkDataArray* array = target->GetArray(index);
    vtkDataArray* from = nullptr;
    if (array && array == target->GetNormals())
    {
      from = source->GetNormals();
    }
    else if (array && array->GetName())
    {
      from = source->GetArray(array->GetName());
    }
    if (!from || (array->GetDataType() != VTK_FLOAT && array->GetDataType() != VTK_DOUBLE))
    {
      continue;
    }
    const int components = array->GetNumberOfComponents();
    Field sum = Field::Zero(static_cast<Eigen::Index>(count.size()), components);
    for (std::size_t v = 0; v < repaired.PreparedPoints.size(); ++v)
    {
      const int prepared = repaired.PreparedPoints[v];
      for (int c = 0; prepared >= 0 && c < components; ++c)
      {
        sum(prepared, c) += from->GetComponent(static_cast<vtkIdType>(v), c);
      }
    }
    for (std::size_t v = 0; v < count.size(); ++v)
    {
      if (count[v] < 2)
      {
        continue;
      }
      const auto row = static_cast<Eigen::Index>(v);
      const double size =
        array == target->GetNormals() ? sum.row(row).norm() : static_cast<double>(count[v]);
      sum.row(row) /= size > 0.0 ? size : 1.0;
      array->SetTuple(row, sum.row(row).data());
    }
  }
}

/// The cells of the output and the input's cell of each.
struct Cells
{
  vtkNew<vtkCellArray> Verts;
  vtkNew<vtkCellArray> Lines;
  vtkNew<vtkCellArray> Polys;
  std::vector<vtkIdType> Original;
};

void PassCells(vtkCellArray* cells, const RepairedSurface& repaired, vtkCellArray* passed,
  vtkIdType firstCell, std::vector<vtkIdType>& original)
{
  auto iterator = vtk::TakeSmartPointer(cells->NewIterator());
  for (iterator->GoToFirstCell(); !iterator->IsDoneWithTraversal(); iterator->GoToNextCell())
  {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    iterator->GetCurrentCell(size, ids);
    std::vector<vtkIdType> mapped;
    for (vtkIdType i = 0; i < size; ++i)
    {
      mapped.push_back(repaired.PreparedPoints[ids[i]]);
    }
    // A line along a part that is removed goes with it.
    if (std::find(mapped.begin(), mapped.end(), -1) == mapped.end())
    {
      passed->InsertNextCell(size, mapped.data());
      original.push_back(firstCell + iterator->GetCurrentCellId());
    }
  }
}

/// Puts the triangles of one polygon together again where nothing but numbers
/// and direction has changed.
class PolygonWriter
{
public:
  PolygonWriter(
    vtkPolyData* input, const TriangleSoup& read, const RepairedSurface& repaired, Cells& cells)
    : Input(input)
    , FirstPolygon(input->GetNumberOfVerts() + input->GetNumberOfLines())
    , Read(read)
    , Repaired(repaired)
    , Output(cells)
    , NewId(static_cast<std::size_t>(input->GetNumberOfPoints()), -1)
  {
    for (const long long cell : read.CellIds)
    {
      const auto polygon = static_cast<std::size_t>(cell - this->FirstPolygon);
      this->TriangleCount.resize(std::max(this->TriangleCount.size(), polygon + 1), 0);
      ++this->TriangleCount[polygon];
    }
  }

  /// The rows [begin, end) of the faces, all from one cell (or fills).
  void Write(Eigen::Index begin, Eigen::Index end)
  {
    const int triangle = this->Repaired.OriginalTriangles[begin];
    const vtkIdType cell = triangle < 0 ? -1 : static_cast<vtkIdType>(this->Read.CellIds[triangle]);
    if (cell >= 0 && end - begin > 1 && this->IsWhole(cell, begin, end))
    {
      this->Output.Polys->InsertNextCell(this->Ids);
      this->Output.Original.push_back(cell);
      return;
    }
    for (Eigen::Index t = begin; t < end; ++t)
    {
      const auto corners = this->Repaired.Faces.row(t);
      this->Output.Polys->InsertNextCell({ corners[0], corners[1], corners[2] });
      this->Output.Original.push_back(cell);
    }
  }

private:
  /// Whether the polygon can stay, and if so its new points in Ids.
  bool IsWhole(vtkIdType cell, Eigen::Index begin, Eigen::Index end)
  {
    const vtkIdType polygon = cell - this->FirstPolygon;
    if (polygon >= this->Input->GetNumberOfPolys() || this->TriangleCount[polygon] != end - begin)
    {
      return false;
    }
    this->Input->GetPolys()->GetCellAtId(polygon, this->Ids);
    for (vtkIdType i = 0; i < this->Ids->GetNumberOfIds(); ++i)
    {
      this->NewId[this->Ids->GetId(i)] = -1;
    }
    int turned = 0;
    for (Eigen::Index t = begin; t < end; ++t)
    {
      const int direction = this->Match(t);
      if (direction == 0)
      {
        return false;
      }
      turned += direction < 0;
    }
    if (turned != 0 && turned != end - begin)
    {
      return false;
    }
    std::vector<vtkIdType> ids;
    for (vtkIdType i = 0; i < this->Ids->GetNumberOfIds(); ++i)
    {
      ids.push_back(this->NewId[this->Ids->GetId(i)]);
    }
    if (turned > 0)
    {
      std::reverse(ids.begin() + 1, ids.end());
    }
    for (std::size_t i = 0; i < ids.size(); ++i)
    {
      this->Ids->SetId(static_cast<vtkIdType>(i), ids[i]);
    }
    return std::find(ids.begin(), ids.end(), -1) == ids.end();
  }

  /// Notes the new numbers of a triangle's corners. 1 when it runs as before, -1
  /// when it is turned over, 0 when it has other corners than before or one that
  /// has another number in the polygon already.
  int Match(Eigen::Index t)
  {
    const auto before = this->Read.Faces.row(this->Repaired.OriginalTriangles[t]);
    const auto now = this->Repaired.Faces.row(t);
    const auto place = [this](int original) -> Eigen::RowVector3d
    { return this->Read.Positions.row(original); };
    std::array<int, 3> at = { -1, -1, -1 };
    for (int i = 0; i < 3; ++i)
    {
      for (int k = 0; k < 3; ++k)
      {
        const bool isSame = this->Repaired.PreparedPoints[before[i]] == now[k] ||
          this->Repaired.OriginalPoints[now[k]] == before[i] ||
          place(before[i]) == this->Repaired.Positions.row(now[k]);
        at[i] = isSame && at[i] < 0 ? k : at[i];
      }
      vtkIdType& id = this->NewId[before[i]];
      if (at[i] < 0 || (id >= 0 && id != now[at[i]]))
      {
        return 0;
      }
      id = now[at[i]];
    }
    if (at[0] == at[1] || at[1] == at[2] || at[2] == at[0])
    {
      return 0;
    }
    return at[1] == (at[0] + 1) % 3 ? 1 : -1;
  }

  vtkPolyData* Input;
  vtkIdType FirstPolygon;
  const TriangleSoup& Read;
  const RepairedSurface& Repaired;
  Cells& Output;
  std::vector<vtkIdType> NewId;         // by the input's points, of the polygon at hand
  std::vector<vtkIdType> TriangleCount; // by polygon, as read
  vtkNew<vtkIdList> Ids;
};

void WriteCells(vtkPolyData* input, const TriangleSoup& read, const RepairedSurface& repaired,
  vtkPolyData* output)
{
  Cells cells;
  PassCells(input->GetVerts(), repaired, cells.Verts, 0, cells.Original);
  PassCells(input->GetLines(), repaired, cells.Lines, input->GetNumberOfVerts(), cells.Original);
  PolygonWriter writer(input, read, repaired, cells);
  const auto cellOf = [&](Eigen::Index t) -> long long
  {
    const int triangle = repaired.OriginalTriangles[t];
    return triangle < 0 ? -1 : read.CellIds[triangle];
  };
  for (Eigen::Index t = 0, end = 0; t < repaired.Faces.rows(); t = end)
  {
    for (end = t + 1; end < repaired.Faces.rows() && cellOf(end) == cellOf(t);)
    {
      ++end;
    }
    writer.Write(t, end);
  }
  output->SetVerts(cells.Verts);
  output->SetLines(cells.Lines);
  output->SetPolys(cells.Polys);
  CopyTuples(input->GetCellData(), cells.Original, output->GetCellData());
  output->GetCellData()->AddArray(IdArray(OriginalCellIds, cells.Original));
}

/// For each point the first of its copies, -1 where it has none; where copies were joined
/// before, as then.
std::vector<vtkIdType> JoinCopies(const RepairedSurface& repaired, vtkPolyData* input)
{
  const Eigen::VectorXd before = ReadJoinedPoints(input);
  std::vector<vtkIdType> joined(repaired.CopyOf.size(), -1);
  for (std::size_t v = 0; v < joined.size(); ++v)
  {
    const int first = repaired.CopyOf[v];
    if (first != static_cast<int>(v))
    {
      joined[v] = joined[first] = first;
    }
  }
  for (std::size_t v = 0; v < joined.size() && before.size(); ++v)
  {
    const double value = before[repaired.OriginalPoints[v]];
    joined[v] = value >= 0.0 ? static_cast<vtkIdType>(value) : joined[v];
  }
  return joined;
}

void WriteReport(const RepairedSurface& repaired, vtkFieldData* fields)
{
  fields->AddArray(IdArray(PreparedPointIds, repaired.PreparedPoints));
  for (const auto& [name, count] : repaired.Counts.List())
  {
    fields->AddArray(IdArray(name.c_str(), std::vector<vtkIdType>{ count }));
  }
  vtkNew<vtkStringArray> text;
  text->SetName("PreparationReport");
  text->InsertNextValue(repaired.Counts.Describe());
  fields->AddArray(text);
}
}

void WritePreparedSurface(vtkPolyData* input, const TriangleSoup& read,
  const RepairedSurface& repaired, bool averages, bool joins, vtkPolyData* output)
{
  const std::vector<vtkIdType> from(repaired.OriginalPoints.begin(), repaired.OriginalPoints.end());
  vtkNew<vtkIdList> ids;
  ids->SetNumberOfIds(static_cast<vtkIdType>(from.size()));
  std::copy(from.begin(), from.end(), ids->GetPointer(0));
  vtkNew<vtkPoints> points;
  points->SetDataType(input->GetPoints()->GetDataType());
  input->GetPoints()->GetPoints(ids, points);

  output->Initialize();
  output->SetPoints(points);
  CopyTuples(input->GetPointData(), from, output->GetPointData());
  if (averages)
  {
    AverageMerged(input->GetPointData(), repaired, output->GetPointData());
  }
  output->GetPointData()->AddArray(IdArray(OriginalPointIds, from));
  output->GetPointData()->AddArray(IdArray(CopyOf, repaired.CopyOf));
  output->GetPointData()->RemoveArray(JoinedPoints);
  if (joins)
  {
    output->GetPointData()->AddArray(IdArray(JoinedPoints, JoinCopies(repaired, input)));
  }
  WriteCells(input, read, repaired, output);
  output->GetFieldData()->ShallowCopy(input->GetFieldData());
  WriteReport(repaired, output->GetFieldData());
}

Eigen::VectorXd ReadJoinedPoints(vtkPolyData* input)
{
  vtkDataArray* array = input->GetPointData()->GetArray(JoinedPoints);
  if (!array || array->GetNumberOfComponents() != 1 ||
    array->GetNumberOfTuples() != input->GetNumberOfPoints())
  {
    return {};
  }
  Eigen::VectorXd ids(array->GetNumberOfTuples());
  for (vtkIdType v = 0; v < array->GetNumberOfTuples(); ++v)
  {
    ids[v] = array->GetTuple1(v);
  }
  return ids;
}
}
