// SPDX-License-Identifier: BSD-3-Clause
#include "Bridge/PointJoin.h"

#include "Kernel/Base/Error.h"

#include "vtkBoundingBox.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <tuple>

namespace cartan
{
namespace
{
/// How points of several pieces become one.
class PointJoin
{
public:
  explicit PointJoin(const SurfacePieces& pieces)
    : Input(pieces)
    , HasGlobalIds(std::all_of(pieces.begin(), pieces.end(),
        [](vtkPolyData* piece)
        {
          vtkDataArray* ids = piece->GetPointData()->GetGlobalIds();
          return piece->GetNumberOfPoints() == 0 ||
            (ids && ids->GetNumberOfTuples() == piece->GetNumberOfPoints());
        }))
  {
  }

  /// The whole's point of each point of the pieces.
  std::vector<std::vector<vtkIdType>> Join()
  {
    std::vector<std::vector<vtkIdType>> joined;
    for (std::size_t rank = 0; rank < this->Input.size(); ++rank)
    {
      const vtkIdType count = this->Input[rank]->GetNumberOfPoints();
      joined.emplace_back(static_cast<std::size_t>(count), -1);
      for (vtkIdType id = 0; id < count; ++id)
      {
        this->Entries.push_back(
          { this->KeyOf(static_cast<int>(rank), id), { static_cast<int>(rank), id } });
      }
    }
    // By key, rank and id: entries were made in the order of the latter two.
    std::stable_sort(this->Entries.begin(), this->Entries.end(),
      [](const Entry& a, const Entry& b) { return a.Key < b.Key; });
    this->FindGroups();
    this->Refuse();
    // The order of the keys is that of global ids; without these, that of the pieces.
    if (!this->HasGlobalIds)
    {
      std::sort(this->Groups.begin(), this->Groups.end(),
        [](const Group& a, const Group& b)
        { return std::tie(a[0].Rank, a[0].Id) < std::tie(b[0].Rank, b[0].Id); });
    }
    for (std::size_t point = 0; point < this->Groups.size(); ++point)
    {
      for (const PiecePlace& place : this->Groups[point])
      {
        joined[place.Rank][place.Id] = static_cast<vtkIdType>(point);
      }
    }
    return joined;
  }

  std::string DescribeNumbering() const
  {
    if (!this->HasGlobalIds)
    {
      return "Ids count the points rank by rank, each once: the pieces have no global ids.";
    }
    return this->IsContiguous() ? "Ids of points are their global ids."
                                : "Ids count the points in the order of their global ids.";
  }

private:
  /// A global id, or the bits of a place: zero has two kinds, NaN is in no order.
  using Key = std::array<std::uint64_t, 3>;
  using Group = std::vector<PiecePlace>;
  struct Entry
  {
    PointJoin::Key Key;
    PiecePlace Place;
  };

  Key KeyOf(int rank, vtkIdType id) const
  {
    vtkPolyData* piece = this->Input[rank];
    if (this->HasGlobalIds)
    {
      const auto global =
        static_cast<vtkIdType>(piece->GetPointData()->GetGlobalIds()->GetTuple1(id));
      return { static_cast<std::uint64_t>(global), 0, 0 };
    }
    double place[3];
    piece->GetPoint(id, place);
    Key key;
    for (int c = 0; c < 3; ++c)
    {
      place[c] = place[c] == 0.0 ? 0.0 : place[c];
      std::memcpy(&key[c], &place[c], sizeof(double));
    }
    return key;
  }

  static bool IsOfDifferentRanks(const Group& group)
  {
    for (std::size_t i = 1; i < group.size(); ++i)
    {
      if (group[i].Rank == group[i - 1].Rank) // sorted by ranks
      {
        return false;
      }
    }
    return true;
  }

  void FindGroups()
  {
    for (std::size_t begin = 0, end = 0; begin < this->Entries.size(); begin = end)
    {
      Group group;
      for (end = begin;
           end < this->Entries.size() && this->Entries[end].Key == this->Entries[begin].Key; ++end)
      {
        group.push_back(this->Entries[end].Place);
      }
      this->AddGroup(group);
    }
  }

  void AddGroup(const Group& group)
  {
    if (IsOfDifferentRanks(group))
    {
      this->CheckPlaces(group);
      this->Groups.push_back(group);
      return;
    }
    if (group.front().Rank == group.back().Rank)
    {
      this->AddApart(group);
      return;
    }
    // Copies of a point in one piece, as where normals are split: their arrays tell which are
    // one with those of other pieces.
    std::map<std::string, Group> byContents;
    for (const PiecePlace& place : group)
    {
      byContents[this->ContentsOf(place)].push_back(place);
    }
    for (const auto& entry : byContents)
    {
      if (IsOfDifferentRanks(entry.second))
      {
        this->Groups.push_back(entry.second);
      }
      else if (entry.second.front().Rank == entry.second.back().Rank)
      {
        this->AddApart(entry.second);
      }
      else
      {
        this->Open.Add(static_cast<long long>(entry.second.front().Id));
        this->FirstOpenRank = std::min(this->FirstOpenRank, entry.second.front().Rank);
      }
    }
  }

  void AddApart(const Group& group)
  {
    for (const PiecePlace& place : group)
    {
      this->Groups.push_back({ place });
    }
  }

  std::string ContentsOf(const PiecePlace& place) const
  {
    vtkPolyData* piece = this->Input[place.Rank];
    std::string contents;
    const auto add = [&](vtkAbstractArray* array)
    {
      const int components = array->GetNumberOfComponents();
      for (int c = 0; c < components; ++c)
      {
        contents += array->GetVariantValue(place.Id * components + c).ToString() + "\n";
      }
    };
    add(piece->GetPoints()->GetData());
    vtkPointData* data = piece->GetPointData();
    for (int index = 0; index < data->GetNumberOfArrays(); ++index)
    {
      vtkAbstractArray* array = data->GetAbstractArray(index);
      if (!array->GetName() ||
        std::strcmp(array->GetName(), vtkDataSetAttributes::GhostArrayName()) != 0)
      {
        add(array);
      }
    }
    return contents;
  }

  /// One global id, one place up to rounding.
  void CheckPlaces(const Group& group)
  {
    if (!this->HasGlobalIds || group.size() < 2)
    {
      return;
    }
    if (this->Tolerance < 0.0)
    {
      vtkBoundingBox box;
      for (vtkPolyData* piece : this->Input)
      {
        if (piece->GetNumberOfPoints() > 0)
        {
          box.AddBounds(piece->GetBounds());
        }
      }
      this->Tolerance = 1e-5 * box.GetDiagonalLength();
    }
    double first[3];
    this->Input[group[0].Rank]->GetPoint(group[0].Id, first);
    for (const PiecePlace& place : group)
    {
      double other[3];
      this->Input[place.Rank]->GetPoint(place.Id, other);
      const double distance = std::max({ std::abs(other[0] - first[0]),
        std::abs(other[1] - first[1]), std::abs(other[2] - first[2]) });
      if (distance > this->Tolerance)
      {
        this->Apart.Add(static_cast<long long>(this->KeyOf(place.Rank, place.Id)[0]));
        return;
      }
    }
  }

  void Refuse() const
  {
    if (!this->Apart.IsEmpty())
    {
      throw Error(ErrorCode::BadInput,
        "The pieces of the surface have " +
          this->Apart.Describe("global id in different places", "global ids in different places") +
          ": make the ids anew (Generate Global Ids).");
    }
    if (!this->Open.IsEmpty())
    {
      throw Error(ErrorCode::BadInput,
        "The pieces of the surface have " +
          this->Open.Describe(
            "place where points of several ranks meet and one of them has several",
            "places where points of several ranks meet and one of them has several") +
          " on rank " + std::to_string(this->FirstOpenRank) +
          ", so that it is open which belong together: merge them (Clean).");
    }
  }

  bool IsContiguous() const
  {
    vtkIdType next = 0;
    return std::all_of(this->Groups.begin(), this->Groups.end(),
      [&](const Group& group)
      { return this->KeyOf(group[0].Rank, group[0].Id)[0] == static_cast<std::uint64_t>(next++); });
  }

  const SurfacePieces& Input;
  bool HasGlobalIds;
  std::vector<Entry> Entries;
  std::vector<Group> Groups; // of one point each
  double Tolerance = -1.0;
  IdSample Apart;
  IdSample Open;
  int FirstOpenRank = VTK_INT_MAX;
};
}

PiecePoints JoinPiecePoints(const SurfacePieces& pieces)
{
  PointJoin join(pieces);
  PiecePoints joined;
  joined.OfPieces = join.Join();
  joined.Numbering = join.DescribeNumbering();
  return joined;
}
}
