// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/JoinedPieces.h"

#include "Bridge/ContentKey.h"
#include "Bridge/DataBytes.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <set>
#include <utility>

namespace cartan
{
namespace
{
bool HasFlag(vtkDataSetAttributes* data, vtkIdType id, unsigned char flag)
{
  auto* ghosts = vtkUnsignedCharArray::SafeDownCast(
    data->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
  return ghosts && id < ghosts->GetNumberOfTuples() && (ghosts->GetValue(id) & flag) != 0;
}

bool IsGhostCell(vtkPolyData* piece, vtkIdType cell)
{
  return HasFlag(piece->GetCellData(), cell, vtkDataSetAttributes::DUPLICATECELL);
}

/// The four kinds of cells in the order in which they are numbered.
std::array<vtkCellArray*, 4> CellsOf(vtkPolyData* surface)
{
  return { surface->GetVerts(), surface->GetLines(), surface->GetPolys(), surface->GetStrips() };
}

/// The arrays of the first piece that has tuples which all others of these have, too.
std::vector<std::string> CommonArrays(const std::vector<vtkDataSetAttributes*>& pieces)
{
  std::vector<std::string> keys;
  for (int index = 0; !pieces.empty() && index < pieces[0]->GetNumberOfArrays(); ++index)
  {
    vtkAbstractArray* array = pieces[0]->GetAbstractArray(index);
    const std::string key = KeyOfAttribute(pieces[0], array);
    const bool isCommon = std::all_of(pieces.begin(), pieces.end(),
      [&](vtkDataSetAttributes* piece)
      {
        vtkAbstractArray* other = FindAttribute(piece, key);
        return other && other->GetDataType() == array->GetDataType() &&
          other->GetNumberOfComponents() == array->GetNumberOfComponents();
      });
    if (isCommon && key != vtkDataSetAttributes::GhostArrayName())
    {
      keys.push_back(key);
    }
  }
  return keys;
}

/// Makes the whole's arrays from the tuples `from` of the pieces.
void GatherArrays(const std::vector<vtkDataSetAttributes*>& pieces,
  const std::vector<PiecePlace>& from, vtkDataSetAttributes* whole)
{
  std::set<int> ranks;
  for (const PiecePlace& place : from)
  {
    ranks.insert(place.Rank);
  }
  std::vector<vtkDataSetAttributes*> filled;
  for (const int rank : ranks)
  {
    filled.push_back(pieces[rank]);
  }
  for (const std::string& key : CommonArrays(filled))
  {
    vtkAbstractArray* model = FindAttribute(filled[0], key);
    auto array = vtk::TakeSmartPointer(model->NewInstance());
    array->SetName(model->GetName());
    array->SetNumberOfComponents(model->GetNumberOfComponents());
    array->CopyComponentNames(model);
    array->SetNumberOfTuples(static_cast<vtkIdType>(from.size()));
    std::vector<vtkAbstractArray*> sources(pieces.size(), nullptr);
    for (const int rank : ranks)
    {
      sources[rank] = FindAttribute(pieces[rank], key);
    }
    for (std::size_t i = 0; i < from.size(); ++i)
    {
      array->SetTuple(static_cast<vtkIdType>(i), from[i].Id, sources[from[i].Rank]);
    }
    const int index = whole->AddArray(array);
    for (int attribute = 0; attribute < vtkDataSetAttributes::NUM_ATTRIBUTES; ++attribute)
    {
      if (filled[0]->GetAbstractAttribute(attribute) == model)
      {
        whole->SetActiveAttribute(index, attribute);
      }
    }
  }
}

/// From which piece each point of the whole takes its values: the one that owns it.
std::vector<PiecePlace> PointSources(
  const SurfacePieces& pieces, const std::vector<std::vector<vtkIdType>>& joined)
{
  vtkIdType count = 0;
  for (const std::vector<vtkIdType>& ids : joined)
  {
    for (const vtkIdType id : ids)
    {
      count = std::max(count, id + 1);
    }
  }
  std::vector<PiecePlace> sources(static_cast<std::size_t>(count), { -1, -1 });
  for (const bool ghosts : { false, true })
  {
    for (std::size_t rank = 0; rank < joined.size(); ++rank)
    {
      for (std::size_t v = 0; v < joined[rank].size(); ++v)
      {
        PiecePlace& source = sources[joined[rank][v]];
        const auto id = static_cast<vtkIdType>(v);
        if (source.Rank < 0 &&
          HasFlag(pieces[rank]->GetPointData(), id, vtkDataSetAttributes::DUPLICATEPOINT) == ghosts)
        {
          source = { static_cast<int>(rank), id };
        }
      }
    }
  }
  return sources;
}

void JoinPoints(
  const SurfacePieces& pieces, const std::vector<PiecePlace>& sources, vtkPolyData* whole)
{
  int type = VTK_FLOAT;
  std::vector<vtkDataSetAttributes*> data;
  for (vtkPolyData* piece : pieces)
  {
    const bool isDouble =
      piece->GetNumberOfPoints() > 0 && piece->GetPoints()->GetDataType() != VTK_FLOAT;
    type = isDouble ? VTK_DOUBLE : type;
    data.push_back(piece->GetPointData());
  }
  vtkNew<vtkPoints> points;
  points->SetDataType(type);
  points->SetNumberOfPoints(static_cast<vtkIdType>(sources.size()));
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    double place[3];
    pieces[sources[i].Rank]->GetPoint(sources[i].Id, place);
    points->SetPoint(static_cast<vtkIdType>(i), place);
  }
  whole->SetPoints(points);
  GatherArrays(data, sources, whole->GetPointData());
}

/// Joins the cells that are nobody's ghosts, kind by kind.
void JoinCells(const SurfacePieces& pieces, JoinedPieces& joined)
{
  std::vector<PiecePlace> sources;
  std::array<vtkNew<vtkCellArray>, 4> cells;
  std::vector<vtkIdType> first(pieces.size(), 0); // of a kind, by piece
  joined.Cells.clear();
  for (vtkPolyData* piece : pieces)
  {
    joined.Cells.emplace_back(static_cast<std::size_t>(piece->GetNumberOfCells()), -1);
  }
  for (std::size_t kind = 0; kind < cells.size(); ++kind)
  {
    for (std::size_t rank = 0; rank < pieces.size(); ++rank)
    {
      vtkCellArray* own = CellsOf(pieces[rank])[kind];
      std::vector<vtkIdType> ids;
      auto iterator = vtk::TakeSmartPointer(own->NewIterator());
      for (iterator->GoToFirstCell(); !iterator->IsDoneWithTraversal(); iterator->GoToNextCell())
      {
        const vtkIdType cell = first[rank] + iterator->GetCurrentCellId();
        if (IsGhostCell(pieces[rank], cell))
        {
          continue;
        }
        vtkIdType size = 0;
        const vtkIdType* corners = nullptr;
        iterator->GetCurrentCell(size, corners);
        ids.clear();
        for (vtkIdType i = 0; i < size; ++i)
        {
          ids.push_back(joined.Points.OfPieces[rank].at(static_cast<std::size_t>(corners[i])));
        }
        cells[kind]->InsertNextCell(size, ids.data());
        joined.Cells[rank][cell] = static_cast<vtkIdType>(sources.size());
        sources.push_back({ static_cast<int>(rank), cell });
      }
      first[rank] += own->GetNumberOfCells();
    }
  }
  vtkPolyData* whole = joined.Whole;
  whole->SetVerts(cells[0]);
  whole->SetLines(cells[1]);
  whole->SetPolys(cells[2]);
  whole->SetStrips(cells[3]);
  std::vector<vtkDataSetAttributes*> data;
  for (vtkPolyData* piece : pieces)
  {
    data.push_back(piece->GetCellData());
  }
  GatherArrays(data, sources, whole->GetCellData());
}

/// Finds for each ghost the cell that it is a copy of: that with its points.
void MatchGhosts(const SurfacePieces& pieces, JoinedPieces& joined)
{
  std::map<std::uint64_t, vtkIdType> cellOf;
  std::vector<vtkIdType> ids;
  const auto visit = [&](bool ghosts, const std::function<void(vtkIdType&, std::uint64_t)>& use)
  {
    for (std::size_t rank = 0; rank < pieces.size(); ++rank)
    {
      vtkIdType cell = 0;
      for (vtkCellArray* cells : CellsOf(pieces[rank]))
      {
        auto iterator = vtk::TakeSmartPointer(cells->NewIterator());
        for (iterator->GoToFirstCell(); !iterator->IsDoneWithTraversal();
             iterator->GoToNextCell(), ++cell)
        {
          if (IsGhostCell(pieces[rank], cell) != ghosts)
          {
            continue;
          }
          vtkIdType size = 0;
          const vtkIdType* corners = nullptr;
          iterator->GetCurrentCell(size, corners);
          ids.clear();
          for (vtkIdType i = 0; i < size; ++i)
          {
            ids.push_back(joined.Points.OfPieces[rank][corners[i]]);
          }
          std::sort(ids.begin(), ids.end());
          use(joined.Cells[rank][cell],
            ContentKey().AddBytes(ids.data(), ids.size() * sizeof(vtkIdType)).GetValue());
        }
      }
    }
  };
  bool hasGhosts = false;
  visit(true, [&](vtkIdType&, std::uint64_t) { hasGhosts = true; });
  if (!hasGhosts)
  {
    return;
  }
  visit(false, [&](vtkIdType& cell, std::uint64_t key) { cellOf.emplace(key, cell); });
  visit(true,
    [&](vtkIdType& cell, std::uint64_t key)
    {
      const auto found = cellOf.find(key);
      cell = found == cellOf.end() ? -1 : found->second;
    });
}
}

JoinedPieces JoinPieces(const SurfacePieces& pieces, const JoinedPieces* model)
{
  JoinedPieces joined;
  joined.Whole = vtkSmartPointer<vtkPolyData>::New();
  joined.Points = model ? model->Points : JoinPiecePoints(pieces);
  JoinPoints(pieces, PointSources(pieces, joined.Points.OfPieces), joined.Whole);
  JoinCells(pieces, joined);
  MatchGhosts(pieces, joined);
  for (vtkPolyData* piece : pieces)
  {
    vtkFieldData* fields = piece->GetFieldData();
    for (int index = 0; index < fields->GetNumberOfArrays(); ++index)
    {
      vtkAbstractArray* array = fields->GetAbstractArray(index);
      if (array->GetName() && !joined.Whole->GetFieldData()->GetAbstractArray(array->GetName()))
      {
        joined.Whole->GetFieldData()->AddArray(array);
      }
    }
  }
  return joined;
}

bool AreAlike(const SurfacePieces& pieces, const SurfacePieces& others)
{
  for (std::size_t rank = 0; rank < pieces.size(); ++rank)
  {
    if (pieces[rank]->GetNumberOfPoints() != others[rank]->GetNumberOfPoints() ||
      KeyOfCells(pieces[rank]) != KeyOfCells(others[rank]))
    {
      return false;
    }
  }
  return true;
}
}
