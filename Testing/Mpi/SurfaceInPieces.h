// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "VtkTestHelpers.h"

#include "vtkDataSetAttributes.h"
#include "vtkIdTypeArray.h"
#include "vtkMultiProcessController.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <set>

/// Surfaces in pieces, one on each rank, for tests that all ranks run together.
namespace pieces
{
inline vtkMultiProcessController* Controller()
{
  return vtkMultiProcessController::GetGlobalController();
}
inline int Rank()
{
  return Controller()->GetLocalProcessId();
}
inline int Size()
{
  return Controller()->GetNumberOfProcesses();
}

inline double SumOverRanks(double value)
{
  double sum = 0.0;
  Controller()->AllReduce(&value, &sum, 1, vtkCommunicator::SUM_OP);
  return sum;
}

inline double MaxOverRanks(double value)
{
  double most = 0.0;
  Controller()->AllReduce(&value, &most, 1, vtkCommunicator::MAX_OP);
  return most;
}

/// The rank of each cell.
using Distribution = std::function<int(vtkIdType cell, vtkIdType numberOfCells)>;

/// Equal parts in the order of the cells.
inline int InBlocks(vtkIdType cell, vtkIdType numberOfCells)
{
  return static_cast<int>(cell * Size() / numberOfCells);
}

/// Neighbors are almost always on different ranks.
inline int Scattered(vtkIdType cell, vtkIdType)
{
  return static_cast<int>((cell * 7 / 3) % Size());
}

inline Distribution AllOn(int rank)
{
  return [rank](vtkIdType, vtkIdType) { return rank; };
}

struct Kind
{
  bool HasGlobalIds = true;
  bool HasGhosts = true;
};

/// The piece of a rank of a surface of polygons: its cells, and if wanted all others that
/// touch them as ghosts. The point array "Id" has the whole's ids.
inline vtkSmartPointer<vtkPolyData> PieceOf(
  vtkPolyData* whole, int rank, const Distribution& rankOf = InBlocks, const Kind& kind = {})
{
  const vtkIdType numberOfCells = whole->GetNumberOfCells();
  std::vector<int> owner(static_cast<std::size_t>(whole->GetNumberOfPoints()), Size());
  std::vector<char> isMine(owner.size(), 0);
  vtkNew<vtkIdList> ids;
  const auto forCells = [&](const auto& use)
  {
    for (vtkIdType cell = 0; cell < numberOfCells; ++cell)
    {
      whole->GetPolys()->GetCellAtId(cell, ids);
      use(cell, rankOf(cell, numberOfCells));
    }
  };
  forCells(
    [&](vtkIdType, int of)
    {
      for (const vtkIdType id : *ids)
      {
        owner[id] = std::min(owner[id], of);
        isMine[id] |= of == rank;
      }
    });
  std::vector<vtkIdType> cells;
  std::set<vtkIdType> points;
  vtkNew<vtkUnsignedCharArray> cellGhosts;
  forCells(
    [&](vtkIdType cell, int of)
    {
      const bool touches =
        std::any_of(ids->begin(), ids->end(), [&](vtkIdType id) { return isMine[id] != 0; });
      if (of == rank || (kind.HasGhosts && touches))
      {
        cells.push_back(cell);
        points.insert(ids->begin(), ids->end());
        cellGhosts->InsertNextValue(of == rank ? 0 : vtkDataSetAttributes::DUPLICATECELL);
      }
    });
  auto piece = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> places;
  places->SetDataType(whole->GetPoints()->GetDataType());
  vtkNew<vtkIdTypeArray> global;
  global->SetName("GlobalPointIds");
  vtkNew<vtkIdTypeArray> id;
  id->SetName("Id");
  vtkNew<vtkUnsignedCharArray> pointGhosts;
  vtkPointData* data = piece->GetPointData();
  data->CopyAllOn();
  data->CopyAllocate(whole->GetPointData());
  std::vector<vtkIdType> local(owner.size(), -1);
  for (const vtkIdType v : points)
  {
    local[v] = places->InsertNextPoint(whole->GetPoint(v));
    data->CopyData(whole->GetPointData(), v, local[v]);
    id->InsertNextValue(v);
    global->InsertNextValue(v);
    pointGhosts->InsertNextValue(owner[v] == rank ? 0 : vtkDataSetAttributes::DUPLICATEPOINT);
  }
  vtkNew<vtkCellArray> polys;
  piece->GetCellData()->CopyAllOn();
  piece->GetCellData()->CopyAllocate(whole->GetCellData());
  for (const vtkIdType cell : cells)
  {
    whole->GetPolys()->GetCellAtId(cell, ids);
    for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
    {
      ids->SetId(i, local[ids->GetId(i)]);
    }
    piece->GetCellData()->CopyData(whole->GetCellData(), cell, polys->InsertNextCell(ids));
  }
  piece->SetPoints(places);
  piece->SetPolys(polys);
  data->AddArray(id);
  if (kind.HasGlobalIds)
  {
    data->SetGlobalIds(global);
  }
  if (kind.HasGhosts)
  {
    pointGhosts->SetName(vtkDataSetAttributes::GhostArrayName());
    cellGhosts->SetName(vtkDataSetAttributes::GhostArrayName());
    data->AddArray(pointGhosts);
    piece->GetCellData()->AddArray(cellGhosts);
  }
  return piece;
}

inline vtkSmartPointer<vtkPolyData> MyPieceOf(
  vtkPolyData* whole, const Distribution& rankOf = InBlocks, const Kind& kind = {})
{
  return PieceOf(whole, Rank(), rankOf, kind);
}

/// All ranks update, each for its piece.
inline void UpdateTogether(vtkAlgorithm* filter)
{
  filter->UpdatePiece(Rank(), Size(), 0);
}

/// The largest difference of the pieces' points to those of the whole result, in parts of its
/// diagonal; the same on all ranks.
inline double DifferenceToWhole(vtkPolyData* piece, vtkPolyData* whole)
{
  double most = 0.0;
  vtkDataArray* ids = piece->GetPointData()->GetArray("Id");
  for (vtkIdType v = 0; v < piece->GetNumberOfPoints(); ++v)
  {
    const Eigen::Vector3d here(piece->GetPoint(v));
    const Eigen::Vector3d there(whole->GetPoint(static_cast<vtkIdType>(ids->GetTuple1(v))));
    most = std::max(most, (here - there).norm());
  }
  const double size = whole->GetLength();
  return MaxOverRanks(most) / (size > 0.0 ? size : 1.0); // all in one point
}

/// The largest difference of an array at the points, in parts of its largest value.
inline double ArrayDifference(vtkPolyData* piece, vtkPolyData* whole, const char* name)
{
  double most = 0.0;
  vtkDataArray* ids = piece->GetPointData()->GetArray("Id");
  vtkDataArray* a = piece->GetPointData()->GetArray(name);
  vtkDataArray* b = whole->GetPointData()->GetArray(name);
  if ((piece->GetNumberOfPoints() > 0 && !a) || !b)
  {
    return std::numeric_limits<double>::infinity();
  }
  double size = 1e-300;
  for (int c = 0; c < b->GetNumberOfComponents(); ++c)
  {
    for (vtkIdType v = 0; v < piece->GetNumberOfPoints(); ++v)
    {
      const double there = b->GetComponent(static_cast<vtkIdType>(ids->GetTuple1(v)), c);
      const double here = a->GetComponent(v, c);
      if (std::isnan(here) != std::isnan(there))
      {
        return std::numeric_limits<double>::infinity();
      }
      most = std::isnan(there) ? most : std::max(most, std::abs(here - there));
    }
    double range[2];
    b->GetRange(range, c);
    size = std::max({ size, std::abs(range[0]), std::abs(range[1]) });
  }
  return most / size;
}

/// The largest difference of unit vectors at the points, which may point either way.
inline double AxisDifference(vtkPolyData* piece, vtkPolyData* whole, const char* name)
{
  double most = 0.0;
  vtkDataArray* ids = piece->GetPointData()->GetArray("Id");
  vtkDataArray* here = piece->GetPointData()->GetArray(name);
  vtkDataArray* there = whole->GetPointData()->GetArray(name);
  for (vtkIdType v = 0; v < piece->GetNumberOfPoints(); ++v)
  {
    const Eigen::Vector3d a(here->GetTuple3(v));
    const Eigen::Vector3d b(there->GetTuple3(static_cast<vtkIdType>(ids->GetTuple1(v))));
    most = std::max(most, std::min((a - b).norm(), (a + b).norm()));
  }
  return most;
}

/// One message, of the first rank.
inline void ExpectOneMessage(
  const std::vector<std::string>& messages, const std::vector<std::string>& parts)
{
  if (Rank() == 0)
  {
    vtktest::ExpectMessage(messages, parts);
  }
  else
  {
    EXPECT_TRUE(messages.empty()) << "rank " << Rank() << ": " << messages[0];
  }
}
}
